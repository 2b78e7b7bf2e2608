//! Where the strength of a grip is tested: not where it catches what moves otherwise, and not at rest.

use crate::bits::start;
use crate::configurations::{configurations, near};
use sinew::Simulation;
use sinew::components::Precision;
use sinew::observation::ToolReading;

/// A block of 1 cm, fixed below. A ball that goes up by 5 cm/s takes hold of six nodes of its upper face after 1 ms.
fn caught_in_motion(solver: &str) -> String {
    format!(
        "(duration: 2e-3, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (4, 4, 4), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3), damping: 30)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {solver},
        tools: {{\"grip\": (shape: Sphere(radius: 0.003),
            path: [(t: 0, at: (0.005, 0.005, 0.0101)), (t: 2e-3, at: (0.005, 0.005, 0.0102))])}},
        attachments: [Grasp(tool: \"grip\", closed: Step(start: 1e-3), strength: 0.03)])"
    )
}

/// To catch a node at rest takes a force of 2 mN in a step of 200 µs, and of 200 mN in one of 2 µs; after that it
/// takes 2 mN to hold it.
#[test]
fn who_grips_in_motion_holds_whatever_the_step() {
    let holds = |what: &str, mut simulation: Simulation, bound: f64| {
        simulation.advance_to(2e-3).unwrap();
        let reading = simulation.tool("grip").unwrap();
        assert_eq!((reading.nodes, reading.slipped), (6, 0), "{what}: {reading:?}");
        near(&format!("{what}: force"), -reading.force.z, 12.6e-3, 12.6e-3, bound);
    };
    for step in ["2e-4", "2e-6"] {
        for run in configurations() {
            let text = caught_in_motion(&format!("integration: (step: {step})"));
            // in short steps places in f32 on a GPU tell forces to some millinewtons
            holds(&format!("{}, {step} s", run.name), run.start(&text), run.bound(0.1, 0.9));
        }
        let text = caught_in_motion(&format!("solver: Implicit(step: {step})"));
        holds(&format!("implicit, {step} s"), start(&text, Precision::F64, 1), 0.1);
    }
}

/// A block of 1 cm whose upper face is drawn up by 2 mm, by 34 mN a node.
fn drawn_at_rest(analysis: &str, strength: &str) -> String {
    format!(
        "(duration: 0.5, analysis: {analysis}, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {{\"grip\": (shape: Sphere(radius: 0.01), at: (0.005, 0.005, 0.01),
            moves: [(displacement: (0, 0, 2e-3), curve: Smooth(end: 0.5))])}},
        attachments: [Grasp(tool: \"grip\", on: Plane(normal: (0, 0, 1), at: 0.01), closed: Step(){strength})])"
    )
}

/// Pseudo-steps and iterations are no way that something would slip out on.
#[test]
fn at_rest_a_weak_grip_holds_as_a_strong_one() {
    let at_rest = |mut simulation: Simulation| -> ToolReading {
        simulation.finish().unwrap();
        assert!(simulation.equilibrium().unwrap().reached);
        simulation.tool("grip").unwrap()
    };
    let alike = |what: &str, [weak, strong]: [ToolReading; 2]| {
        assert_eq!((weak.nodes, weak.slipped), (16, 0), "{what}: {weak:?}");
        near(&format!("{what}: strong"), -strong.force.z, 0.544, 0.544, 0.01);
        near(&format!("{what}: weak"), weak.force.distance(strong.force), 0.0, 0.544, 1e-5);
    };
    let strengths = [", strength: 0.02", ""];
    for run in configurations() {
        alike(run.name, strengths.map(|strength| at_rest(run.start(&drawn_at_rest("Static()", strength)))));
    }
    let newton = |strength: &str| start(&drawn_at_rest("Static(method: Newton)", strength), Precision::F64, 1);
    alike("Newton", strengths.map(|strength| at_rest(newton(strength))));
}

/// A motion begins where a weak grip holds a block, and lets it fall as soon as it moves.
#[test]
fn a_weak_grip_holds_on_the_way_to_the_start() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 0.1, start: Equilibrium(), bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))},
            loads: [Gravity(acceleration: (0, 0, -9.81))],
            tools: {\"grip\": (shape: Sphere(radius: 0.01), at: (0.005, 0.005, 0.01))},
            attachments: [Grasp(tool: \"grip\", on: Plane(normal: (0, 0, 1), at: 0.01), closed: Step(), strength: 1e-4)])",
        );
        simulation.settle().unwrap();
        let lowest = simulation.displacements("b").unwrap().iter().map(|u| u.z).fold(0.0, f64::min);
        // ρ g L²/2E, less what the grip keeps from narrowing
        near(&format!("{}: it hangs", run.name), -lowest, 1.64e-5, 1.64e-5, 0.2);
        simulation.advance(3).unwrap();
        let reading = simulation.tool("grip").unwrap();
        assert_eq!((reading.nodes, reading.slipped), (0, 16), "{}: {reading:?}", run.name);
    }
}
