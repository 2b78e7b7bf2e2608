//! A good scene, and what is said when a piece of it is replaced.

use sinew::scene::{Diagnostics, SceneFile, validate};
use std::path::Path;

/// Nothing is wrong with it.
pub const GOOD: &str = r#"(
    title: "A cube under gravity",
    duration: 0.5,
    materials: {
        "tissue": (density: 1060, neo_hookean: Young(young: 3e3, poisson: 0.45)),
    },
    bodies: {
        "cube": (
            mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8),
            material: "tissue",
        ),
    },
    constraints: [
        Fixed(on: Plane(normal: (0, 0, 1), at: 0.0)),
    ],
    loads: [
        Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1)),
    ],
    probes: {
        "tip": (what: Displacement, on: Surface(normal: (0, 0, 1))),
    },
)
"#;

/// All complaints about a scene, of its words or of its values.
pub fn complaints(text: &str, sets: &[&str]) -> Diagnostics {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    match SceneFile::from_text("cube.ron", text, Path::new(""), &sets) {
        Err(diagnostics) => diagnostics,
        Ok(scene) => {
            let mut diagnostics = scene.diagnostics();
            validate(&scene, &mut diagnostics);
            diagnostics
        }
    }
}

/// Each complaint in one line: place, message, then label and notes behind bars.
pub fn brief(text: &str, sets: &[&str]) -> String {
    let diagnostics = complaints(text, sets);
    let mut told = Vec::new();
    for (line, complaint) in diagnostics.lines().iter().zip(diagnostics.list()) {
        let label = std::iter::once(complaint.label.clone()).filter(|label| !label.is_empty());
        let parts = label.chain(complaint.also.iter().map(|(_, label)| label.clone())).chain(complaint.notes.clone());
        let line = line.strip_prefix("cube.ron:").unwrap_or(line);
        told.push(parts.fold(line.to_string(), |text, part| format!("{text} | {part}")));
    }
    told.join("\n")
}

/// The good scene with one piece of its text replaced.
pub fn with(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "the good scene has no {old}");
    GOOD.replacen(old, new, 1)
}

/// Cases: a piece of the good scene, what replaces it, and all that is said of the result.
pub fn compare(cases: &[(&str, &str, &str)]) {
    for (old, new, expected) in cases {
        assert_eq!(brief(&with(old, new), &[]), listed(expected), "with {new}");
    }
}

/// A message with the words that there are in place of `{laws}` and `{elements}`.
pub fn listed(message: &str) -> String {
    let elements = sinew::mesh::ElementKind::ALL.map(|kind| format!("{kind:?}"));
    message
        .replace("{laws}", &sinew::scene::schema::ELASTIC_LAWS.join(", "))
        .replace("{elements}", &elements.join(", "))
}
