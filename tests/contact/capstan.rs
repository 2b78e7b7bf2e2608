//! A belt that is drawn around a drum.

use crate::bits::start;
use crate::configurations::near;
use sinew::components::Precision;

/// A belt around half a drum, of so many hexahedra along it: one end is held back by 20 mN, the other is drawn on. The
/// ratio of what both bear, of the last third of the way.
fn ratio(cells: u32, damping: &str) -> f64 {
    let mut simulation = start(
        &format!(
            "(duration: 0.4, bodies: {{\"belt\": (mesh: Tube(inner: 0.01, outer: 0.011, height: 0.004, angle: 180,
                cells: (2, {cells}, 2), elements: Hex8MeanDilatation), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e6, poisson: 0), damping: 30{damping})}},
            constraints: [Prescribed(on: Set(\"end\"), axes: [Y], displacement: (0, -1.2e-3, 0),
                curve: Ramp(start: 0.1, end: 0.4))],
            loads: [NodalForce(on: Set(\"start\"), force: (0, -0.02, 0), share: Total, curve: Smooth(end: 0.1))],
            tools: {{\"drum\": (shape: Cylinder(length: 0.02, radius: 0.01), at: (0, 0, -0.005))}},
            contacts: [Tool(tool: \"drum\", friction: 0.3)],
            probes: {{\"drawn\": (what: Reaction, on: Set(\"end\"))}})"
        ),
        Precision::F64,
        1,
    );
    let mut drawn = Vec::new();
    for time in (0..=20).map(|part| 0.3 + 0.005 * f64::from(part)) {
        simulation.advance_to(time).unwrap();
        drawn.push(-simulation.probe("drawn").unwrap()[1]);
    }
    drawn.iter().sum::<f64>() / drawn.len() as f64 / 0.02
}

/// Euler's formula for belts, e^(μπ). Undamped nodes of the belt let go and come back as waves go along it, and it is
/// held less; with β three quarters of its step it is held as it should be.
#[test]
#[ignore = "long"]
fn a_belt_that_is_damped_by_its_stiffness_is_held_as_by_eulers_formula() {
    let exact = (0.3 * std::f64::consts::PI).exp();
    println!("without: {:.3} of {exact:.3}", ratio(24, ""));
    near("with 1e-5 s", ratio(24, ", stiffness_damping: 1e-5"), exact, exact, 0.02);
}
