//! Constraints on the same nodes and axes: `Prescribed` moves them, whichever comes first, and who writes a `Fixed`
//! there is told.

use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};
use std::path::Path;

const MOVES: &str =
    "Prescribed(on: Plane(normal: (0, 0, 1), at: 0), displacement: (0, 0, 0.01), curve: Smooth(end: 0.1))";

fn told(constraints: &str) -> Vec<String> {
    let text = format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
constraints: [{constraints}])"
    );
    let scene = SceneFile::from_text("c.ron", &text, Path::new("."), &[]).unwrap();
    Simulation::check(&scene, &Registry::default()).lines().iter().map(ToString::to_string).collect()
}

#[test]
fn who_holds_what_another_moves_is_told_in_either_order() {
    let held = "Fixed(on: Plane(normal: (0, 0, 1), at: 0))";
    let before = told(&format!("{held}, {MOVES}"));
    assert_eq!(before.len(), 1, "{before:?}");
    assert!(before[0].contains("9 of its nodes are constrained along the same axes by an earlier one: this one moves"));
    let after = told(&format!("{MOVES}, {held}"));
    assert_eq!(after.len(), 1, "{after:?}");
    assert!(
        after[0].contains("9 of its nodes are moved along the same axes by an earlier one: this one does not hold")
    );
    let place = 1 + format!("constraints: [{MOVES}, ").chars().count();
    assert!(after[0].starts_with(&format!("c.ron:3:{place}: warning: ")), "{after:?}");
}

#[test]
fn what_does_not_get_in_the_way_is_not_told() {
    let x = MOVES.replace("on:", "axes: [X], on:");
    for sound in [
        format!("{x}, Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [Y, Z])"),
        format!("{MOVES}, Fixed(on: Plane(normal: (0, 0, 1), at: 0.1))"),
        "Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Fixed(on: Plane(normal: (0, 0, 1), at: 0))".to_string(),
    ] {
        assert_eq!(told(&sound), Vec::<String>::new(), "{sound}");
    }
}
