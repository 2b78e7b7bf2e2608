//! Rigid tools against tissue: closed forms of contact, momentum, energy, friction.
//!
//! Contact finds the force that lets a node end on the tool's surface: the node is there to rounding of its place
//! (1e-12 of the body's size in f64, 1e-6 in f32), and what the tool feels is the sum of these forces, whose rounding
//! is that of m u/Δt²: 1e-9 and 1e-4 of the weight of a body at rest.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::components::{DisplacementIncrement, Precision};
use sinew::{Options, Simulation};

const TISSUE: &str = "\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)";

/// A cube of 2 cm on a table, its weight 78.48 mN.
fn on_a_table(table: &str, rest: &str) -> String {
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\")}},
        materials: {{{TISSUE}}}, loads: [Gravity(acceleration: (0, 0, -9.81))],
        tools: {{\"table\": (shape: Plane(), {table})}}, contacts: [Tool(tool: \"table\", {rest})])"
    )
}

/// Momentum of the body (kg m/s), in the middle of the last step.
fn momentum(simulation: &mut Simulation) -> DVec3 {
    let masses = simulation.masses("b").unwrap();
    let steps = steps(simulation);
    let rate = 1.0 / simulation.time_step();
    masses.iter().zip(steps).map(|(mass, step)| step * rate * *mass).sum()
}

/// Displacements of all nodes in the last step (m), in the author's order.
fn steps(simulation: &mut Simulation) -> Vec<DVec3> {
    let view = simulation.column::<DisplacementIncrement>("b").unwrap();
    view.node_rows().iter().map(|&row| view.values().vector(row as usize)).collect()
}

#[test]
fn what_rests_on_a_table_weighs_on_it_and_is_not_in_it() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&on_a_table("", ""));
        simulation.advance_to(1.0).unwrap();
        let reading = simulation.tool("table").unwrap();
        let weight = 1000.0 * 8e-6 * 9.81;
        let what = format!("{}: {reading:?}", run.name);
        // the rest of the motion: damped at 20/s for a second
        near(&what, -reading.force.z, weight, weight, 1e-4);
        near(&what, reading.force.truncate().length(), 0.0, weight, run.bound(1e-9, 1e-4));
        near(&what, reading.torque.length(), 0.01 * weight * 2.0_f64.sqrt(), 0.01 * weight, 2e-4);
        assert!(reading.penetration < run.bound(1e-15, 2e-9), "{what}");
        assert_eq!(reading.nodes, 16, "{what}");
        assert_eq!(reading.work.unwrap(), 0.0, "a table that does not move does no work: {what}");
    }
}

/// A bar in uniaxial strain that hits a plane end on: a wave of stress ρ c v goes up and comes back, the bar leaves
/// after 2 L/c with the velocity turned round. The law loses the kinetic energy of the touching half layer.
#[test]
fn a_bar_hits_a_plane_as_the_wave_equation_says() {
    let (length, speed, side) = (0.1, 0.02, 0.01_f64);
    let modulus: f64 = 3000.0 * 0.55 / (1.45 * 0.1);
    let c = (modulus / 1000.0).sqrt();
    for run in cpu_and_long_gpu() {
        for cells in [40, 80] {
            let mut simulation = run.start(&format!(
                "(duration: 0.09, bodies: {{\"b\": (mesh: Box(size: ({side}, {side}, {length}), cells: (1, 1, {cells})), material: \"m\",
                    translate: (0, 0, 1e-5), velocity: (0, 0, -{speed}))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                constraints: [Fixed(on: All, axes: [X, Y])],
                tools: {{\"wall\": (shape: Plane())}}, contacts: [Tool(tool: \"wall\")], output: (energies_every: 0.01),
                    integration: (step: 1e-4))"
            ));
            let (mut impulse, mut last, mut mean, mut count) = (0.0, 0.0, 0.0, 0.0);
            while simulation.time() < 0.085 {
                simulation.advance(1).unwrap();
                let force = -simulation.tool("wall").unwrap().force.z;
                impulse += force * simulation.time_step();
                let share = simulation.time() * c / (2.0 * length);
                if share > 0.25 && share < 0.75 {
                    (mean, count) = (mean + force, count + 1.0);
                }
                if force > 0.0 {
                    last = simulation.time();
                }
                assert!(force >= 0.0, "a wall does not pull");
            }
            let what = format!("{}, {cells} cells", run.name);
            let (duration, force) = (2.0 * length / c, 1000.0 * c * speed * side * side);
            // waves of many frequencies leave it one after the other
            near(&format!("{what}: duration"), last, duration, duration, 0.03);
            near(&format!("{what}: force"), mean / count, force, force, 0.015);
            let mass = 1000.0 * side * side * length;
            let after = momentum(&mut simulation).z;
            // what the wall gave is what the bar has: to rounding of the sums
            near(&format!("{what}: impulse"), impulse, after + mass * speed, 2.0 * mass * speed, run.bound(1e-9, 1e-4));
            near(&format!("{what}: rebound"), after / mass, speed, speed, if cells == 40 { 0.03 } else { 0.02 });
            let energies = simulation.energies().unwrap();
            let (start, end) = (0.5 * mass * speed * speed, energies.kinetic + energies.strain + energies.hourglass);
            let share = end / start;
            assert!(share <= 1.0 + 1e-3 && share >= 1.0 - 1.0 / f64::from(cells), "{what}: energy {share}");
            let loss = simulation.tool("wall").unwrap().loss.unwrap();
            near(&format!("{what}: loss"), loss, start - end, start, 2e-4);
        }
    }
}

/// Force by what nodes feel, by the change of momentum, and by the reaction of what is held.
#[test]
fn the_force_on_a_tool_is_the_same_by_three_ways() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (6, 6, 4), elements: Tet4), material: \"m\")}},
            materials: {{{TISSUE}}}, constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {{\"ball\": (shape: Sphere(radius: 0.01), at: (0.014, 0.016, 0.0301),
                moves: [(displacement: (1e-3, 0, -3e-3), curve: Smooth(end: 0.4))])}},
            contacts: [Tool(tool: \"ball\", friction: 0.3)],
            probes: {{\"held\": (what: Reaction, on: Plane(normal: (0, 0, 1), at: 0)), \"felt\": (what: ToolForce(tool: \"ball\"))}})"
        ));
        simulation.advance_to(0.2).unwrap();
        // forces at the beginning of a step change the momentum over it, and damping goes by the mean of both ends
        let (start, mut before) = (simulation.time(), momentum(&mut simulation));
        let (mut impulse, mut gained) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..5 {
            simulation.advance(1).unwrap();
            let [felt, held] = ["felt", "held"].map(|probe| DVec3::from_slice(&simulation.probe(probe).unwrap()));
            impulse += (held - felt) * simulation.time_step();
            let after = momentum(&mut simulation);
            gained += after - before + 20.0 * 0.5 * (before + after) * simulation.time_step();
            before = after;
        }
        let scale = simulation.tool("ball").unwrap().force.length() * (simulation.time() - start);
        near(&format!("{}: momentum", run.name), (gained - impulse).length(), 0.0, scale, run.bound(1e-9, 1e-4));
        simulation.advance_to(1.0).unwrap();
        let felt = simulation.tool("ball").unwrap().force;
        let held = DVec3::from_slice(&simulation.probe("held").unwrap());
        near(&format!("{}: at rest", run.name), (felt - held).length(), 0.0, felt.length(), 1e-3);
        assert!(felt.z > 1e-3, "{}: {felt}", run.name);
    }
}

/// The work of a tool is stored, damped or lost: nothing else.
#[test]
fn the_work_of_a_tool_is_accounted_for() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 0.4, bodies: {\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (6, 6, 4)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 5)},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {\"rod\": (shape: Capsule(length: 0.05, radius: 0.006), path: [(t: 0, at: (0.01, 0.015, 0.021)),
                (t: 0.1, at: (0.01, 0.015, 0.017)), (t: 0.3, at: (0.018, 0.015, 0.017), rotation: (0, 30, 0)), (t: 0.4,
                    at: (0.018, 0.015, 0.03))])},
            contacts: [Tool(tool: \"rod\", friction: 0.2)], output: (energies_every: 0.1))",
        );
        for time in [0.1, 0.2, 0.3, 0.4] {
            simulation.advance_to(time).unwrap();
            let (energies, reading) = (simulation.energies().unwrap(), simulation.tool("rod").unwrap());
            let stored = energies.kinetic + energies.strain + energies.hourglass;
            let work = reading.work.unwrap() - reading.loss.unwrap();
            let balance = work - energies.damping_loss.unwrap() - stored;
            let scale = reading.work.unwrap().abs().max(stored);
            near(
                &format!("{} at {time}: {energies:?} {reading:?}", run.name),
                balance,
                0.0,
                scale,
                run.bound(5e-3, 5e-3),
            );
            near("loads do what tools do", energies.load_work.unwrap(), work, scale, run.bound(1e-9, 1e-4));
            // where the tool turns at once what slips does so half a step later: by the largest force, .1 N, at .04 m/s
            let behind = 0.1 * 0.04 * simulation.time_step();
            assert!(reading.loss.unwrap() > -behind, "{}: {reading:?}", run.name);
        }
    }
}

/// Three planes of a corner, each turned: every one feels its part of the weight.
#[test]
fn a_cube_in_a_corner_leans_on_all_three_planes() {
    for run in configurations() {
        let mut simulation = run.start(&format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2)), material: \"m\")}},
            materials: {{{TISSUE}}}, loads: [Gravity(acceleration: (-2, -3, -6))],
            tools: {{\"floor\": (shape: Plane()), \"left\": (shape: Plane(), rotation: (0, 90, 0)),
                \"back\": (shape: Plane(), rotation: (-90, 0, 0))}},
            contacts: [Tool(tool: \"floor\"), Tool(tool: \"left\"), Tool(tool: \"back\")])"
        ));
        simulation.advance_to(1.0).unwrap();
        for (tool, expected) in [
            ("floor", DVec3::new(0.0, 0.0, -6.0)),
            ("left", DVec3::new(-2.0, 0.0, 0.0)),
            ("back", DVec3::new(0.0, -3.0, 0.0)),
        ] {
            let reading = simulation.tool(tool).unwrap();
            let (force, weight) = (reading.force, 8e-3 * 7.0);
            let what = format!("{}, {tool}: {reading:?}", run.name);
            near(&what, (force - 8e-3 * expected).length(), 0.0, weight, 2e-4);
            assert!(reading.penetration < run.bound(1e-12, 1e-8), "{what}");
        }
    }
}

/// Between two planes at an acute angle the turns at a node have to find forces that fit.
#[test]
fn a_wedge_of_planes_holds_what_falls_into_it() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 1.5, bodies: {\"b\": (mesh: Ellipsoid(radii: (0.01, 0.01, 0.01), across: 6), material: \"m\",
                translate: (0, 0, 0.0205))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4), damping: 30)},
            loads: [Gravity(acceleration: (0, 0, -9.81))],
            tools: {\"right\": (shape: Plane(), rotation: (0, -60, 0)), \"left\": (shape: Plane(), rotation: (0, 60, 0))},
            contacts: [Tool(tool: \"right\"), Tool(tool: \"left\")])",
        );
        simulation.advance_to(1.5).unwrap();
        let weight = simulation.masses("b").unwrap().iter().sum::<f64>() * 9.81;
        let [right, left] = ["right", "left"].map(|tool| simulation.tool(tool).unwrap());
        let sum = right.force + left.force;
        near(&format!("{}: {right:?} {left:?}", run.name), -sum.z, weight, weight, 2e-3);
        near(run.name, right.force.length(), weight, weight, 0.02);
        assert!(right.penetration.max(left.penetration) < run.bound(1e-12, 1e-8), "{}: {right:?} {left:?}", run.name);
    }
}

/// A plate presses a block without friction: the same as prescribing its face, uniform to rounding.
#[test]
fn a_plate_presses_a_block_evenly() {
    for run in configurations() {
        let block = |held: &str, plate: &str| {
            run.start(&format!(
                "(duration: 1, analysis: Static(), bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02),
                    cells: (3, 3, 3)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]), Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y]),
                    Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [Z]) {held}], {plate}
                probes: {{\"base\": (what: Reaction, on: Plane(normal: (0, 0, 1), at: 0))}})"
            ))
        };
        let mut told =
            block(", Prescribed(on: Plane(normal: (0, 0, 1), at: 0.02), axes: [Z], displacement: (0, 0, -3e-3))", "");
        let mut pressed = block(
            "",
            "tools: {\"plate\": (shape: Box(size: (0.1, 0.1, 0.02)), at: (0.01, 0.01, 0.03), moves: [(displacement: (0, 0, -3e-3))])},
            contacts: [Tool(tool: \"plate\", on: Plane(normal: (0, 0, 1), at: 0.02))],",
        );
        for simulation in [&mut told, &mut pressed] {
            crate::equilibrium::rest(run.name, simulation);
        }
        let [expected, found] = [&mut told, &mut pressed].map(|simulation| simulation.probe("base").unwrap()[2]);
        near(run.name, found, expected, expected, run.bound(1e-5, 1e-3));
        let felt = pressed.tool("plate").unwrap();
        near(run.name, felt.force.z, found, found, run.bound(1e-5, 1e-3));
        let (a, b) = (told.displacements("b").unwrap(), pressed.displacements("b").unwrap());
        let far = a.iter().zip(b).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        assert!(far < run.bound(1e-7, 2e-6), "{}: {far:e} m apart", run.name);
    }
}

/// Nodes that start inside are pushed out gently, and what they gain is no more than a spring's energy would be.
#[test]
fn a_small_overlap_at_the_start_settles() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 0.2, bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0.02))],
            tools: {\"table\": (shape: Plane(), at: (0, 0, 1.5e-3))}, contacts: [Tool(tool: \"table\")], output: (energies_every: 0.1))",
        );
        let mut most = 0.0_f64;
        while simulation.time() < 0.2 {
            simulation.advance(5).unwrap();
            let energies = simulation.energies().unwrap();
            most = most.max(energies.kinetic + energies.strain);
        }
        // squeezed by .3 of a layer over the whole height: ½ M ε² V
        let (modulus, strain) = (3000.0 * 0.55 / (1.45 * 0.1), 1.5e-3 / 0.02);
        assert!(most < 3.0 * 0.5 * modulus * strain * strain * 8e-6, "{}: {most:e} J", run.name);
        let reading = simulation.tool("table").unwrap();
        assert!(reading.penetration < run.bound(1e-12, 1e-8), "{}: {reading:?}", run.name);
    }
}

/// A body far from the origin is touched as one that is there: places count from a point near the body.
#[test]
fn far_from_the_origin_contact_is_the_same() {
    let mut forces = Vec::new();
    for shift in [0.0, 1e4] {
        for run in cpu_and_long_gpu() {
            let mut simulation = run.start(&format!(
                "(duration: 0.3, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (5, 5, 3)),
                    material: \"m\", translate: ({shift}, 0, 0))}},
                materials: {{{TISSUE}}}, constraints: [Fixed(on: Surface(normal: (0, 0, -1)))],
                tools: {{\"ball\": (shape: Sphere(radius: 0.01), at: ({}, 0.015, 0.0302),
                    moves: [(displacement: (0, 0, -3e-3), curve: Smooth(end: 0.2))])}},
                contacts: [Tool(tool: \"ball\", friction: 0.1)])",
                0.015 + shift
            ));
            simulation.advance_to(0.3).unwrap();
            forces.push(simulation.tool("ball").unwrap().force.z);
        }
    }
    let (here, there) = forces.split_at(forces.len() / 2);
    // rest positions in f64 are known to 1.8e-12 m there
    here.iter().zip(there).for_each(|(here, there)| near("far away", *there, *here, *here, 1e-3));
    here.iter().for_each(|force| near("every configuration", *force, here[0], here[0], 1e-3));
}

fn bits_of(simulation: &mut Simulation) -> Vec<u64> {
    let reading = simulation.tool("rod").unwrap();
    let u = simulation.displacements("b").unwrap();
    let numbers = u
        .iter()
        .flat_map(|u| u.to_array())
        .chain(reading.force.to_array())
        .chain([reading.work.unwrap(), reading.loss.unwrap()]);
    numbers.map(f64::to_bits).collect()
}

const DRAWN: &str = "(duration: 0.2, bodies: {\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (9, 9, 6),
    elements: Tet4), material: \"m\")},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 5)},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], FUSE
    tools: {\"rod\": (shape: Capsule(length: 0.05, radius: 0.006), moves: [(displacement: (0.01, 0, 0),
        curve: Input(name: \"x\", rate: 4))],
        path: [(t: 0, at: (0.01, 0.015, 0.021)), (t: 0.05, at: (0.01, 0.015, 0.017))])},
    contacts: [Tool(tool: \"rod\", friction: 0.2)])";

/// Threads, passes apart and together, snapshots: the same bits.
#[test]
fn bits_with_tools_do_not_depend_on_how_steps_are_taken() {
    for run in cpu_and_long_gpu() {
        let of = |threads: usize, fuse: &str, resume: bool| {
            let scene = crate::configurations::scene_of(&DRAWN.replace("FUSE", fuse), std::path::Path::new("."));
            let options = Options { threads, ..run.options.clone() };
            let mut simulation = Simulation::new(&scene, &options).unwrap();
            simulation.set_input("x", 1.0).unwrap();
            simulation.advance(40).unwrap();
            if resume {
                let snapshot = simulation.snapshot().unwrap();
                simulation = Simulation::new(&scene, &options).unwrap();
                simulation.restore(&snapshot).unwrap();
            }
            simulation.advance(60).unwrap();
            bits_of(&mut simulation)
        };
        let first = of(1, "", false);
        assert!(first == of(1, "", true), "{}: resumed", run.name);
        if !is_gpu(&run) {
            assert!(first == of(1, "fuse: false,", false), "{}: apart", run.name);
            [2, 3]
                .into_iter()
                .for_each(|threads| assert!(first == of(threads, "", false), "{}: {threads} threads", run.name));
        }
    }
}

fn is_gpu(run: &Configuration) -> bool {
    run.options.precision == Precision::F32 && run.name.starts_with("GPU")
}

/// What a program sets moves the tool, at the rate that the scene allows.
#[test]
fn an_input_moves_a_tool() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&DRAWN.replace("FUSE", ""));
        simulation.advance_to(0.06).unwrap();
        let before = simulation.tool("rod").unwrap();
        simulation.set_input("x", 0.5).unwrap();
        let start = simulation.time();
        simulation.advance_to(0.16).unwrap();
        let after = simulation.tool("rod").unwrap();
        let share = (4.0 * (simulation.time() - start)).min(0.5);
        near(run.name, after.place.x - before.place.x, 0.01 * share, 0.01, 1e-6);
        assert!(after.force.x < -1e-4, "{}: pushed sideways it feels {:?}", run.name, after.force);
    }
}
