//! Two closed tools at the same nodes: the last one has them, and whom it lets go the other takes up where it is.

use crate::bits::start;
use crate::configurations::{configurations, near};
use sinew::Simulation;
use sinew::components::Precision;

/// A block of 1 cm³, its upper nodes in two forceps: one that stands still, and one that lifts them by 1 mm and opens
/// at .25 s.
fn scene(more: &str) -> String {
    let grasp = |tool: &str, closed: &str| {
        format!("Grasp(tool: \"{tool}\", on: Plane(normal: (0, 0, 1), at: 0.01), closed: {closed})")
    };
    let tool = |moves: &str| format!("(shape: Sphere(radius: 0.01), at: (0.005, 0.005, 0.01) {moves})");
    let lifts = ", moves: [(displacement: (0, 0, 1e-3), curve: Smooth(end: 0.1))]";
    format!(
        "(duration: 0.4, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3), damping: 100)}},
        loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1))],
        tools: {{\"stands\": {}, \"lifts\": {}}}, attachments: [{}, {}], {more} output: (energies_every: 0.05))",
        tool(""),
        tool(lifts),
        grasp("stands", "Step()"),
        grasp("lifts", "Step(end: 0.25)")
    )
}

fn is_borne(what: &str, simulation: &mut Simulation, (at, bound): (f64, f64)) {
    let weight = 1e-6 * 1000.0 * 9.81;
    let top = |simulation: &mut Simulation| {
        let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
        let row = (0..rest.len()).find(|&row| rest[row].z > 0.01 - 1e-9).unwrap();
        u[row].z
    };
    simulation.advance_to(0.24).unwrap();
    let [stands, lifts] = ["stands", "lifts"].map(|tool| simulation.tool(tool).unwrap());
    println!("{what}: {:e} N and {:e} N, {:e} J", stands.force.z, lifts.force.z, lifts.work.unwrap());
    near(&format!("{what}: who stands"), stands.force.length(), 0.0, weight, 1e-9);
    near(&format!("{what}: who lifts"), -lifts.force.z, weight, weight, 2e-3);
    near(&format!("{what}: work"), lifts.work.unwrap(), weight * 1e-3, weight * 1e-3, 0.5);
    near(&format!("{what}: lifted"), top(simulation), 1e-3, 1e-3, at);
    simulation.advance_to(0.4).unwrap();
    let [stands, lifts] = ["stands", "lifts"].map(|tool| simulation.tool(tool).unwrap());
    near(&format!("{what}: who stands bears it then"), -stands.force.z, weight, weight, 2e-3);
    near(&format!("{what}: who has opened"), lifts.force.length(), 0.0, weight, 1e-9);
    near(&format!("{what}: where it was let go"), top(simulation), 1e-3, 1e-3, at);
    // a jump by a millimetre in a step would have given a thousand times as much
    let loss = simulation.energies().unwrap().contact_loss.unwrap();
    near(&format!("{what}: lost"), loss, 0.0, weight * 1e-3, bound);
}

#[test]
fn the_last_of_two_grasps_has_the_nodes_and_hands_them_over() {
    for run in configurations() {
        let mut simulation = run.start(&scene("integration: (step: 1e-4),"));
        is_borne(run.name, &mut simulation, (run.bound(1e-9, 1e-4), 0.02));
    }
}

#[test]
fn in_implicit_steps_too() {
    let mut simulation = start(&scene("solver: Implicit(step: 2e-3),"), Precision::F64, 1);
    is_borne("implicit", &mut simulation, (1e-9, 0.02));
}

/// Whose nodes another tool takes over bears nothing of them until that has opened.
fn is_handed_over(what: &str, simulation: &mut Simulation) {
    let weight = 1e-6 * 1000.0 * 9.81;
    for (time, bears) in [(0.19, [1.0, 0.0]), (0.29, [0.0, 1.0]), (0.4, [1.0, 0.0])] {
        simulation.advance_to(time).unwrap();
        for (tool, share) in ["stands", "lifts"].into_iter().zip(bears) {
            let force = simulation.tool(tool).unwrap().force;
            near(&format!("{what}: {tool} at {time} s"), -force.z, share * weight, weight, 2e-3);
        }
    }
}

#[test]
fn who_has_been_taken_over_feels_nothing() {
    let scene = |more: &str| scene(more).replace("Step(end: 0.25)", "Step(start: 0.2, end: 0.3)");
    for run in configurations() {
        is_handed_over(run.name, &mut run.start(&scene("integration: (step: 1e-4),")));
    }
    is_handed_over("implicit", &mut start(&scene("solver: Implicit(step: 2e-3),"), Precision::F64, 1));
}
