//! What stands around the picture.

mod editor;
mod look;
mod run;
mod told;
mod values;

pub use values::Values;

use crate::app::App;
use egui::{CollapsingHeader, Key, Panel, ScrollArea, Ui};

/// A number in as few letters as tell three digits.
pub fn number(number: f64) -> String {
    let size = number.abs();
    if size == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{number:.2e}");
    }
    let digits = (2 - size.log10().floor() as i32).max(0) as usize;
    format!("{number:.digits$}")
}

/// Keys and what they do.
pub const KEYS: [(Key, &str, &str); 14] = [
    (Key::Space, "space", "run, pause"),
    (Key::ArrowRight, "arrow right", "one step (with shift: 100)"),
    (Key::R, "R", "back to the start"),
    (Key::F, "F", "see all"),
    (Key::W, "W", "edges of elements"),
    (Key::N, "N", "nodes"),
    (Key::G, "G", "shape at rest"),
    (Key::C, "C", "cut open"),
    (Key::S, "S", "what is held"),
    (Key::L, "L", "loads as arrows"),
    (Key::D, "D", "dark, light"),
    (Key::P, "P", "write a picture"),
    (Key::T, "T", "tissue, or the last field"),
    (Key::H, "H", "this list"),
];

/// What the mouse does.
pub const MOUSE: [(&str, &str); 6] = [
    ("drag", "turn"),
    ("shift + drag, right drag", "move"),
    ("wheel", "nearer, farther"),
    ("ctrl + drag", "pull at the tissue"),
    ("click", "say what is there"),
    ("double click", "see all"),
];

impl App {
    /// All panels; what is left is for the picture.
    pub(crate) fn panels(&mut self, ui: &mut Ui) {
        Panel::top("run").show(ui, |ui| self.run_panel(ui));
        Panel::bottom("time").show(ui, |ui| self.time_panel(ui));
        if self.has_news() {
            Panel::bottom("news").resizable(true).show(ui, |ui| self.news_panel(ui));
        }
        if self.editor.is_some() && self.shows_editor {
            Panel::left("scene").resizable(true).default_size(390.0).show(ui, |ui| self.editor_panel(ui));
        }
        Panel::left("look").resizable(true).default_size(230.0).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
                self.look_panel(ui);
                self.inputs_panel(ui);
                self.told_panel(ui);
                self.more_panels(ui);
            });
        });
        if self.shows_plots {
            Panel::right("plots").resizable(true).default_size(280.0).show(ui, |ui| self.plots_panel(ui));
        }
        self.keys_window(ui);
    }

    /// What is closed until somebody opens it.
    fn more_panels(&mut self, ui: &mut Ui) {
        ui.separator();
        if self.state.loaded.as_ref().is_some_and(|loaded| !loaded.critical.is_empty()) {
            CollapsingHeader::new("What sets the step").show(ui, |ui| self.critical_panel(ui));
        }
        if self.state.loaded.is_some() && self.source.finished().is_none() {
            CollapsingHeader::new("Numbers of the scene").show(ui, |ui| self.values_panel(ui));
        }
    }

    fn keys_window(&mut self, ui: &Ui) {
        let mut open = self.shows_keys;
        egui::Window::new("Keys").open(&mut open).resizable(false).show(ui.ctx(), |ui| {
            egui::Grid::new("keys").num_columns(2).spacing([20.0, 4.0]).show(ui, |ui| {
                for (keys, what) in
                    KEYS.iter().map(|(_, keys, what)| (keys, what)).chain(MOUSE.iter().map(|(a, b)| (a, b)))
                {
                    ui.strong(*keys);
                    ui.label(*what);
                    ui.end_row();
                }
            });
            ui.checkbox(&mut self.settings.keys, "keys do this");
        });
        self.shows_keys = open;
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_three_digits() {
        let texts = [0.0, 1.0, -12.345, 0.0123456, 99_999.0, 123_456.0, 1.5e-6].map(number);
        assert_eq!(texts, ["0", "1.00", "-12.3", "0.0123", "99999", "1.23e5", "1.50e-6"]);
    }
}
