//! Tools that move freely: momentum, energy, rest, and what they share with guided ones.

use crate::bits::{bits_do_not_depend, start};
use crate::configurations::{configurations, cpu_and_long_gpu, near};
use glam::{DQuat, DVec3};
use sinew::components::{DisplacementIncrement, Precision};
use sinew::{Error, Simulation};

/// A ball of 1.6 times the density of a cube of 2 cm that hits one of its sides off its middle, turning; both are free.
const HIT: &str =
    "(duration: 0.2, bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
    tools: {\"ball\": (shape: Sphere(radius: 0.008), at: (0.013, 0.007, 0.0281), rotation: (30, 0, 10),
        free: (density: 1600, velocity: (0.02, 0.01, -0.2), spin: (900, 300, -200)))},
    contacts: [Tool(tool: \"ball\", friction: 0.3)], output: (energies_every: 0.01), integration: (safety: 0.5))";

/// Momentum, and its moment about the origin, of nodes and a tool, in the middle of the last step.
fn momenta(simulation: &mut Simulation, tool: &str) -> (DVec3, DVec3) {
    let (masses, at) = (simulation.masses("b").unwrap(), simulation.rest_positions("b").unwrap());
    let (u, rate) = (simulation.displacements("b").unwrap(), 1.0 / simulation.time_step());
    let view = simulation.column::<DisplacementIncrement>("b").unwrap();
    let steps: Vec<DVec3> = view.node_rows().iter().map(|&row| view.values().vector(row as usize)).collect();
    let free = simulation.tool(tool).unwrap().free.unwrap();
    let (mut sum, mut moment) = (free.velocity * free.mass, free.angular_momentum);
    moment += free.center.cross(sum);
    for (row, mass) in masses.iter().enumerate() {
        let momentum = steps[row] * rate * *mass;
        sum += momentum;
        moment += (at[row] + u[row]).cross(momentum);
    }
    (sum, moment)
}

/// Both keep what they have together, and what is lost is what impact and friction take. Rounding: 1e-16 and 1e-7 of
/// forces and steps, of some hundreds of them.
#[test]
fn a_ball_and_a_cube_that_collide_keep_their_momentum_and_make_no_energy() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(HIT);
        let free = simulation.tool("ball").unwrap().free.unwrap();
        let (kinetic, momentum) = (free.kinetic, free.velocity * free.mass);
        let moment = free.center.cross(momentum) + free.angular_momentum;
        let (mut touched, mut lost) = (0, 0.0_f64);
        while simulation.time() < 0.15 {
            simulation.advance(1).unwrap();
            let reading = simulation.tool("ball").unwrap();
            touched += usize::from(reading.nodes > 0);
            assert!(
                reading.loss.unwrap() >= lost - 1e-12 * kinetic,
                "{}: {} J after {lost} J",
                run.name,
                reading.loss.unwrap()
            );
            lost = reading.loss.unwrap();
            assert!(reading.penetration < 1e-4, "{}: {reading:?}", run.name);
        }
        let (sum, about) = momenta(&mut simulation, "ball");
        let (bound, of_moment) = (run.bound(1e-10, 1e-5), run.bound(1e-10, 1e-4));
        near(&format!("{}: momentum", run.name), sum.distance(momentum), 0.0, momentum.length(), bound);
        near(&format!("{}: its moment", run.name), about.distance(moment), 0.0, moment.length(), of_moment);
        let free = simulation.tool("ball").unwrap().free.unwrap();
        assert!(touched > 10 && free.velocity.z > -0.1 && lost > 1e-3 * kinetic, "{touched} {free:?} {lost}");
        assert_eq!(simulation.tool("ball").unwrap().nodes, 0, "they have parted");
        let e = simulation.energies().unwrap();
        let all = e.kinetic + e.internal_work.unwrap() - e.load_work.unwrap() - kinetic;
        near(&format!("{}: energy", run.name), all, 0.0, kinetic, run.bound(1e-10, 1e-4));
        near(&format!("{}: what is lost", run.name), -e.load_work.unwrap(), lost, kinetic, run.bound(1e-10, 1e-4));
        assert!(e.kinetic + e.strain < kinetic, "{e:?} of {kinetic} J");
    }
}

#[test]
#[ignore = "long"]
fn a_ball_that_is_let_go_comes_to_rest_on_tissue_and_weighs_on_what_holds_it() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.03, 0.03, 0.015), cells: (8, 8, 4)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 200)},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
            tools: {\"ball\": (shape: Sphere(radius: 0.008), at: (0.015, 0.015, 0.0235), free: (mass: 0.004, damping: 20))},
            contacts: [Tool(tool: \"ball\", friction: 0.3)],
            probes: {\"held\": (what: Reaction, on: Plane(normal: (0, 0, 1), at: 0))})",
        );
        simulation.advance_to(0.9).unwrap();
        let reading = simulation.tool("ball").unwrap();
        let free = reading.free.unwrap();
        let (weight, tissue) = (0.004 * 9.81, 0.03 * 0.03 * 0.015 * 1000.0 * 9.81);
        near(&format!("{}: what it feels", run.name), reading.force.z, weight, weight, 1e-3);
        let held = simulation.summary("").unwrap().probes["held"].1.clone();
        near(&format!("{}: what holds it", run.name), held[2], weight + tissue, weight, 2e-3);
        assert!(free.velocity.length() < 2e-4 && free.spin.length() < 0.02, "{}: {free:?}", run.name);
        // friction at rest is one of many states: turns are taken in order, and so it leans by a hundredth of its
        // radius
        assert!(free.center.truncate().distance(DVec3::splat(0.015).truncate()) < 2e-4, "{}: {free:?}", run.name);
        assert!(reading.nodes > 4 && reading.penetration < run.bound(1e-12, 1e-8), "{}: {reading:?}", run.name);
        // it has sunk in, and gravity did the work for it
        let fallen = 0.0235 - free.center.z;
        assert!(fallen > 1e-3 && fallen < 4e-3, "{free:?}");
        near(&format!("{}: potential energy", run.name), free.potential, -weight * fallen, weight * fallen, 1e-3);
    }
}

/// A body that is heavier than all tissue goes on as a guided tool goes, and does to tissue what that does: its own
/// share of each correction is 1e-9 of it. With friction on a flat one: on round ones each finds pushes and friction in
/// turns of its own.
#[test]
#[ignore = "long"]
fn a_tool_too_heavy_to_be_held_up_is_a_guided_one() {
    let rod = ("Capsule(length: 0.05, radius: 0.006)", 0.0152, "");
    let press = ("Box(size: (0.2, 0.2, 0.01))", 0.0202, ", friction: 0.2, static_friction: 0.3");
    for (shape, z, friction) in [rod, press] {
        let scene = |way: &str| {
            format!(
                "(duration: 0.06, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.015), cells: (6, 6, 3)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
                constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
                tools: {{\"rod\": (shape: {shape}, {way})}}, contacts: [Tool(tool: \"rod\"{friction})])"
            )
        };
        let end = z - 0.05;
        let guided = scene(&format!("path: [(t: 0, at: (0.01, 0.015, {z})), (t: 1, at: (0.06, 0.02, {end}))]"));
        let free = scene(&format!("at: (0.01, 0.015, {z}), free: (mass: 1e6, velocity: (0.05, 0.005, -0.05))"));
        for run in configurations() {
            let [(u, felt), (other, also)] = [&guided, &free].map(|scene| {
                let mut simulation = run.start(scene);
                simulation.advance_to(0.03).unwrap();
                (simulation.displacements("b").unwrap(), simulation.tool("rod").unwrap())
            });
            let what = |what: &str| format!("{}, {shape}: {what}", run.name);
            let largest = u.iter().map(|u| u.length()).fold(0.0, f64::max);
            let off = u.iter().zip(&other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(largest > 1e-3, "{largest} m");
            near(&what("displacements"), off, 0.0, largest, run.bound(1e-6, 1e-3));
            let off = felt.force.distance(also.force);
            near(&what("force"), off, 0.0, felt.force.length(), run.bound(1e-5, 1e-2));
            assert_eq!(felt.nodes, also.nodes);
            near(&what("place"), felt.place.distance(also.place), 0.0, 1e-3, 1e-6);
            near(&what("work"), also.work.unwrap(), felt.work.unwrap(), felt.work.unwrap(), run.bound(1e-5, 1e-2));
            near(&what("loss"), also.loss.unwrap(), felt.loss.unwrap(), felt.work.unwrap(), run.bound(1e-5, 1e-2));
        }
    }
}

/// Alone in the world: u = v t + ½ g t², e^(−ct), and a box that tumbles about its middle axis.
#[test]
#[ignore = "long"]
fn a_free_tool_that_touches_nothing_falls_tumbles_and_is_damped_as_closed_forms_say() {
    let scene = |free: &str, load: &str| {
        format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [{load}],
            tools: {{\"ball\": (shape: Box(size: (0.01, 0.02, 0.04)), at: (1, 2, 30), rotation: (10, 20, 30), free: ({free}))}},
            contacts: [Tool(tool: \"ball\")], integration: (step: 2e-3), output: (energies_every: 0.1))"
        )
    };
    for run in configurations() {
        let what = |what: &str| format!("{}: {what}", run.name);
        let mut falls = run.start(&scene(
            "density: 500, velocity: (1, 0, 2), spin: (20, 400, 5)",
            "Gravity(acceleration: (0, 0, -9.81))",
        ));
        let start = falls.tool("ball").unwrap().free.unwrap();
        assert!((start.mass / 0.004 - 1.0).abs() < 1e-14, "{start:?}");
        falls.advance_to(1.0).unwrap();
        let free = falls.tool("ball").unwrap().free.unwrap();
        near(&what("place"), free.center.distance(DVec3::new(2.0, 2.0, 30.0 + 2.0 - 4.905)), 0.0, 1.0, 1e-12);
        assert_eq!(free.angular_momentum, start.angular_momentum);
        let of_turn = |free: &sinew::observation::FreeReading| 0.5 * free.spin.dot(free.angular_momentum);
        near(&what("energy of turning"), of_turn(&free), of_turn(&start), of_turn(&start), 1e-12);
        assert!(free.spin.distance(start.spin) > 0.1 * start.spin.length(), "it tumbles: {free:?}");
        let mut slows = run.start(&scene(
            "mass: 0.1, inertia: (1e-4, 2e-4, 2.5e-4), velocity: (1, 0, 0), spin: (0, 0, 300), damping: 2",
            "",
        ));
        let start = slows.tool("ball").unwrap().free.unwrap();
        slows.advance_to(1.0).unwrap();
        let free = slows.tool("ball").unwrap().free.unwrap();
        // in the middle of the last step; damping is centred, of second order: (c Δt)²/12
        let left = (-2.0 * (1.0 - 1e-3_f64)).exp();
        near(&what("speed"), free.velocity.x, left, left, 1e-5);
        near(
            &what("spin"),
            free.angular_momentum.length(),
            left * start.angular_momentum.length(),
            left * start.angular_momentum.length(),
            1e-5,
        );
        near(&what("damped"), free.damping_loss, start.kinetic - free.kinetic, start.kinetic, 1e-12);
    }
}

#[test]
fn free_tools_have_the_same_bits_on_any_number_of_threads_and_from_any_step_on() {
    bits_do_not_depend(
        HIT,
        &["b"],
        [0.02, 0.06],
        [
            |paused| assert!(paused.tool("ball").unwrap().nodes > 0),
            |ended| assert!(ended.tool("ball").unwrap().loss.unwrap() > 0.0),
        ],
    );
    let reading = |threads: usize| {
        let mut simulation = start(HIT, Precision::F64, threads);
        simulation.advance_to(0.06).unwrap();
        format!("{:?}", simulation.tool("ball").unwrap())
    };
    let wanted = reading(1);
    assert!([2, 3, 4].into_iter().all(|threads| reading(threads) == wanted));
}

#[test]
fn what_goes_on_from_a_snapshot_of_a_free_tool_gives_the_same_bits_on_each_backend() {
    for run in configurations() {
        let mut whole = run.start(HIT);
        whole.advance_to(0.02).unwrap();
        let kept = sinew::Snapshot::from_bytes(&whole.snapshot().unwrap().to_bytes().unwrap()).unwrap();
        let at = format!("{:?}", whole.tool("ball").unwrap());
        whole.advance(20).unwrap();
        let wanted = format!("{:?} {:?}", whole.tool("ball").unwrap(), whole.displacements("b").unwrap());
        let mut other = run.start(HIT);
        other.restore(&kept).unwrap();
        assert_eq!(format!("{:?}", other.tool("ball").unwrap()), at, "{}", run.name);
        other.advance(20).unwrap();
        let found = format!("{:?} {:?}", other.tool("ball").unwrap(), other.displacements("b").unwrap());
        assert!(found == wanted, "{}: another way on", run.name);
    }
}

/// A rod whose middle is not its origin: arms turn with it, by how long the step was that it felt something in.
#[test]
fn a_moment_that_was_felt_stays_where_the_next_step_is_another() {
    let rod = "Capsule(length: 0.02, radius: 0.008), at: (0.013, 0.007, 0.0221)";
    let mut simulation =
        start(&HIT.replace("Sphere(radius: 0.008), at: (0.013, 0.007, 0.0281)", rod), Precision::F64, 1);
    while simulation.time() < 0.1 && simulation.tool("ball").unwrap().nodes == 0 {
        simulation.advance(1).unwrap();
    }
    simulation.advance(3).unwrap();
    let before = simulation.tool("ball").unwrap();
    simulation.set_time_step(0.2 * simulation.time_step()).unwrap();
    let after = simulation.tool("ball").unwrap();
    assert!(before.force.length() > 0.0, "{before:?}");
    assert_eq!((after.force, after.torque), (before.force, before.torque));
}

#[test]
fn probes_tell_where_tools_are_and_how_fast() {
    for run in configurations() {
        let text = HIT.replace(
            "output:",
            "probes: {\"pose\": (what: ToolPose(tool: \"ball\")), \"speed\": (what: ToolVelocity(tool: \"ball\"))}, output:",
        );
        let mut simulation = run.start(&text);
        simulation.advance_to(0.02).unwrap();
        let summary = simulation.summary("").unwrap();
        simulation.observe().unwrap();
        let probes = simulation.summary("").unwrap().probes;
        let (reading, free) = (summary.tools["ball"], summary.tools["ball"].free.unwrap());
        let three = |values: &[f64]| DVec3::from_slice(&values[..3]);
        assert_eq!(three(&probes["pose"].1), reading.place, "{}", run.name);
        assert_eq!(three(&probes["speed"].1), free.velocity, "the middle of a ball: {}", run.name);
        assert_eq!(three(&probes["speed"].1[3..]), free.spin, "{}", run.name);
        assert!(three(&probes["pose"].1[3..]).length() > 10.0, "{probes:?}");
    }
}

/// How thick a plate is that is thrown at a cube, how long and wide (m), and a step (s).
const PLATE: f64 = 1e-4;
const WIDE: f64 = 0.03;
const STEP: f64 = 2e-4;

/// A plate about as heavy as a node of the cube's upper side, turned so (degrees), which goes down by so many of its
/// thicknesses in a step, from so high above the cube.
fn thrown(turned: DVec3, plates: f64, height: f64) -> String {
    let (DVec3 { x, y, z }, speed) = (turned, plates * PLATE / STEP);
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\",
            translate: (-0.01, -0.01, -0.02))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        tools: {{\"plate\": (shape: Box(size: ({WIDE}, {WIDE}, {PLATE})), at: (1e-3, 2e-3, {height}), rotation: ({x}, {y}, {z}),
            free: (density: 800, velocity: ({}, 0, -{speed})))}},
        contacts: [Tool(tool: \"plate\", friction: 0.2, thin: true)], integration: (step: {STEP}),
        probes: {{\"pose\": (what: ToolPose(tool: \"plate\"))}}, output: (energies_every: 0.01))",
        0.1 * speed
    )
}

/// Where nodes are in the plate's frame (m).
fn of_plate(simulation: &mut Simulation) -> Vec<DVec3> {
    let pose = simulation.probe("pose").unwrap();
    let turn = DVec3::from_slice(&pose[3..]) * std::f64::consts::PI / 180.0;
    let back = DQuat::from_scaled_axis(turn).inverse();
    let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
    rest.iter().zip(u).map(|(rest, u)| back * (*rest + u - DVec3::from_slice(&pose))).collect()
}

/// A plate that goes farther in a step than it is thick, up to .4 of an edge, flat or on an edge of the cube: no node
/// comes to its other side, momentum is kept, and no energy is made.
#[test]
fn a_thin_plate_that_is_thrown_at_tissue_goes_through_no_node() {
    let flat = [(1.0, 2.3e-4), (1.0, 3.1e-4), (5.0, 1e-3), (20.0, 3.3e-3)].map(|(by, from)| (DVec3::ZERO, by, from));
    let tilted = [DVec3::new(25.0, 0.0, 0.0), DVec3::new(-10.0, 30.0, 40.0)];
    let tilted = tilted.into_iter().flat_map(|turned| [1.0, 4.0].map(|by| (turned, by, 1.1e-2)));
    let cases: Vec<(DVec3, f64, f64)> = flat.into_iter().chain(tilted).collect();
    let runs = cpu_and_long_gpu();
    for (run, &(turned, plates, height)) in runs.iter().flat_map(|run| cases.iter().map(move |of| (run, of))) {
        let mut simulation = run.start(&thrown(turned, plates, height));
        let what = format!("{}, turned by {turned}, {plates} plates a step", run.name);
        let free = simulation.tool("plate").unwrap().free.unwrap();
        let (kinetic, momentum) = (free.kinetic, free.velocity * free.mass);
        let (mut before, mut touched, mut lost) = (of_plate(&mut simulation), 0, 0.0_f64);
        // until it has come there, and as long again
        let steps = 2.0 * (height / (plates * PLATE)).ceil() + 20.0;
        for step in 0..steps as u32 {
            simulation.advance(1).unwrap();
            let now = of_plate(&mut simulation);
            for (node, (from, to)) in before.iter().zip(&now).enumerate() {
                let at = from.lerp(*to, from.z / (from.z - to.z));
                let through = from.z * to.z < 0.0 && at.abs().max_element() < 0.5 * WIDE;
                assert!(!through, "{what}: node {node} goes from {from} to {to} in step {step}");
            }
            let reading = simulation.tool("plate").unwrap();
            assert!(reading.penetration < run.bound(1e-10, 1e-7), "{what}: {} m", reading.penetration);
            assert!(
                reading.loss.unwrap() >= lost - 1e-9 * kinetic,
                "{what}: {} J after {lost} J",
                reading.loss.unwrap()
            );
            (before, lost, touched) = (now, reading.loss.unwrap(), touched + usize::from(reading.nodes > 0));
        }
        let (sum, _) = momenta(&mut simulation, "plate");
        near(&format!("{what}: momentum"), sum.distance(momentum), 0.0, momentum.length(), run.bound(1e-10, 1e-5));
        let e = simulation.energies().unwrap();
        assert!(
            touched > 0 && lost > 0.1 * kinetic && e.kinetic + e.strain < kinetic,
            "{what}: {touched} {lost} {e:?}"
        );
    }
}

/// As a guided one (`physics/swept.rs`): a needle far heavier than all that it meets comes down on a row of nodes of a
/// slab, by up to 2.4 of its radii in a step, and they end on the side that they were on.
#[test]
fn a_thin_free_needle_takes_nodes_along_that_it_would_have_jumped_over() {
    let (radius, step) = (2e-4, 2e-6);
    for run in cpu_and_long_gpu() {
        for radii in [0.4, 1.0, 1.9, 2.4] {
            let mut simulation = run.start(&format!(
                "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.001), cells: (10, 10, 1), elements: Hex8),
                    material: \"m\", translate: (-0.005, -0.005, -0.001))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.4))}},
                tools: {{\"needle\": (shape: Capsule(length: 0.02, radius: {radius}), at: (0, -0.01, 3e-4),
                    rotation: (-90, 0, 0), free: (mass: 1e6, velocity: (0, 0, -{})))}},
                contacts: [Tool(tool: \"needle\", thin: true)], integration: (step: {step}))",
                radii * radius / step
            ));
            let steps = if radii < 1.0 { 2 } else { 1 };
            for step in 1..=steps {
                simulation.advance(1).unwrap();
                let surface = 3e-4 - f64::from(step) * radii * radius - radius;
                let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
                let row = rest.iter().zip(u).filter(|(x, _)| x.x.abs() < 1e-9 && x.z.abs() < 1e-9);
                let heights: Vec<f64> = row.map(|(x, u)| x.z + u.z).collect();
                assert_eq!(heights.len(), 11);
                for height in heights {
                    let what = format!("{}, {radii} radii a step, step {step}", run.name);
                    near(&what, height, surface.min(0.0), 0.01, run.bound(1e-12, 1e-6));
                }
            }
        }
    }
}

#[test]
#[ignore = "long"]
fn a_tool_that_became_too_fast_to_be_seen_ends_the_run_with_its_reason() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.02), cells: (10, 10, 2)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            constraints: [Fixed(on: All)], loads: [Gravity(acceleration: (0, 0, -100))], integration: (step: 1e-3),
            tools: {\"ball\": (shape: Sphere(radius: 0.03), at: (0.05, 0.05, 0.5), free: (mass: 0.1))},
            contacts: [Tool(tool: \"ball\")])",
        );
        // √(2 × 100 × .45) = 9.5 m/s
        let Err(Error::Unstable(broken)) = simulation.advance_to(1.0) else { panic!("{}: it went through", run.name) };
        assert_eq!(broken.criterion.name, "speed", "{broken}");
        assert!(broken.to_string().contains("the free tool `ball` goes") && broken.body == "b", "{broken}");
        let time = (2.0_f64 * 0.45 / 100.0).sqrt();
        assert!(broken.time > 0.9 * time && broken.time < 1.05 * time, "{broken} {time}");
    }
}
