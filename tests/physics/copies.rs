//! Copies of a body go their own ways: each as the body would by itself under its own load, to the rounding of sums in
//! another order (1e-11 of the largest displacement in f64, 1e-4 in f32, after 300 steps).

use crate::configurations::{Configuration, ELEMENTS, configurations};
use glam::DVec3;

fn end(run: &Configuration, elements: &str, copies: &str, load: &str) -> Vec<DVec3> {
    let mut simulation = run.start(&format!(
        "(duration: 10, bodies: {{\"b\": (mesh: Cylinder(radius: 0.01, height: 0.03, across: 4, along: 6, elements: {elements}),
            material: \"m\", {copies})}},
        materials: {{\"m\": (density: 1000, damping: 5, neo_hookean: Young(young: 3e3, poisson: 0.45),
            fibres: (eta: 500, direction: Along(0, 1, 2)), prony: (terms: [(alpha: 0.4, tau: 0.05)]))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [{load}], integration: (step: 1e-4))"
    ));
    simulation.advance(300).unwrap_or_else(|error| panic!("{error}"));
    simulation.displacements("b").unwrap()
}

fn load(force: f64, more: &str) -> String {
    format!(
        "NodalForce(on: Plane(normal: (0, 0, 1), at: 0.03), force: ({force}, 0, {force}), share: Total, {more} curve: Ramp(end: 0.02))"
    )
}

#[test]
#[ignore = "long"]
fn copies_do_what_the_body_does_by_itself() {
    for run in configurations() {
        for elements in ELEMENTS {
            // at the same place and apart, along x, so that the plane picks the ends of all
            for apart in ["", "apart: (0.05, 0, 0)"] {
                let many = end(&run, elements, &format!("copies: 5, {apart}"), &load(0.01, "per_copy: (-1, 1),"));
                let nodes = many.len() / 5;
                for (copy, factor) in [(0, -1.0), (2, 0.0), (3, 0.5), (4, 1.0)] {
                    let one = end(&run, elements, "", &load(0.01 * factor, ""));
                    assert_eq!(one.len(), nodes);
                    let largest = many.iter().map(|u| u.length()).fold(0.0, f64::max);
                    let own = &many[copy * nodes..(copy + 1) * nodes];
                    let off = own.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
                    assert!(largest > 1e-4 && off <= run.bound(1e-11, 1e-4), "{} {elements} {copy}: {off:e}", run.name);
                }
            }
        }
    }
}
