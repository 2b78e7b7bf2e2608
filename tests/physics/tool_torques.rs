//! The moment of what a tool feels: nodes and the tool are taken at one time.

use crate::configurations::{configurations, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::Precision;

/// Forces without friction go through the middle of a ball. It is drawn by a hundredth of its radius a step.
#[test]
fn what_slides_without_friction_does_not_turn_a_ball() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 0.05,
            bodies: {\"b\": (mesh: Box(size: (0.03, 0.015, 0.005), cells: (12, 6, 2)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.45), damping: 20)},
            constraints: [Fixed(on: Set(\"z0\"))],
            tools: {\"ball\": (shape: Sphere(radius: 0.006), at: (0.0075, 0.0075, 0.0111), moves: [
                (displacement: (0, 0, -0.0015), curve: Smooth(end: 0.02)),
                (displacement: (0.01, 0, 0), curve: Ramp(start: 0, end: 0.05))])},
            contacts: [Tool(tool: \"ball\")])",
        );
        for time in [0.02, 0.03, 0.04, 0.045] {
            simulation.advance_to(time).unwrap();
            let reading = simulation.tool("ball").unwrap();
            let force = reading.force.length();
            assert!(force > 1e-4, "{}: {reading:?}", run.name);
            near(run.name, reading.torque.length(), 0.0, 0.006 * force, run.bound(1e-9, 1e-4));
        }
    }
}

/// A ball that strikes a cube beside its middle, and rubs; all of it in motion, or not.
#[test]
fn a_torque_is_the_same_in_a_frame_that_moves() {
    let f64s = configurations().into_iter().find(|run| run.options.precision == Precision::F64).unwrap();
    let struck = |DVec3 { x, y, z }: DVec3| -> Simulation {
        f64s.start(&format!(
            "(duration: 0.05,
            bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\", velocity: ({x}, {y}, {z}))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45))}},
            tools: {{\"ball\": (shape: Sphere(radius: 0.006), at: (-0.0061, 0.006, 0.012), moves: [
                (displacement: ({x}, {y}, {z}), curve: Ramp(start: 0, end: 1)),
                (displacement: (0.003, 0.002, 0), curve: Smooth(end: 0.04))])}},
            contacts: [Tool(tool: \"ball\", friction: 0.3)])"
        ))
    };
    let (mut still, mut moved) = (struck(DVec3::ZERO), struck(DVec3::new(1.0, -0.5, 0.3)));
    let mut most = 0.0_f64;
    for time in [0.015, 0.02, 0.025, 0.03] {
        let [still, moved] = [&mut still, &mut moved].map(|simulation| {
            simulation.advance_to(time).unwrap();
            simulation.tool("ball").unwrap()
        });
        most = most.max(still.torque.length());
        near("force", moved.force.distance(still.force), 0.0, 1e-2, 1e-8);
        near("torque", moved.torque.distance(still.torque), 0.0, 1e-2 * 0.006, 1e-8);
    }
    // there is something to compare
    assert!(most > 1e-3 * 1e-2 * 0.006, "{most:e}");
}
