//! What stands for pictures and films in a page, which writes no files.

use crate::app::App;

/// Films, of which there are none.
#[derive(Default)]
pub struct Films {
    taken: Option<usize>,
}

impl App {
    /// Says what takes one instead.
    pub(crate) fn write_picture(&mut self) {
        self.news = Some(("a page writes no pictures: the browser or the system takes one of the screen".into(), true));
    }

    /// Says that there are no files.
    pub(crate) fn write_table(&mut self) {
        self.news = Some(("a page writes no files".into(), true));
    }

    /// No film is being taken.
    pub(crate) fn pictures_taken(&self) -> Option<usize> {
        self.films.taken
    }

    /// Is not called.
    pub(crate) fn begin_film(&mut self, _: &str) {}

    /// Is not called.
    pub(crate) fn end_film(&mut self) {}

    /// There is nothing to follow.
    pub(crate) fn follow_film(&mut self, _: &egui::Context) {}
}
