//! What a scene author is told about mistakes: where, what, what is allowed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::scene::{SceneFile, validate};
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

fn told_with(text: &str, sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    match SceneFile::from_text("cube.ron", text, Path::new("."), &sets) {
        Err(diagnostics) => diagnostics.render(false),
        Ok(scene) => {
            let mut diagnostics = scene.diagnostics();
            validate(&scene, &mut diagnostics);
            diagnostics.render(false)
        }
    }
}

fn told(text: &str) -> String {
    told_with(text, &[])
}

/// The good scene with one piece of its text replaced.
fn with(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "the good scene has no {old}");
    GOOD.replacen(old, new, 1)
}

#[test]
fn a_good_scene_raises_no_complaint() {
    assert_eq!(told(GOOD), "");
}

#[test]
fn show() {
    if std::env::var("SHOW").is_err() { return; }
    let many = with("density: 1060", "densty: 1060, prony: (terms: [(alpha: \"x\", tau: 1)])").replace("Hex8", "Hex20").replace("duration: 0.5,", "").replace("(0, 0, -9.81)", "(0, -9.81)").replace("material: \"tissue\"", "material: tissue, material: \"x\"");
    println!("{}", told(&many));
    println!("{}", told(&with("duration: 0.5,", "duration: 0.5")));
    println!("{}", told(&with("title:", "title")));
    println!("{}", told(&GOOD[..300]));
    for set in ["duration=inf", "bodies.cubee.mesh.cells=(3,3,3)", "bodies.cube.mesh.cells=(3,3,3.5)", "loads[3].acceleration=(0,0,1)", "title=a big cube", "integration.safety=0.5", "integration.saftey=0.5", "duration=(1,", "duration", "materials.tissue.density=abc", "bodies.cube.mesh.cells.x=3", "loads.x=3", "durration=3", "bodies.cube.material=other", "probes.tip.body=cube"] {
        println!("--- {set}\n{}", told_with(GOOD, &[set]));
    }
}
