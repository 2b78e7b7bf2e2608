//! The numbers of the scene, to change them while it runs.

use super::number;
use crate::app::App;
use egui::{CollapsingHeader, DragValue, Ui};
use sinew::SceneFile;
use sinew::driver::Command;
use sinew::scene::syntax::{Kind, Node, Path};
use std::collections::BTreeMap;

/// Numbers of a scene by their places in it, and what they were set to since.
#[derive(Debug, Default)]
pub struct Values {
    scene: Option<u64>,
    /// By the words that stand first in their places.
    groups: Vec<(String, Vec<Value>)>,
    /// Assignments since the scene was loaded, by their places.
    pub changed: BTreeMap<String, String>,
}

/// A number of a scene.
#[derive(Debug, PartialEq)]
struct Value {
    /// Its place, in the words of `--set`.
    path: String,
    now: f64,
}

/// What can change while a scene runs, and is shown open.
const LIVE: [&str; 2] = ["materials", "loads"];

impl Values {
    /// Goes over to a scene.
    fn follow(&mut self, number: u64, scene: &SceneFile) {
        if self.scene != Some(number) {
            *self = Self { scene: Some(number), groups: groups(scene), changed: BTreeMap::new() };
        }
    }
}

fn groups(scene: &SceneFile) -> Vec<(String, Vec<Value>)> {
    let mut all = Vec::new();
    let Kind::Fields(fields) = &scene.tree().root.kind else { return all };
    for field in fields {
        let mut values = Vec::new();
        numbers(&field.value, &Path::default().name(field.name.text.clone()), scene.text(), &mut values);
        if !values.is_empty() {
            all.push((field.name.text.clone(), values));
        }
    }
    // what can change at once comes first
    all.sort_by_key(|(name, _)| LIVE.iter().position(|live| live == name).unwrap_or(LIVE.len()));
    all
}

/// A number as a scene has it: counts have no point.
fn word(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < 1e15 { format!("{number:.0}") } else { format!("{number:?}") }
}

/// All numbers in a value.
fn numbers(node: &Node, path: &Path, text: &str, values: &mut Vec<Value>) {
    match &node.kind {
        Kind::Number => {
            let word = text.get(node.span.clone()).unwrap_or_default().replace('_', "");
            if let Ok(now) = word.parse() {
                values.push(Value { path: path.to_string(), now });
            }
        }
        Kind::List(items) | Kind::Tuple(items) => {
            for (place, item) in items.iter().enumerate() {
                numbers(item, &path.index(place), text, values);
            }
        }
        Kind::Map(entries) => {
            for entry in entries {
                if let Kind::Text(key) = &entry.key.kind {
                    numbers(&entry.value, &path.name(key.clone()), text, values);
                }
            }
        }
        Kind::Fields(fields) => {
            for field in fields {
                numbers(&field.value, &path.name(field.name.text.clone()), text, values);
            }
        }
        _ => {}
    }
}

impl App {
    /// All numbers of the scene.
    pub(crate) fn values_panel(&mut self, ui: &mut Ui) {
        let Some(loaded) = self.state.loaded.clone().filter(|_| self.source.finished().is_none()) else { return };
        self.values.follow(loaded.number, &loaded.scene);
        let mut sent = Vec::new();
        for (group, values) in &mut self.values.groups {
            let live = LIVE.contains(&group.as_str());
            CollapsingHeader::new(group.as_str()).id_salt(("values", group.as_str())).default_open(live).show(
                ui,
                |ui| {
                    for value in values {
                        let name =
                            value.path.strip_prefix(group.as_str()).unwrap_or(&value.path).trim_start_matches('.');
                        let name = if name.is_empty() { group.as_str() } else { name };
                        let mut now = value.now;
                        let speed = (0.01 * now.abs()).max(1e-9);
                        ui.horizontal(|ui| {
                            let label = ui.label(name).id;
                            let shown = |now: f64, _: std::ops::RangeInclusive<usize>| number(now);
                            let field = DragValue::new(&mut now).speed(speed).custom_formatter(shown);
                            // a drag is one change: what is on the way is not asked for
                            let field = ui.add(field.update_while_editing(false)).labelled_by(label);
                            let ended = field.drag_stopped() || (field.changed() && !field.dragged());
                            if field.changed() {
                                value.now = now;
                            }
                            if ended {
                                sent.push((value.path.clone(), word(now)));
                            }
                        });
                    }
                },
            );
        }
        for (path, value) in sent {
            self.source.send(Command::Set(vec![format!("{path}={value}")]));
            self.values.changed.insert(path, value);
        }
    }

    /// What was set since the scene was loaded, in the words of `--set`.
    pub(crate) fn assignments(&self) -> Vec<String> {
        self.values.changed.iter().map(|(path, value)| format!("{path}={value}")).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn numbers_of_a_scene_are_found_by_the_words_of_set() {
        let text = include_str!("../../../../scenes/cube_under_gravity.ron");
        let scene = SceneFile::from_text("cube.ron", text, std::path::Path::new(""), &[]).unwrap();
        let groups = groups(&scene);
        assert_eq!(groups[0].0, "materials");
        let all: Vec<&Value> = groups.iter().flat_map(|(_, values)| values).collect();
        let value = |path: &str| all.iter().find(|value| value.path == path).map(|value| value.now);
        assert_eq!(value("materials.tissue.density"), Some(scene.scene.materials["tissue"].density));
        assert_eq!(value("duration"), Some(1.0));
        // each of them can be set
        for value in &all {
            let set = format!("{}={}", value.path, word(value.now));
            let again = SceneFile::from_text("cube.ron", text, std::path::Path::new(""), std::slice::from_ref(&set));
            assert_eq!(again.unwrap().scene, scene.scene, "{set}");
        }
    }
}
