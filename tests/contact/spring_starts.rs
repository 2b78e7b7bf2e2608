//! Springs of explicit steps bear from the first step on what their law says, and begin at the rest that was found.

use crate::bits::start;
use crate::configurations::{configurations, near};
use sinew::Simulation;
use sinew::components::{ContactForce, Precision};

const SEARCHES: [&str; 2] = ["Equilibrium()", "Equilibrium(method: Newton)"];

/// A cube whose lowest nodes, a quarter of its mass, are .1 mm inside of a plane: f m δ/Δt², in the first step, and
/// when steps have another length.
#[test]
fn the_force_of_a_spring_is_that_of_its_law_whatever_the_step_before() {
    let (share, depth, mass) = (0.3, 1e-4, 0.25 * 0.125);
    for run in configurations() {
        let mut simulation = run.start(&format!(
            "(duration: 0.01, integration: (step: 1e-4),
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
            bodies: {{\"b\": (mesh: Box(size: (0.05, 0.05, 0.05), cells: (2, 2, 2), elements: Hex8), material: \"m\", translate: (0, 0, -{depth:e}))}},
            tools: {{\"p\": (shape: Plane())}}, contacts: [Tool(tool: \"p\", law: Penalty(share: {share}))])"
        ));
        let bound = run.bound(1e-4, 1e-3);
        let lowest = simulation.rest_positions("b").unwrap().iter().position(|at| at.z < 0.0).unwrap();
        for step in [1e-4, 5e-5, 1e-4] {
            simulation.set_time_step(step).unwrap();
            let inside = depth - simulation.displacements("b").unwrap()[lowest].z;
            simulation.advance(1).unwrap();
            let expected = share * mass * inside / (step * step);
            let found = -simulation.tool("p").unwrap().force.z;
            near(&format!("{}, step {step}", run.name), found, expected, expected, bound);
        }
    }
}

/// Mean height (m) of a body.
fn height(simulation: &mut Simulation, body: &str) -> f64 {
    let all = simulation.displacements(body).unwrap();
    all.iter().map(|u| u.z).sum::<f64>() / all.len() as f64
}

/// Goes on from rest, where a body bears so much (N), to the end.
fn stays(simulation: &mut Simulation, what: &str, body: &str, weight: f64, bears: fn(&mut Simulation) -> f64) {
    simulation.observe().unwrap();
    assert_eq!(simulation.step_count(), 0);
    let begins = height(simulation, body);
    near(&format!("{what}: at rest"), bears(simulation), weight, weight, 1e-4);
    let (mut most, mut moved) = (0.0_f64, 0.0_f64);
    while !simulation.is_finished() {
        simulation.advance_towards_end(1).unwrap();
        most = most.max((bears(simulation) / weight - 1.0).abs());
        moved = moved.max((height(simulation, body) / begins - 1.0).abs());
    }
    println!("{what}: forces differ by {most:.1e}, and it moves by {moved:.1e} of {begins:.2e} m");
    assert!(most <= 1e-3 && moved <= 1e-3, "{what}: {most:e} of the force, {moved:e} of the displacement");
    let energies = simulation.energies().unwrap();
    assert!(energies.kinetic <= 1e-6 * energies.strain, "{what}: {energies:?}");
}

/// By a step of its own, and by the stable one.
const STEPS: [&str; 2] = ["integration: (step: 5e-4),", ""];

#[test]
fn a_block_that_rests_on_a_table_stays_there() {
    for (search, step) in SEARCHES.into_iter().flat_map(|search| STEPS.map(|step| (search, step))) {
        let text = format!(
            "(duration: 0.02, start: {search}, {step}
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
            bodies: {{\"b\": (mesh: Box(size: (0.04, 0.04, 0.02), cells: (4, 4, 2)), material: \"m\")}},
            tools: {{\"t\": (shape: Plane())}}, contacts: [Tool(tool: \"t\", law: Penalty(share: 0.3))],
            loads: [Gravity(acceleration: (0, 0, -9.81))])"
        );
        let bears = |simulation: &mut Simulation| -simulation.tool("t").unwrap().force.z;
        let mut simulation = start(&text, Precision::F64, 1);
        stays(&mut simulation, &format!("{search}, {step}"), "b", 0.032 * 9.81, bears);
    }
}

/// Squeezed by a tenth by its weight, it has another stable step than undeformed.
#[test]
fn a_block_that_is_squeezed_by_its_weight_begins_with_springs_of_the_step_that_it_takes() {
    for search in SEARCHES {
        let text = format!(
            "(duration: 0.05, start: {search},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\")}},
            tools: {{\"t\": (shape: Plane())}}, contacts: [Tool(tool: \"t\", law: Penalty(share: 0.5))],
            loads: [Gravity(acceleration: (0, 0, -9.81))])"
        );
        let mut simulation = start(&text, Precision::F64, 1);
        simulation.advance(1).unwrap();
        let force = -simulation.tool("t").unwrap().force.z;
        near(&format!("{search}: the first step"), force, 9.81, 9.81, 1e-3);
        simulation.finish().unwrap();
    }
}

/// Between bodies a spring acts on the masses of both, split among all that touches.
#[test]
fn a_block_that_rests_on_another_stays_there() {
    for (search, step) in SEARCHES.into_iter().flat_map(|search| STEPS.map(|step| (search, step))) {
        for points in ["Nodes", "Faces"] {
            let text = format!(
                "(duration: 0.02, start: {search}, {step}
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
                bodies: {{\"low\": (mesh: Box(size: (0.1, 0.1, 0.05), cells: (2, 2, 1)), material: \"m\"),
                    \"top\": (mesh: Box(size: (0.1, 0.1, 0.05), cells: (2, 2, 1)), material: \"m\", translate: (0, 0, 0.05))}},
                constraints: [Fixed(body: \"low\", on: Set(\"z0\")), Fixed(body: \"top\", on: All, axes: [X, Y])],
                contacts: [Between(bodies: (\"low\", \"top\"), points: {points}, law: Penalty(share: 0.3))],
                loads: [Gravity(body: \"top\", acceleration: (0, 0, -2))])"
            );
            let bears = |simulation: &mut Simulation| {
                simulation.column::<ContactForce>("top").unwrap().values().vectors().map(|force| force.z).sum::<f64>()
            };
            let mut simulation = start(&text, Precision::F64, 1);
            stays(&mut simulation, &format!("{search}, {step} {points}"), "top", 1.0, bears);
        }
    }
}
