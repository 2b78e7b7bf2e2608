//! What tools feel in f32, where nodes have gone far in small steps.

use crate::configurations::{configurations, near};
use glam::DVec3;
use sinew::BackendChoice;

/// A cube of 10 mN that forceps or a plate take up by 4 cm, in 40 000 steps. Rounding makes 2e-9 m of such
/// displacements, which a node of it would be pushed back by with 2.5 mN, in the next step the other way: forces
/// wavered by several times the weight, and nodes slipped out of what holds them eight times over. On a GPU poses are
/// of f32.
#[test]
fn tools_do_not_push_by_what_rounding_makes_of_displacements() {
    let forceps = (
        "tools: {\"t\": (shape: Sphere(radius: 1e-3), at: (0.005, 0.005, 0.01),
            moves: [(displacement: (0, 0, 0.04), curve: Smooth(end: 0.4))])},
        attachments: [Grasp(tool: \"t\", closed: Step(), on: All, strength: 0.01)]",
        8,
    );
    let plate = (
        "tools: {\"t\": (shape: Plane(), moves: [(displacement: (0.02, 0, 0.04), curve: Smooth(end: 0.4))])},
        contacts: [Tool(tool: \"t\", friction: 0.15)]",
        4,
    );
    for (held, nodes) in [forceps, plate] {
        let text = format!(
            "(duration: 0.4, integration: (step: 1e-5),
            bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1), elements: Hex8), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 30)}},
            loads: [Gravity(acceleration: (0, 0, -10))], {held})"
        );
        let mut on_cpu = configurations();
        on_cpu.retain(|run| run.options.backend == BackendChoice::Cpu);
        let forces = on_cpu.iter().map(|run| {
            let mut simulation = run.start(&text);
            let mut at = |time: f64| {
                simulation.advance_to(time).unwrap();
                let reading = simulation.tool("t").unwrap();
                assert_eq!((reading.nodes, reading.slipped), (nodes, 0), "{}: at {time} s", run.name);
                reading.force
            };
            [0.2, 0.25, 0.3, 0.35, 0.4].map(&mut at)
        });
        let forces: Vec<[DVec3; 5]> = forces.collect();
        for (of_f32, of_f64) in forces[1].iter().zip(&forces[0]) {
            near(held, of_f32.distance(*of_f64), 0.0, 0.01, 0.02);
        }
    }
}
