//! What is said of a scene.

use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};
use std::path::Path;

/// Each complaint of a scene, with files beside it in a folder, in one line: its line, what is said and its notes,
/// without the place in the line.
pub fn told_of(text: &str, folder: &Path) -> String {
    let found = match SceneFile::from_text("t.ron", text, folder, &[]) {
        Err(wrong) => wrong,
        Ok(scene) => Simulation::check(&scene, &Registry::default()),
    };
    let each = found.lines().into_iter().zip(found.list()).map(|(line, complaint)| {
        let line = line.strip_prefix("t.ron:").unwrap_or(&line).to_string();
        let (row, message) = line.split_once(": ").unwrap_or(("", &line));
        let row = row.split(':').next().unwrap_or("");
        complaint.notes.iter().fold(format!("{row}: {message}"), |text, note| format!("{text} | {note}"))
    });
    each.collect::<Vec<_>>().join("\n")
}
