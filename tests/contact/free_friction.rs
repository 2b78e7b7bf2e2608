//! Free tools: friction that holds them as a whole, and books beside others.

use crate::configurations::{configurations, near};

/// A box of 20 × 10.5 × 10.4 mm on a plate that is held, under gravity that tilts by so much of its vertical part.
fn tilted(share: f64, friction: f64, static_friction: f64) -> String {
    format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.06, 0.02, 0.001), cells: (30, 10, 1)), material: \"m\",
            translate: (0, -0.01, -0.001))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
        constraints: [Fixed(on: All)],
        loads: [Gravity(acceleration: (0, 0, -9.2)), Gravity(acceleration: ({}, 0, 0), curve: Ramp(start: 0.01, end: 0.05))],
        tools: {{\"k\": (shape: Box(size: (0.02, 0.0105, 0.0104)), at: (0.0115, 0, 0.0052), free: (density: 1000))}},
        contacts: [Tool(tool: \"k\", on: Surface(normal: (0, 0, 1)), friction: {friction}, static_friction: {static_friction})],
        integration: (step: 1e-4))",
        9.2 * share
    )
}

/// A body holds while the load along the surface is below the static coefficient times that across it, however nodes
/// share it, and slides by the kinetic one beyond.
#[test]
fn a_free_box_sticks_to_its_static_coefficient_and_slides_by_its_kinetic_one() {
    for run in configurations() {
        for (share, static_friction) in [(0.364, 0.5), (0.47, 0.5), (0.364, 0.8)] {
            let mut simulation = run.start(&tilted(share, 0.2, static_friction));
            simulation.advance_to(0.1).unwrap();
            let free = simulation.tool("k").unwrap().free.unwrap();
            let what = format!("{}, {share} of {static_friction}", run.name);
            assert!(free.velocity.length() < 1e-5, "{what}: it slides by {} m/s", free.velocity.x);
        }
        let mut simulation = run.start(&tilted(0.6, 0.2, 0.5));
        simulation.advance_to(0.1).unwrap();
        let speed = simulation.tool("k").unwrap().free.unwrap().velocity.x;
        // .5 is reached five sixths of the way up the ramp; then it goes by what is beyond .2
        let goes = 0.01 + 0.04 * 0.5 / 0.6;
        let expected = 9.2 * (0.5 * (0.3 + 0.4) * (0.05 - goes) + 0.4 * 0.05);
        near(&format!("{}: beyond", run.name), speed, expected, expected, 0.02);
    }
}

/// A guided ball that presses nodes which a free one lies on: what the free one loses is counted by where nodes went.
#[test]
fn a_free_tool_beside_a_guided_one_at_the_same_nodes_loses_what_it_can() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 0.3, bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (8, 8, 8), elements: Hex8MeanDilatation),
                material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.4), damping: 200)},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
            tools: {\"k\": (shape: Sphere(radius: 0.006), at: (0.013, 0.01, 0.0261), free: (density: 3000)),
                \"p\": (shape: Sphere(radius: 0.004), at: (0.01, 0.01, 0.0245),
                    moves: [(displacement: (0, 0, -0.003), curve: Smooth(end: 0.1))])},
            contacts: [Tool(tool: \"k\", body: \"b\", friction: 0.3), Tool(tool: \"p\", body: \"b\", friction: 0.5)],
            output: (energies_every: 0.05))",
        );
        let [before, after] = [0.15, 0.3].map(|time| {
            simulation.advance_to(time).unwrap();
            let (k, p) = (simulation.tool("k").unwrap(), simulation.tool("p").unwrap());
            println!(
                "{}, {time} s: k lost {:e} J, p did {:e} J and lost {:e}",
                run.name,
                k.loss.unwrap(),
                p.work.unwrap(),
                p.loss.unwrap()
            );
            (k.loss.unwrap(), p.work.unwrap())
        });
        near(&format!("{}: lost", run.name), after.0, 0.0, after.1, 0.1);
        near(&format!("{}: lost when all is still", run.name), after.0, before.0, after.1, 0.01);
    }
}
