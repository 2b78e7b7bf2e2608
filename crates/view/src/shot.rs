//! A picture of the whole window, for who is not there to take it: `sinew-view SCENE --shot FILE --after 3`.

use egui::{ScreenshotCallback, Ui, ViewportCommand};
use sinew_pictures::render::{Image, write_png};
use std::path::PathBuf;
use std::time::Duration;
use web_time::Instant;

/// A picture that is to be taken, after which the window is closed.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The file.
    pub path: PathBuf,
    /// When.
    pub at: Instant,
    asked: bool,
}

impl Shot {
    /// A picture after some time.
    pub fn new(path: PathBuf, after: Duration) -> Self {
        Self { path, at: Instant::now() + after, asked: false }
    }

    /// Takes it when it is time, and closes the window when it is written.
    pub fn follow(&mut self, ui: &Ui) {
        ui.ctx().request_repaint_after(Duration::from_millis(50));
        if Instant::now() < self.at || self.asked {
            return;
        }
        self.asked = true;
        let (context, path) = (ui.ctx().clone(), self.path.clone());
        let taken = ScreenshotCallback::new(move |image| {
            let [width, height] = image.size;
            let pixels = image.pixels.iter().map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
            if let Err(error) = write_png(&path, &Image { width, height, pixels }) {
                eprintln!("sinew-view: {error}");
            }
            context.send_viewport_cmd(ViewportCommand::Close);
            context.request_repaint();
        });
        ui.ctx().send_viewport_cmd(ViewportCommand::Screenshot(taken));
    }
}
