//! What a scene author is told about mistakes: where, what, what is allowed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::scene::{Diagnostics, SceneFile, validate};
use std::path::Path;

const GOOD: &str = r#"(
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

fn complaints(text: &str, sets: &[&str]) -> Diagnostics {
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
fn brief(text: &str, sets: &[&str]) -> String {
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
fn with(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "the good scene has no {old}");
    GOOD.replacen(old, new, 1)
}

/// Cases: a piece of the good scene, what replaces it, and all that is said of the result.
fn compare(cases: &[(&str, &str, &str)]) {
    for (old, new, expected) in cases {
        assert_eq!(brief(&with(old, new), &[]), *expected, "with {new}");
    }
}

#[test]
fn dump() {
    let list: serde_json::Value = serde_json::from_str(&std::fs::read_to_string("/tmp/caselist.json").unwrap()).unwrap();
    let mut out = serde_json::Map::new();
    for (key, case) in list.as_object().unwrap() {
        let text = |i: usize| case[i].as_str().unwrap();
        let told = if text(0) == "c" { brief(&with(text(1), text(2)), &[]) } else { brief(GOOD, &[text(1)]) };
        out.insert(key.clone(), told.into());
    }
    std::fs::write("/tmp/expect.json", serde_json::to_string(&out).unwrap()).unwrap();
}
