//! Elements by their numbers: where they are, how large, and those that set the stable step.

use crate::app::App;
use crate::panels::number;
use egui::Ui;
use glam::Vec3;
use sinew::driver::{Body, State};
use sinew_pictures::render::Extent;

/// An element that a name and a number lead to.
pub struct Found<'a> {
    /// Its body.
    pub body: &'a Body,
    /// Its place in the author's order.
    pub element: usize,
    /// Its middle at rest (m).
    pub rest: Vec3,
    /// Its middle (m), now, or at rest where it is no longer anywhere.
    pub place: Vec3,
    /// Of its body at rest (m).
    pub diagonal: f32,
}

/// Finds an element.
pub fn find<'a>(state: &'a State, name: &str, wanted: u64) -> Option<Found<'a>> {
    let loaded = state.loaded.as_ref()?;
    let number = loaded.bodies.iter().position(|body| body.name == name)?;
    let (body, now) = (&loaded.bodies[number], state.bodies.get(number)?);
    let element = (0..body.cells.len()).find(|place| body.elements.of(*place) == wanted)?;
    let nodes = body.cells.nodes(element);
    let mean = |places: &[[f32; 3]]| {
        let sum = nodes.iter().filter_map(|node| places.get(*node as usize)).map(|place| Vec3::from_array(*place));
        sum.sum::<Vec3>() / nodes.len() as f32
    };
    let mut extent = Extent::NOTHING;
    body.rest.iter().for_each(|place| extent.add(Vec3::from_array(*place)));
    // where it is no longer anywhere, it was
    let there = Some(mean(&now.positions)).filter(|place| extent.grown(0.5).has(*place));
    let rest = mean(&body.rest);
    Some(Found { body, element, rest, place: there.unwrap_or(rest), diagonal: extent.diagonal() })
}

/// The shortest way between two nodes of an element at rest (m).
fn shortest(body: &Body, element: usize) -> f32 {
    let places: Vec<Vec3> =
        body.cells.nodes(element).iter().map(|node| Vec3::from_array(body.rest[*node as usize])).collect();
    let all = (1..places.len()).flat_map(|end| (0..end).map(move |begin| (begin, end)));
    all.map(|(begin, end)| places[begin].distance(places[end])).fold(f32::INFINITY, f32::min)
}

impl App {
    /// The elements that set the stable step, each with a button that leads to it.
    pub(crate) fn critical_panel(&mut self, ui: &mut Ui) {
        let state = self.state.clone();
        let Some(loaded) = state.loaded.as_ref().filter(|loaded| !loaded.critical.is_empty()) else { return };
        let mut wanted = None;
        ui.checkbox(&mut self.settings.critical, "Show them in the picture");
        egui::Grid::new("critical").num_columns(5).striped(true).spacing([8.0, 2.0]).show(ui, |ui| {
            for head in ["element", "material", "size (m)", "its step (s)", "without it"] {
                ui.strong(head);
            }
            ui.end_row();
            for critical in &loaded.critical {
                let Some(found) = find(&state, &critical.body, critical.element) else { continue };
                let name = format!("{} {}", critical.body, critical.element);
                if ui.button(name).on_hover_text("go there").clicked() {
                    wanted = Some((self.settings.seen(found.rest, found.place), 0.25 * found.diagonal));
                }
                let material = found.body.element_materials.get(found.element);
                ui.label(
                    material.and_then(|place| found.body.materials.get(*place as usize)).map_or("", String::as_str),
                );
                ui.label(number(f64::from(shortest(found.body, found.element))));
                ui.label(number(critical.bound));
                ui.label(format!("{} ×", number(critical.gain)));
                ui.end_row();
            }
        });
        ui.weak("without it: how many times longer the step could be without it and those above it");
        if let Some((place, distance)) = wanted {
            self.settings.critical = true;
            self.orbit.go_to(place, distance);
        }
    }

    /// Looks at the element in which the simulation broke down.
    pub(crate) fn go_to_breakdown(&mut self) {
        let state = self.state.clone();
        let found = state.breakdown.as_ref().and_then(|broken| find(&state, &broken.body, broken.criterion.element?));
        if let Some(found) = found {
            self.orbit.go_to(self.settings.seen(found.rest, found.place), 1.5 * found.diagonal);
        }
    }
}
