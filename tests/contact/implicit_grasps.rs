//! What closed tools do to the books of implicit steps.

use crate::bits::start;
use crate::configurations::near;
use glam::DVec3;
use sinew::Simulation;
use sinew::components::{DisplacementIncrement, Precision};

const SCHEMES: [&str; 2] = ["Euler", "GeneralizedAlpha()"];

/// A cube of 8 g and 2 cm that nothing else holds, and a tool beside it that may take it.
fn grasped(scheme: &str, [step, end]: [f64; 2], body: &str, material: &str, rest: &str) -> Simulation {
    let text = format!(
        "(duration: {end}, solver: Implicit(step: {step}, tolerance: 1e-8, scheme: {scheme}),
        bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Hex8MeanDilatation), material: \"m\"{body})}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4){material})}}, {rest},
        output: (energies_every: {step}))"
    );
    start(&text, Precision::F64, 1)
}

/// What is missing to the energy (J) that all works come to, beside so much at the start.
fn missing(simulation: &mut Simulation, at_start: f64) -> f64 {
    let e = simulation.energies().unwrap();
    let held = e.kinetic + e.internal_work.unwrap() - at_start;
    held + e.damping_loss.unwrap() + e.scheme_loss.unwrap() - e.load_work.unwrap() - e.constraint_work.unwrap()
}

/// A cube at 10 cm/s is caught as a whole: its 40 µJ are the tool's loss, which does no work, for it does not move.
#[test]
fn what_is_caught_in_flight_loses_its_motion_to_the_tool() {
    let kinetic = 0.5 * 8e-3 * 0.01;
    for scheme in SCHEMES {
        let mut simulation = grasped(
            scheme,
            [1e-3, 0.1],
            ", velocity: (0.1, 0, 0)",
            "",
            "tools: {\"g\": (shape: Sphere(radius: 0.006), at: (0.01, 0.01, 0.01))},
            attachments: [Grasp(tool: \"g\", closed: Step(start: 0.05), on: All)]",
        );
        simulation.advance_to(0.04).unwrap();
        near(&format!("{scheme}: in flight"), simulation.energies().unwrap().kinetic, kinetic, kinetic, 1e-12);
        assert_eq!(simulation.energies().unwrap().contact_loss, Some(0.0), "{scheme}");
        simulation.advance_to(0.1).unwrap();
        let (e, tool) = (simulation.energies().unwrap(), simulation.tool("g").unwrap());
        near(&format!("{scheme}: at rest"), e.kinetic, 0.0, kinetic, 1e-12);
        near(&format!("{scheme}: the tool's loss"), tool.loss.unwrap(), kinetic, kinetic, 1e-12);
        near(&format!("{scheme}: its work"), tool.work.unwrap(), 0.0, kinetic, 1e-12);
        near(&format!("{scheme}: of all"), e.contact_loss.unwrap(), kinetic, kinetic, 1e-12);
        near(&format!("{scheme}: constraints"), e.constraint_work.unwrap(), -kinetic, kinetic, 1e-12);
        near(&format!("{scheme}: balance"), missing(&mut simulation, kinetic), 0.0, kinetic, 1e-12);
    }
}

/// A cube that is carried as a whole has the work of the tool in its motion, and gives it back at the end, but for what
/// the first step loses, which begins at once.
#[test]
fn what_is_carried_moves_with_the_work_of_the_tool() {
    for scheme in SCHEMES {
        let mut simulation = grasped(
            scheme,
            [5e-3, 0.1],
            "",
            "",
            "tools: {\"g\": (shape: Sphere(radius: 0.006), at: (0.01, 0.01, 0.01),
                moves: [(displacement: (0.01, 0, 0), curve: Smooth(end: 0.1))])},
            attachments: [Grasp(tool: \"g\", closed: Step(), on: All)]",
        );
        // 1.875 is the steepest of the curve
        let most = 0.5 * 8e-3 * (1.875 * 0.1_f64).powi(2);
        simulation.advance(1).unwrap();
        let first = simulation.energies().unwrap().kinetic;
        for time in [0.02, 0.05, 0.08, 0.1] {
            simulation.advance_to(time).unwrap();
            let what = format!("{scheme}, {time} s");
            let (e, tool) = (simulation.energies().unwrap(), simulation.tool("g").unwrap());
            near(&format!("{what}: constraints"), e.constraint_work.unwrap(), e.kinetic, most, 1e-12);
            near(&format!("{what}: the tool"), tool.work.unwrap() - tool.loss.unwrap(), e.kinetic, most, 1e-12);
            near(&format!("{what}: its loss"), tool.loss.unwrap(), first, most, 1e-12);
            near(&format!("{what}: balance"), missing(&mut simulation, 0.0), 0.0, most, 1e-12);
        }
        assert!(first < 1e-3 * most, "{scheme}: {first} J of {most}");
    }
}

/// What of the motion of the nodes of the upper face is lost (J) where they have another velocity (m/s) at once.
fn by_a_jolt(simulation: &mut Simulation, velocity: DVec3) -> f64 {
    let rate = 1.0 / simulation.time_step();
    let masses = simulation.masses("b").unwrap();
    let rest = simulation.rest_positions("b").unwrap();
    let view = simulation.column::<DisplacementIncrement>("b").unwrap();
    let nodes = view.node_rows().iter().zip(masses).zip(rest).filter(|(_, x)| x.z > 0.02 - 1e-9);
    let steps = nodes.map(|((&row, mass), _)| (view.values().vector(row as usize), mass));
    steps.map(|(step, mass)| 0.5 * mass * (velocity - step * rate).length_squared()).sum()
}

/// A soft cube, that falls and is damped, is taken by its upper face, drawn along and let go by a tool that moves
/// evenly.
#[test]
fn books_close_while_a_tool_takes_and_lets_go_a_part() {
    for scheme in SCHEMES {
        let mut simulation = grasped(
            scheme,
            [2e-3, 0.2],
            ", velocity: (0.05, 0, 0)",
            ", damping: 5",
            "loads: [Gravity(acceleration: (0, 0, -1))],
            tools: {\"g\": (shape: Sphere(radius: 0.006), at: (0.01, 0.01, 0.03),
                moves: [(displacement: (0, 0, 0.01), curve: Ramp(end: 0.2))])},
            attachments: [Grasp(tool: \"g\", closed: Step(start: 0.05, end: 0.15), on: Plane(normal: (0, 0, 1), at: 0.02))]",
        );
        let at_start = simulation.energies().unwrap().kinetic;
        let (mut closed, mut steps) = (false, 0);
        while simulation.time() < 0.199 {
            let jolt = by_a_jolt(&mut simulation, DVec3::new(0.0, 0.0, 0.05));
            simulation.advance(1).unwrap();
            let what = format!("{scheme}, {} s", simulation.time());
            let (e, tool) = (simulation.energies().unwrap(), simulation.tool("g").unwrap());
            if tool.nodes > 0 && !closed {
                closed = true;
                near(&format!("{what}: loss at closing"), tool.loss.unwrap(), jolt, jolt, 1e-9);
            }
            steps += usize::from(tool.nodes > 0);
            near(
                &format!("{what}: the tool"),
                e.constraint_work.unwrap(),
                tool.work.unwrap() - tool.loss.unwrap(),
                at_start,
                1e-12,
            );
            near(&format!("{what}: of all"), e.contact_loss.unwrap(), tool.loss.unwrap(), at_start, 1e-12);
            near(&format!("{what}: balance"), missing(&mut simulation, at_start), 0.0, at_start, 1e-12);
            let stored = e.strain + e.hourglass;
            near(&format!("{what}: stored"), stored, e.internal_work.unwrap(), at_start, 0.02);
        }
        assert!((48..=52).contains(&steps), "{scheme}: it holds for {steps} steps");
    }
}
