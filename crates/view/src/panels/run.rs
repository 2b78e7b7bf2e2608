//! Running, time, inputs.

use super::number;
use crate::app::App;
use egui::{Button, ComboBox, Slider, Ui};
use sinew::driver::Command;

/// Speeds that can be chosen.
const SPEEDS: [f64; 8] = [0.01, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, f64::INFINITY];

/// Whether there are files to write pictures and films into.
const WRITES: bool = cfg!(not(target_arch = "wasm32"));

fn speed_text(speed: f64) -> String {
    if speed.is_infinite() { "as fast as it can".into() } else { format!("{speed} × real time") }
}

impl App {
    pub(crate) fn run_panel(&mut self, ui: &mut Ui) {
        ui.add_space(3.0);
        ui.horizontal(|ui| {
            let ready = self.state.loaded.is_some();
            ui.add_enabled_ui(ready, |ui| {
                let running = self.state.running;
                if ui.add(Button::new(if running { "Pause" } else { "Run" }).min_size([58.0, 0.0].into())).clicked() {
                    self.run_or_pause();
                }
                if ui.button("Step").on_hover_text("one step of the simulation").clicked() {
                    self.source.send(Command::Step(1));
                }
                if ui.button("Reset").on_hover_text("back to the start").clicked() {
                    self.source.send(Command::Reset);
                }
            });
            ui.separator();
            let mut speed = self.state.speed;
            ComboBox::from_label("speed").selected_text(speed_text(speed)).show_ui(ui, |ui| {
                SPEEDS.iter().for_each(|each| drop(ui.selectable_value(&mut speed, *each, speed_text(*each))));
            });
            if speed != self.state.speed && self.state.speed > 0.0 {
                self.source.send(Command::Speed(speed));
            }
            ui.separator();
            ui.label(self.pace_text());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Keys").clicked() {
                    self.shows_keys = !self.shows_keys;
                }
                ui.toggle_value(&mut self.shows_plots, "Plots");
                if self.editor.is_some() {
                    ui.toggle_value(&mut self.shows_editor, "Scene");
                }
                if WRITES {
                    self.film_button(ui);
                }
                if WRITES && ui.button("Picture").on_hover_text("writes the picture as a PNG file").clicked() {
                    self.wants_picture = true;
                }
                if ui.button(if self.settings.dark { "Light" } else { "Dark" }).clicked() {
                    self.settings.dark = !self.settings.dark;
                }
            });
        });
        ui.add_space(3.0);
    }

    fn film_button(&mut self, ui: &mut Ui) {
        if let Some(count) = self.pictures_taken() {
            if ui.button(format!("End film ({count})")).clicked() {
                self.end_film();
            }
            return;
        }
        ui.add_enabled_ui(self.state.loaded.is_some(), |ui| {
            ui.menu_button("Film", |ui| {
                for (name, ending) in [("GIF", "gif"), ("MP4 (by ffmpeg)", "mp4"), ("PNG files", "")] {
                    if ui.button(name).clicked() {
                        self.begin_film(ending);
                        ui.close();
                    }
                }
            });
        });
    }

    fn pace_text(&self) -> String {
        let state = &self.state;
        match (&state.loaded, state.real_time_factor) {
            _ if self.source.has_ended() => "the simulation ended by a mistake of sinew's own".into(),
            (None, _) if self.source.is_behind() => "loading".into(),
            (None, _) => "drop a scene here".into(),
            (_, Some(factor)) => format!("{} × real time", number(factor)),
            _ if state.breakdown.is_some() => "broke down".into(),
            _ if state.finished => "at the end".into(),
            _ => "paused".into(),
        }
    }

    pub(crate) fn time_panel(&mut self, ui: &mut Ui) {
        ui.add_space(3.0);
        ui.horizontal(|ui| {
            let Some(loaded) = self.state.loaded.clone() else {
                ui.label("no scene");
                return;
            };
            let state = self.state.clone();
            let end = loaded.scene.scene.duration.max(state.time);
            let mut time = state.time;
            let label = ui.label("Time").id;
            ui.spacing_mut().slider_width = (ui.available_width() - 470.0).max(80.0);
            let slider = Slider::new(&mut time, 0.0..=end).show_value(false);
            let finished = self.source.finished().is_some();
            let told = if finished { "to any of its times" } else { "back to a state that was kept" };
            let slider = ui.add(slider).labelled_by(label).on_hover_text(told);
            let moved = slider.changed();
            if moved && (time < state.time || finished) {
                self.source.send(Command::Pause);
                self.source.send(Command::Rewind(time));
            }
            ui.monospace(format!("{:.4} s", state.time));
            ui.separator();
            match finished {
                true => ui.label(format!("frame {}", state.step + 1)),
                false => ui.label(format!("step {}, Δt {} s", state.step, number(state.time_step))),
            };
            ui.separator();
            ui.label(loaded.backend.clone());
        });
        ui.add_space(3.0);
    }

    pub(crate) fn inputs_panel(&mut self, ui: &mut Ui) {
        if self.state.inputs.is_empty() {
            return;
        }
        ui.separator();
        ui.heading("Inputs");
        for input in &self.state.clone().inputs {
            let mut target = input.target;
            let most = 1f64.max(2.0 * target.abs());
            let slider = Slider::new(&mut target, -most..=most).text(&input.name);
            let uses: Vec<String> = input.uses.iter().map(|each| format!("{} ({})", each.of, each.path)).collect();
            if ui.add(slider).on_hover_text(uses.join("\n")).changed() {
                self.source.send(Command::Input { name: input.name.clone(), value: target });
            }
        }
    }
}
