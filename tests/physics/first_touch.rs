//! What begins to move at once is no imbalance of energy, however early the guards look: the strain of half a step is
//! there then, and its work is not counted yet. What lasts is one.

use crate::configurations::{ELEMENTS, configurations};
use sinew::bevy_ecs::prelude::*;
use sinew::components::{GuardMemory, InternalWork};
use sinew::{Error, Simulation};

/// A block at rest, and a tool that comes at it with the same speed all the time.
fn touched(elements: &str, tool: &str) -> String {
    format!(
        "(duration: 0.03, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (6, 6, 4), elements: {elements}),
            material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Set(\"z0\"))], contacts: [Tool(tool: \"t\")], guards: (every: 1),
        tools: {{\"t\": (shape: {tool}, path: [(t: 0, at: (0.015, 0.015, 0.0302)), (t: 0.03, at: (0.015, 0.015, 0.0288))])}})"
    )
}

#[test]
#[ignore = "long"]
fn what_a_tool_first_touches_is_no_imbalance_however_early_the_guards_look() {
    let tools = ["Sphere(radius: 0.01)", "Box(size: (0.01, 0.01, 0.02))", "Capsule(length: 0.05, radius: 0.006)"];
    for run in configurations() {
        for (elements, tool) in ELEMENTS.iter().flat_map(|elements| tools.map(|tool| (elements, tool))) {
            let mut simulation = run.start(&touched(elements, tool));
            simulation.finish().unwrap_or_else(|error| panic!("{}, {elements}, {tool}: {error}", run.name));
            let guards = simulation.guards();
            let warned = guards.warnings.iter().any(|notice| notice.criterion == "energy");
            assert!(guards.checks > 20 && !warned, "{}, {elements}, {tool}: {guards:?}", run.name);
            assert!(guards.in_doubt.is_none() && guards.imbalance.abs() < 0.01, "{}, {elements}: {guards:?}", run.name);
        }
    }
}

/// A fifth of the energy, from nothing, of a cube that spins: less than its kinetic energy, but it lasts.
#[test]
fn an_imbalance_that_lasts_ends_the_run_as_soon_as_nothing_explains_it() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 100, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 5), elements: Hex8),
                material: \"m\", spin: (1, 2, 8))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            integration: (safety: 0.7), guards: (every: 100))",
        );
        simulation.advance(30).unwrap();
        forge(&mut simulation);
        simulation.advance(80).unwrap();
        let guards = simulation.guards();
        let warned = guards.warnings.iter().any(|notice| notice.criterion == "energy");
        assert_eq!((guards.in_doubt, warned), (Some(100), false), "{}: {guards:?}", run.name);
        // what goes on from here is in doubt of the same
        let kept = simulation.snapshot().unwrap();
        let told = ended(&mut simulation);
        simulation.restore(&kept).unwrap();
        assert_eq!(told, ended(&mut simulation), "{}", run.name);
        assert_eq!(told.0, 100 + GuardMemory::DOUBT, "{}: {told:?}", run.name);
    }
}

/// Takes a fifth of the kinetic energy out of the book of what was spent.
fn forge(simulation: &mut Simulation) {
    let less = 0.2 * simulation.energies().unwrap().kinetic;
    // a state that comes from the host, as one from a file does
    let kept = simulation.snapshot().unwrap();
    simulation.restore(&kept).unwrap();
    let world = simulation.world_mut();
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<InternalWork>>().iter(world).collect();
    for body in bodies {
        let mut work = world.get_mut::<InternalWork>(body).unwrap();
        let each = (less / work.len() as f64) as f32;
        work.iter_mut().for_each(|part| *part -= each);
    }
    let forged = simulation.snapshot().unwrap();
    simulation.restore(&forged).unwrap();
}

/// Where a run ends, and by what.
fn ended(simulation: &mut Simulation) -> (u64, String) {
    match simulation.advance(600) {
        Err(Error::Unstable(broken)) => (broken.step, broken.criterion.name.to_string()),
        other => panic!("{other:?}"),
    }
}
