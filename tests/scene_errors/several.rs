//! Several mistakes at once, as they are shown.

use crate::good::{GOOD, brief, complaints};

#[test]
fn a_good_scene_raises_no_complaint() {
    assert_eq!(brief(GOOD, &[]), "");
}

#[test]
fn show() {
    let text = GOOD
        .replace("density: 1060", "densty: 1060, prony: (terms: [(alpha: \"a\", tau: 0)])")
        .replace("Hex8", "Hex20")
        .replace("    duration: 0.5,\n", "")
        .replace("(0, 0, -9.81), curve", "(0, -9.81), curv")
        .replace("material: \"tissue\"", "material: \"tisue\", scale: 0");
    println!("{}=====", complaints(&text, &["bodies.cube.mesh.cells=(3, 0, 3)", "output.fields_every=soon"]));
}
