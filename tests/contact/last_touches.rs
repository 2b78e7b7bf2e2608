//! The step in which nodes lose their last element: what tools did to them in it they felt.

use crate::configurations::{cpu_and_long_gpu, near};
use sinew::glam::DVec3;

/// A ball is pressed into a block, and forceps lift a corner of it; then its upper layer goes.
const SCENE: &str = "(duration: 0.03, integration: (step: 5e-4),
    bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2), elements: Hex8), material: \"m\")},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 60)},
    constraints: [Fixed(on: Set(\"z0\"))],
    tools: {
        \"ball\": (shape: Sphere(radius: 0.006), at: (0.01, 0.01, 0.0165),
            moves: [(displacement: (0, 0, -0.0015), curve: Smooth(end: 0.02))]),
        \"jaws\": (shape: Sphere(radius: 0.002), at: (0, 0, 0.01),
            moves: [(displacement: (0, 0, 1e-3), curve: Smooth(end: 0.02))])},
    contacts: [Tool(tool: \"ball\", friction: 0.3)],
    attachments: [Grasp(tool: \"jaws\", on: Box(min: (-1, -1, 0.0099), max: (1e-3, 1e-3, 1)), closed: Step())],
    removal: [(on: Box(min: (-1, -1, 0.0049), max: (1, 1, 1)), when: At(0.02))],
    probes: {\"touched\": (what: ContactForce, on: All), \"gone\": (what: RemovedVolume)})";

/// Whatever a step is, forces on nodes and on tools are opposite.
#[test]
fn tools_feel_what_they_do_to_nodes_in_their_last_step() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(SCENE);
        let mut last = None;
        for step in 1..=60 {
            simulation.advance(1).unwrap();
            let [ball, jaws] = ["ball", "jaws"].map(|tool| simulation.tool(tool).unwrap());
            let touched = DVec3::from_slice(&simulation.probe("touched").unwrap());
            let what = format!("{}, step {step}", run.name);
            near(&what, (ball.force + jaws.force + touched).length(), 0.0, 5e-3, 1e-9);
            let is_gone = simulation.probe("gone").unwrap()[0] > 0.0;
            if is_gone && last.is_none() {
                last = Some(step);
                assert!(ball.force.z > 1e-3 && jaws.force.z < -1e-4, "{what}: {ball:?}, {jaws:?}");
            } else if is_gone {
                assert_eq!((ball.force, jaws.force), (DVec3::ZERO, DVec3::ZERO), "{what}");
                assert_eq!((ball.nodes, jaws.nodes), (0, 0), "{what}");
            }
        }
        assert!(last.is_some(), "{}: nothing has gone", run.name);
    }
}
