//! What was picked, energies and probes, and what went wrong.

use super::number;
use crate::app::App;
use crate::settings;
use crate::traces::ENERGIES;
use egui::{Color32, RichText, ScrollArea, Ui};
use egui_plot::{Legend, Line, Plot};
use glam::Vec3;
use sinew::driver::Refusal;

const RED: Color32 = Color32::from_rgb(200, 50, 40);

impl App {
    /// What was picked, what tools feel, and energies.
    pub(crate) fn told_panel(&mut self, ui: &mut Ui) {
        let state = self.state.clone();
        ui.separator();
        match &state.picked {
            None if self.source.finished().is_some() => drop(ui.weak("click: what is there")),
            None => drop(ui.weak("click: what is there\nctrl + drag: pull at the tissue")),
            Some(picked) => {
                ui.heading(format!("{}, node {}", picked.pick.body, picked.node_number));
                for line in self.picked_lines() {
                    ui.label(line);
                }
            }
        }
        for held in &state.held {
            ui.label(RichText::new(format!("pulled with {} N", number(held.force.length()))).strong());
        }
        if !state.tools.is_empty() {
            ui.separator();
            ui.heading("Tools");
            for tool in &state.tools {
                let force = number(tool.felt.force.length());
                ui.label(format!("{}: {force} N, {} nodes", tool.name, tool.felt.nodes));
            }
        }
        // those of a finished run are in its plots
        if self.source.finished().is_none() {
            ui.separator();
            ui.heading("Energies");
            let e = &state.energies;
            let parts = [("kinetic", Some(e.kinetic)), ("strain", Some(e.strain)), ("work of loads", e.load_work)];
            for (name, energy) in parts.iter().filter_map(|(name, energy)| Some((name, (*energy)?))) {
                ui.label(format!("{name}: {} J", number(energy)));
            }
        }
        let notes = state.loaded.iter().flat_map(|loaded| &loaded.warnings).chain(&self.scenery.missing);
        notes.for_each(|note| drop(ui.weak(note)));
    }

    fn picked_lines(&self) -> Vec<String> {
        let state = &self.state;
        let (Some(picked), Some(loaded)) = (&state.picked, &state.loaded) else { return Vec::new() };
        let Some(number_of) = loaded.bodies.iter().position(|body| body.name == picked.pick.body) else {
            return Vec::new();
        };
        let (body, Some(now)) = (&loaded.bodies[number_of], state.bodies.get(number_of)) else { return Vec::new() };
        let node = picked.node as usize;
        let mut lines = vec![format!("element {} of {}", picked.pick.element, picked.material)];
        if let (Some(rest), Some(place)) = (body.rest.get(node), now.positions.get(node)) {
            let by = Vec3::from_array(*place) - Vec3::from_array(*rest);
            let [x, y, z] = place.map(|part| number(f64::from(part)));
            lines.push(format!("at ({x}, {y}, {z}) m"));
            let [x, y, z] = by.to_array().map(|part| number(f64::from(part)));
            lines.push(format!("moved by ({x}, {y}, {z}) m, {} m", number(f64::from(by.length()))));
        }
        if let Some(field) = state.field {
            let row = if field.is_of_nodes() { node } else { picked.element };
            if let Some(row) = now.values.chunks_exact(now.components.max(1)).nth(row) {
                let numbers: Vec<String> = row.iter().map(|value| number(f64::from(*value))).collect();
                let unit = settings::about(field, 0).unit;
                lines.push(format!("{}: {} {unit}", settings::title(field), numbers.join(", ")));
            }
        }
        if body.constrained.get(node).is_some_and(|axes| *axes != 0) {
            lines.push("held".into());
        }
        let within = body.sets.iter().filter(|(_, nodes)| nodes.contains(&picked.node));
        let sets: Vec<&str> = within.map(|(name, _)| name.as_str()).collect();
        if !sets.is_empty() {
            lines.push(format!("in the sets {}", sets.join(", ")));
        }
        if let Some(step) = picked.step {
            lines.push(format!("the element's stable step: {} s", number(step)));
        }
        lines.push(format!("in the scene: bodies.{}, materials.{}", body.name, picked.material));
        lines
    }

    pub(crate) fn plots_panel(&mut self, ui: &mut Ui) {
        let probes = self.state.loaded.iter().flat_map(|loaded| &loaded.probes);
        let mut plots: Vec<(String, Vec<String>)> = vec![("energies (J)".into(), ENERGIES.map(String::from).to_vec())];
        plots.extend(probes.cloned());
        let mut column = 0;
        // those of a finished run are files already
        if self.source.finished().is_none() && ui.button("Write CSV").on_hover_text("all curves in one table").clicked()
        {
            self.write_table();
        }
        ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
            for (title, numbers) in plots {
                ui.label(&title);
                let plot = Plot::new(title).height(150.0).legend(Legend::default()).allow_scroll(false);
                plot.show(ui, |plot| {
                    for (place, name) in numbers.iter().enumerate() {
                        let points = match self.source.finished() {
                            Some(run) => run.curves.points(column + place),
                            None => self.traces.points(column + place),
                        };
                        plot.line(Line::new(name.clone(), points));
                    }
                });
                column += numbers.len();
            }
        });
    }

    /// Whether something is to be told at length.
    pub(crate) fn has_news(&self) -> bool {
        self.news.is_some() || self.refusal().is_some() || self.state.breakdown.is_some()
    }

    /// What was refused, but for mistakes of a scene that stand in its text.
    fn refusal(&self) -> Option<&Refusal> {
        let stands_there =
            |refusal: &&Refusal| self.editor.is_some() && refusal.command == "load" && !refusal.mistakes.is_empty();
        self.state.refusal.as_ref().filter(|refusal| !stands_there(refusal))
    }

    pub(crate) fn news_panel(&mut self, ui: &mut Ui) {
        let state = self.state.clone();
        ScrollArea::vertical().max_height(220.0).show(ui, |ui| {
            if let Some(broken) = &state.breakdown {
                ui.colored_label(RED, broken.to_string());
                if broken.criterion.element.is_some() && ui.button("Go there").clicked() {
                    self.go_to_breakdown();
                }
            }
            if let Some(refusal) = self.refusal().cloned() {
                let anew = "takes the scene with this value, from its start";
                if refusal.command == "set" && ui.button("Start anew with it").on_hover_text(anew).clicked() {
                    let sets = self.assignments();
                    match &mut self.editor {
                        Some(editor) => editor.load(&sets),
                        None => self.files.put_in(sets),
                    }
                }
                ui.colored_label(RED, RichText::new(&refusal.reason).monospace());
            }
            if let Some((text, bad)) = self.news.clone() {
                ui.horizontal_top(|ui| {
                    match bad {
                        true => ui.colored_label(RED, RichText::new(text).monospace()),
                        false => ui.label(text),
                    };
                    if ui.small_button("Close").clicked() {
                        self.news = None;
                    }
                });
            }
        });
    }
}
