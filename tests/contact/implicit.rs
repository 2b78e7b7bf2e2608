//! Contact in implicit steps: rest, friction, pressing, impact and bits, against closed forms and explicit steps.

use crate::bits::{bits_do_not_depend, start};
use crate::configurations::near;
use glam::DVec3;
use sinew::Simulation;
use sinew::components::{ContactForce, DisplacementIncrement, Precision};

const BOTH: [Precision; 2] = [Precision::F64, Precision::F32];

/// The step by whose square shares are stiffnesses (s).
fn of_springs(simulation: &mut Simulation) -> f64 {
    simulation.summary("").unwrap().stability.bound.time_step
}

/// One layer without lateral stretch: its lower nodes have half of its mass, and all sink in alike by 2 g Δt²/share.
#[test]
fn a_block_at_rest_sinks_in_by_its_weight() {
    for precision in BOTH {
        for share in [0.1, 1.0, 10.0, 100.0] {
            let mut simulation = start(
                &format!(
                    "(duration: 0.6, solver: Implicit(step: 0.01, tolerance: 1e-5),
                    bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 1), elements: Hex8MeanDilatation), material: \"m\")}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0), damping: 40)}},
                    loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1))],
                    tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", law: Penalty(share: {share}))])"
                ),
                precision,
                1,
            );
            let step = of_springs(&mut simulation);
            simulation.advance_to(0.6).unwrap();
            let (reading, weight) = (simulation.tool("table").unwrap(), 1000.0 * 4e-6 * 9.81);
            let what = format!("{precision:?}, share {share}");
            let report = simulation.implicit_steps().unwrap();
            println!("{what}: {} passes, {} Newton iterations", report.passes, report.newton_iterations);
            near(&format!("{what}: weight"), -reading.force.z, weight, weight, 1e-3);
            let depth = 2.0 * 9.81 * step * step / share;
            near(&format!("{what}: depth"), reading.penetration, depth, depth, 1e-2);
            assert!(reading.nodes == 25, "{what}: {reading:?}");
        }
    }
}

/// As explicit steps do it (`tool_friction`), with the distance that a mass slides in the same implicit steps.
#[test]
fn a_block_sticks_below_the_angle_of_friction_and_slides_beyond() {
    let (friction, damping, g, h) = (0.5, 40.0, 9.81, 2e-3_f64);
    for degrees in [20.0_f64, 25.0, 30.0, 40.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut simulation = start(
            &format!(
                "(duration: 0.6, solver: Implicit(step: {h}),
                bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 1)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: {damping})}},
                loads: [Gravity(acceleration: (0, 0, -{}), curve: Smooth(end: 0.1)),
                    Gravity(acceleration: ({}, 0, 0), curve: Smooth(start: 0.2, end: 0.3))],
                tools: {{\"table\": (shape: Plane())}},
                contacts: [Tool(tool: \"table\", friction: {friction}, law: Penalty(share: 1))],
                probes: {{\"bottom\": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0))}})",
                g * cos,
                g * sin
            ),
            Precision::F64,
            1,
        );
        simulation.advance_to(0.5).unwrap();
        let before = simulation.probe("bottom").unwrap()[0];
        simulation.advance_to(0.6).unwrap();
        let after = simulation.probe("bottom").unwrap()[0];
        let what = format!("{degrees} degrees");
        let weight = 1000.0 * 4e-6 * g;
        let reading = simulation.tool("table").unwrap();
        if degrees < 26.5 {
            assert!((after - before).abs() < 1e-7, "{what}: crept by {:e}", after - before);
            near(&format!("{what}: held"), reading.force.x, weight * sin, weight, 2e-3);
        } else {
            let (mut v, mut x) = (0.0_f64, 0.0);
            for step in 1..=(0.6 / h).round() as u32 {
                let s = ((f64::from(step) * h - 0.2) / 0.1).clamp(0.0, 1.0);
                let ramp = s * s * s * (10.0 + s * (6.0 * s - 15.0));
                v = ((v + h * g * (sin * ramp - friction * cos)) / (1.0 + damping * h)).max(0.0);
                x += v * h;
            }
            // it leans by ρ g sin θ H²/(2 G) beside, at most
            let lean = 1000.0 * g * sin * 1e-4 / (2.0 * 1e4 / 2.9);
            assert!(after > 0.99 * x && after < 1.01 * x + lean, "{what}: slid {after:e}, expected {x:e} and {lean:e}");
            let ratio = reading.force.truncate().length() / -reading.force.z;
            near(&format!("{what}: ratio"), ratio, friction, friction, 1e-3);
            assert!(reading.loss.unwrap() > 0.0, "{what}: {reading:?}");
        }
    }
}

fn pressed(solver: &str, share: f64) -> Simulation {
    start(
        &format!(
            "(duration: 0.3, {solver}
            bodies: {{\"layer\": (mesh: Box(size: (0.01, 0.01, 0.005), cells: (12, 12, 6), elements: Hex8), translate: (0, 0, -0.005), material: \"m\")}},
            materials: {{\"m\": (density: 1060, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 60)}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: -0.005)),
                Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]), Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y])],
            tools: {{\"ball\": (shape: Sphere(radius: 5e-3), at: (0, 0, 5e-3), moves: [(displacement: (0, 0, -8e-4), curve: Smooth(end: 0.2))])}},
            contacts: [Tool(tool: \"ball\", on: Surface(normal: (0, 0, 1)), law: Penalty(share: {share}))],
            probes: {{\"base\": (what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: -0.005))}},
            output: (energies_every: 0.1))"
        ),
        Precision::F64,
        2,
    )
}

/// The same springs press alike in explicit steps, whose shares are over the square of those steps. The work of the
/// ball is in the layer, but for what damping and springs have.
#[test]
fn a_ball_presses_as_in_explicit_steps() {
    let (share, shorter) = (4.0, 0.5_f64);
    let mut implicit = pressed("solver: Implicit(step: 0.01, tolerance: 1e-5),", share);
    let step = shorter * of_springs(&mut implicit);
    let mut explicit = pressed(&format!("integration: (step: {step:?}),"), share * shorter * shorter);
    for simulation in [&mut implicit, &mut explicit] {
        simulation.advance_to(0.3).unwrap();
    }
    let [solved, stepped] = [&mut implicit, &mut explicit].map(|simulation| simulation.tool("ball").unwrap());
    println!("{} passes and {} steps", implicit.implicit_steps().unwrap().passes, explicit.step_count());
    let force = stepped.force.z;
    assert!(force > 5e-4 && stepped.nodes > 8, "{stepped:?}");
    near("force", solved.force.z, force, force, 2e-3);
    near("both ways", implicit.probe("base").unwrap()[0].abs(), solved.force.z, force, 2e-3);
    near("nodes", solved.nodes as f64, stepped.nodes as f64, 1.0, 0.1);
    near("depth", solved.penetration, stepped.penetration, stepped.penetration, 5e-3);
    near("work", solved.work.unwrap(), stepped.work.unwrap(), stepped.work.unwrap(), 0.02);
    let energies = implicit.energies().unwrap();
    let spent = energies.strain + energies.hourglass + energies.kinetic + energies.damping_loss.unwrap();
    let spent = spent + energies.scheme_loss.unwrap();
    near("balance of energy", spent, energies.load_work.unwrap(), solved.work.unwrap(), 0.01);
    near(
        "work on the layer",
        energies.load_work.unwrap(),
        solved.work.unwrap() - solved.loss.unwrap(),
        solved.work.unwrap(),
        1e-6,
    );
}

/// A cube that springs throw back goes the way that it goes in explicit steps, where both resolve it; the trapezoidal
/// rule gives its speed back.
#[test]
fn a_cube_bounces_as_in_explicit_steps() {
    let (share, shorter, speed) = (0.05, 0.5_f64, 0.1);
    let thrown = |solver: &str, share: f64| {
        start(
            &format!(
                "(duration: 0.06, {solver}
                bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2)), translate: (0, 0, 0.001), velocity: (0, 0, -{speed}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))}},
                tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", law: Penalty(share: {share}))])"
            ),
            Precision::F64,
            1,
        )
    };
    let solver = "solver: Implicit(scheme: GeneralizedAlpha(high_frequencies: 1), step: 2e-4, tolerance: 1e-6),";
    let mut implicit = thrown(solver, share);
    let step = shorter * of_springs(&mut implicit);
    let mut explicit = thrown(&format!("integration: (step: {step:?}),"), share * shorter * shorter);
    let mut deepest = 0.0_f64;
    for time in [0.02, 0.03, 0.04, 0.06] {
        let [solved, stepped] = [&mut implicit, &mut explicit].map(|simulation| {
            simulation.advance_to(time).unwrap();
            let u = simulation.displacements("b").unwrap();
            // both run a part of a step beyond
            let beyond = simulation.time() - time;
            let velocity = simulation.column::<DisplacementIncrement>("b").unwrap();
            let velocity: f64 = velocity.values().vectors().map(|step| step.z).sum::<f64>() / u.len() as f64;
            let mean: f64 = u.iter().map(|u| u.z).sum::<f64>() / u.len() as f64;
            mean - beyond * velocity / simulation.time_step()
        });
        println!("{time} s: {solved:e} and {stepped:e} m");
        near(&format!("at {time} s"), solved, stepped, 1e-3, 0.01);
        deepest = deepest.min(solved);
    }
    assert!(deepest < -1.5e-3, "it sank in by {deepest} m");
}

/// Momentum of free bodies is kept by pairs of forces, and implicit Euler makes no energy.
#[test]
fn cubes_that_meet_keep_momentum() {
    for (friction, points) in [("0", "Nodes"), ("0.4", "Nodes"), ("0.4", "Faces")] {
        let cube = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\"";
        let other = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\"";
        let mut simulation = start(
            &format!(
                "(duration: 0.05, solver: Implicit(step: 1e-3),
                bodies: {{\"a\": ({cube}),
                    \"b\": ({other}, rotate: (20, 35, 10), translate: (0.012, 0.008, 0.032), velocity: (-0.1, 0.02, -0.5))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                contacts: [Between(bodies: (\"a\", \"b\"), friction: {friction}, points: {points}, law: Penalty(share: 0.5))],
                output: (energies_every: 0.001))"
            ),
            Precision::F64,
            1,
        );
        let momentum = |simulation: &mut Simulation| -> DVec3 {
            let mut all = DVec3::ZERO;
            for body in ["a", "b"] {
                let (masses, rate) = (simulation.masses(body).unwrap(), 1.0 / simulation.time_step());
                let view = simulation.column::<DisplacementIncrement>(body).unwrap();
                let rows = view.node_rows().iter().zip(masses);
                all += rows.map(|(&row, mass)| view.values().vector(row as usize) * rate * mass).sum::<DVec3>();
            }
            all
        };
        let what = format!("friction {friction}, {points}");
        let (before, energy) = (momentum(&mut simulation), simulation.energies().unwrap().kinetic);
        let mut most = 0.0_f64;
        while simulation.time() < 0.0499 {
            simulation.advance(1).unwrap();
            let view = simulation.column::<ContactForce>("b").unwrap();
            most = most.max(view.values().vectors().sum::<DVec3>().length());
            let now = simulation.energies().unwrap();
            assert!(now.kinetic + now.strain < energy * (1.0 + 1e-9), "{what}: {now:?} of {energy} J");
        }
        assert!(most > 0.1, "{what}: they never met: {most} N");
        let now = momentum(&mut simulation);
        near(&what, (now - before).length(), 0.0, before.length(), 1e-7);
    }
}

fn stack(points: &str, solver: &str) -> String {
    format!(
        "(duration: 0.6, {solver}
        bodies: {{\"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Hex8MeanDilatation), material: \"m\"),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2), elements: Hex8MeanDilatation), rotate: (0, 0, 15), translate: (0.002, -0.003, 0.0200), material: \"m\")}},
        materials: {{\"m\": (density: 1050, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 40)}},
        loads: [Gravity(body: \"low\", acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1)),
            Gravity(body: \"high\", acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1))],
        tools: {{\"table\": (shape: Plane())}},
        contacts: [Tool(tool: \"table\", body: \"low\", friction: 0.5, law: Penalty(share: 1)),
            Between(bodies: (\"low\", \"high\"), friction: 0.5, points: {points}, law: Penalty(share: 1, damping: 0.1))])"
    )
}

#[test]
fn each_block_of_a_stack_bears_those_above_it() {
    for points in ["Nodes", "Faces"] {
        for precision in BOTH {
            let mut simulation = start(&stack(points, "solver: Implicit(step: 0.01, tolerance: 1e-4),"), precision, 2);
            simulation.advance_to(0.6).unwrap();
            let weight = 1050.0 * 8e-6 * 9.81;
            let what = format!("{points}, {precision:?}");
            let report = simulation.implicit_steps().unwrap();
            println!("{what}: {report:?}");
            let table = simulation.tool("table").unwrap().force.z;
            near(&format!("{what}: table"), -table, 2.0 * weight, weight, 2e-3);
            let on_high: DVec3 = simulation.column::<ContactForce>("high").unwrap().values().vectors().sum();
            near(&format!("{what}: high"), on_high.z, weight, weight, 2e-3);
            let on_low: DVec3 = simulation.column::<ContactForce>("low").unwrap().values().vectors().sum();
            near(&format!("{what}: they are opposite"), (on_high + on_low).length(), 0.0, weight, 1e-5);
        }
    }
}

#[test]
fn bits_of_contact_do_not_depend_on_threads_and_pauses() {
    let none: fn(&mut Simulation) = |_| {};
    for points in ["Nodes", "Faces"] {
        let text = stack(points, "solver: Implicit(step: 0.01),");
        bits_do_not_depend(&text, &["low", "high"], [0.1, 0.2], [none, none]);
    }
}

/// In steps of 10 ms a block falls .8 mm into another before anybody looks, and springs lift it out: that is warned of.
/// In steps of 1 ms it is seen in time, and contact takes energy.
#[test]
fn springs_that_make_energy_in_long_steps_are_warned_of() {
    for (step, makes) in [(0.01, true), (1e-3, false)] {
        let mut simulation = start(
            &format!(
                "(duration: 0.2, solver: Implicit(step: {step:?}), bodies: {{
                    \"low\": (mesh: Box(size: (0.04, 0.04, 0.01), cells: (8, 8, 2)), material: \"m\"),
                    \"top\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\",
                        translate: (0.0091, 0.0087, 0.0101))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))}},
                constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
                loads: [Gravity(acceleration: (0, 0, -9.81))],
                contacts: [Between(bodies: (\"low\", \"top\"), law: Penalty(share: 0.5))])"
            ),
            Precision::F64,
            1,
        );
        simulation.advance_to(0.2).unwrap();
        let loss = simulation.energies().unwrap().contact_loss.unwrap();
        let summary = simulation.summary("").unwrap();
        let told: Vec<_> = summary.guards.warnings.iter().filter(|notice| notice.criterion == "contact").collect();
        println!("{step} s: {loss:.3e} J lost, {told:?}");
        assert_eq!(!told.is_empty(), makes, "{step} s: {told:?}");
        assert_eq!(loss < -1e-5, makes, "{step} s: {loss} J");
        assert!(told.iter().all(|notice| notice.message.contains("lower `step` of the solver")), "{told:?}");
    }
}

/// A block that a belt takes along from rest by friction, and that does not slide: with steps of any length it goes as
/// far as the belt, but for what it leans and for the first jerk (explicit steps: 29.4 mm of 30).
#[test]
fn a_block_sticks_to_a_belt_that_starts_at_once() {
    for (elements, cells) in [("Hex8MeanDilatation", "(2, 2, 1)"), ("Hex8", "(4, 4, 2)")] {
        for step in [0.02, 0.005, 0.001] {
            let mut simulation = start(
                &format!(
                    "(duration: 0.3, solver: Implicit(step: {step}),
                    bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: {cells}, elements: {elements}), material: \"m\")}},
                    materials: {{\"m\": (density: 1000, corotational: Young(young: 5e4, poisson: 0.3), stiffness_damping: 1e-3)}},
                    loads: [Gravity(acceleration: (0, 0, -9.81))],
                    tools: {{\"k\": (shape: Plane(), path: [(t: 0, at: (0, 0, 0)), (t: 0.3, at: (0.03, 0, 0))])}},
                    contacts: [Tool(tool: \"k\", friction: 0.8, law: Penalty(share: 1))])"
                ),
                Precision::F64,
                1,
            );
            simulation.finish().unwrap();
            let all = simulation.displacements("b").unwrap();
            let mean = all.iter().sum::<DVec3>() / all.len() as f64;
            near(&format!("{elements}, {step} s"), mean.distance(0.03 * DVec3::X), 0.0, 0.03, 0.03);
        }
    }
}
