//! What is seen, and how.

use crate::app::App;
use crate::settings::{ARROWS, FIELDS, components, title};
use egui::{ComboBox, DragValue, Slider, Ui};
use glam::Vec3;
use std::collections::BTreeSet;

/// Directions to look from, as `sinew render --from` has them.
pub const FROM: [(&str, Vec3); 6] = [
    ("front", Vec3::NEG_Y),
    ("back", Vec3::Y),
    ("left", Vec3::NEG_X),
    ("right", Vec3::X),
    ("above", Vec3::Z),
    ("below", Vec3::NEG_Z),
];

/// Ways to cut.
const CUTS: [(&str, Vec3); 6] =
    [("+x", Vec3::X), ("-x", Vec3::NEG_X), ("+y", Vec3::Y), ("-y", Vec3::NEG_Y), ("+z", Vec3::Z), ("-z", Vec3::NEG_Z)];

impl App {
    pub(crate) fn look_panel(&mut self, ui: &mut Ui) {
        ui.add_space(4.0);
        if let Some(loaded) = &self.state.loaded {
            ui.heading(title_of(&loaded.scene));
        }
        ui.horizontal_wrapped(|ui| {
            ui.label("From");
            for (name, from) in FROM {
                if ui.small_button(name).clicked() {
                    self.orbit.look_from(from);
                }
            }
            if ui.small_button("all").on_hover_text("see all").clicked() {
                self.to_fit = true;
            }
        });
        ui.separator();
        self.field_part(ui);
        ui.separator();
        let settings = &mut self.settings;
        ui.horizontal_wrapped(|ui| {
            ui.checkbox(&mut settings.wireframe, "Elements").on_hover_text("edges of elements");
            ui.checkbox(&mut settings.nodes, "Nodes").on_hover_text("nodes as points, those inside too");
            ui.checkbox(&mut settings.ghost, "Rest shape");
            ui.checkbox(&mut settings.supports, "Supports").on_hover_text("nodes that are fixed or moved as told");
            ui.checkbox(&mut settings.removed, "Removed").on_hover_text("elements that are gone");
            ui.checkbox(&mut settings.tools, "Tools");
            ui.checkbox(&mut settings.skins, "Skins").on_hover_text("fine surfaces, where bodies have them");
        });
        let named = |arrows: Option<_>| {
            let found = arrows.and_then(|field| ARROWS.iter().find(|(known, _)| *known == field));
            found.map_or("none", |(_, name)| name)
        };
        ComboBox::from_label("Arrows").selected_text(named(settings.arrows)).show_ui(ui, |ui| {
            ui.selectable_value(&mut settings.arrows, None, "none");
            for (field, name) in ARROWS {
                ui.selectable_value(&mut settings.arrows, Some(field), name);
            }
        });
        let sets: BTreeSet<&String> = self
            .state
            .loaded
            .iter()
            .flat_map(|loaded| loaded.bodies.iter().flat_map(|body| body.sets.keys()))
            .collect();
        if !sets.is_empty() {
            let text = settings.set.clone().unwrap_or_else(|| "none".into());
            ComboBox::from_label("Set").selected_text(text).height(400.0).show_ui(ui, |ui| {
                ui.selectable_value(&mut settings.set, None, "none");
                for name in sets {
                    ui.selectable_value(&mut settings.set, Some(name.clone()), name);
                }
            });
        }
        ui.add(Slider::new(&mut settings.deformation, 0.0..=20.0).logarithmic(true).text("deformation"));
        ui.add(Slider::new(&mut settings.wet, 0.0..=1.0).text("wet"));
        ui.add(Slider::new(&mut settings.shadows, 0.0..=1.0).text("shadows"));
        ui.separator();
        ui.checkbox(&mut settings.cut, "Cut open");
        if settings.cut {
            ui.horizontal(|ui| {
                for (name, normal) in CUTS {
                    ui.selectable_value(&mut settings.cut_normal, normal, name);
                }
            });
            ui.add(Slider::new(&mut settings.cut_at, 0.0..=1.0).text("place"));
        }
    }

    fn field_part(&mut self, ui: &mut Ui) {
        let settings = &mut self.settings;
        let before = settings.field;
        let text = settings.field.map_or_else(|| "tissue".into(), title);
        ComboBox::from_label("Colour").selected_text(text).height(400.0).show_ui(ui, |ui| {
            ui.selectable_value(&mut settings.field, None, "tissue");
            for field in FIELDS {
                ui.selectable_value(&mut settings.field, Some(field), title(field));
            }
        });
        if settings.field != before {
            (settings.component, settings.range) = (0, None);
        }
        let Some(field) = settings.field else { return };
        self.last_field = Some(field);
        let parts = components(field);
        if !parts.is_empty() {
            ui.horizontal_wrapped(|ui| {
                for (number, part) in parts.iter().enumerate() {
                    ui.selectable_value(&mut settings.component, number, *part);
                }
            });
        }
        let mut held = settings.range.is_some();
        if ui.checkbox(&mut held, "Hold range").changed() {
            settings.range = held.then_some(self.seen_range);
        }
        if let Some((low, high)) = &mut settings.range {
            let speed = 0.01 * f64::from((*high - *low).abs().max(f32::MIN_POSITIVE));
            ui.horizontal(|ui| {
                ui.add(DragValue::new(low).speed(speed));
                ui.label("to");
                ui.add(DragValue::new(high).speed(speed));
            });
        }
    }
}

/// What a scene is called.
fn title_of(scene: &sinew::SceneFile) -> String {
    let title = &scene.scene.title;
    if title.is_empty() { scene.path.display().to_string() } else { title.clone() }
}
