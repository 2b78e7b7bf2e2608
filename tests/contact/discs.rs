//! Tools that are thin along their axis.

use crate::configurations::{configurations, near};

/// A cube of 1 cm, and what comes down on it: as thin as a tenth of a millimetre.
fn under(shape: &str, motion: &str) -> String {
    format!(
        "(duration: 0.02, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (5, 5, 5), elements: Hex8MeanDilatation),
            translate: (-0.005, -0.005, -0.01), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 100)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: -0.01))],
        tools: {{\"t\": (shape: {shape}, at: (0, 0, 1e-3), {motion})}}, contacts: [Tool(tool: \"t\", thin: true)],
        probes: {{\"top\": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0))}})"
    )
}

/// Short cylinders, tubes and cones are as thin as they are long: nodes went through a disc as if it were a ball of its
/// radius, and no force was told.
#[test]
fn a_disc_presses_as_a_plate_does() {
    let down = "moves: [(displacement: (0, 0, -0.0018), curve: Ramp(end: 0.0045))]";
    for run in configurations() {
        let pressed = |shape: &str| {
            let mut simulation = run.start(&under(shape, down));
            simulation.finish().unwrap();
            [simulation.tool("t").unwrap().force.z, simulation.probe("top").unwrap()[2]]
        };
        // a box is about its middle, half a plate below
        let [plate, depth] = pressed("Box(size: (0.02, 0.02, 1e-4))");
        near(&format!("{}: under a plate", run.name), depth, -8.5e-4, 1e-3, 1e-4);
        for disc in [
            "Cylinder(length: 1e-4, radius: 0.01)",
            "Cone(length: 1e-4, tip: 0.01, base: 0.0101)",
            "Tube(length: 1e-4, inner: 1e-4, outer: 0.01)",
        ] {
            let [force, depth] = pressed(disc);
            near(&format!("{}, {disc}: how deep", run.name), depth, -8e-4, 1e-3, 0.03);
            near(&format!("{}, {disc}: force", run.name), force, plate * 8.0 / 8.5, plate, 0.05);
        }
    }
}

/// A disc of a quarter of the cube's mass that is thrown at it.
#[test]
fn a_disc_that_is_thrown_goes_through_nothing() {
    for run in configurations() {
        let text = under("Cylinder(length: 1e-4, radius: 0.01)", "free: (density: 8000, velocity: (0, 0, -0.4))");
        let mut simulation = run.start(&text);
        let mut deepest = 0.0_f64;
        for step in 1..=20 {
            simulation.advance_to(1e-3 * f64::from(step)).unwrap();
            let (disc, top) = (simulation.tool("t").unwrap().place.z, simulation.probe("top").unwrap()[2]);
            assert!(top <= disc + 2e-5, "{}, {step} ms: the disc is at {disc}, the surface at {top}", run.name);
            deepest = deepest.min(top);
        }
        assert!(deepest < -1e-4, "{}: {deepest}", run.name);
    }
}
