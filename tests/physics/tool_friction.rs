//! Friction between tools and tissue: sticking and sliding, directions, what it takes.

use crate::configurations::{configurations, cpu_and_long_gpu, near};

/// Gravity stands in for a slope: its part along the table grows while the block lies on it already. One layer of
/// elements: softer blocks ring when they slide (Adams 1995), and what hops is held less.
#[test]
fn a_block_sticks_below_the_angle_of_friction_and_slides_beyond() {
    let (friction, damping, g) = (0.5, 40.0, 9.81);
    for run in cpu_and_long_gpu() {
        // the critical angle is 26.57 degrees
        for degrees in [20.0_f64, 25.0, 30.0, 40.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let mut simulation = run.start(&format!(
                "(duration: 0.6, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 1)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: {damping})}},
                loads: [Gravity(acceleration: (0, 0, -{}), curve: Smooth(end: 0.1)),
                    Gravity(acceleration: ({}, 0, 0), curve: Smooth(start: 0.2, end: 0.3))],
                tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", friction: {friction})],
                probes: {{\"bottom\": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0))}})",
                g * cos,
                g * sin
            ));
            simulation.advance_to(0.5).unwrap();
            let before = simulation.probe("bottom").unwrap()[0];
            simulation.advance_to(0.6).unwrap();
            let after = simulation.probe("bottom").unwrap()[0];
            let what = format!("{}, {degrees} degrees", run.name);
            let weight = 1000.0 * 4e-6 * g;
            let reading = simulation.tool("table").unwrap();
            if degrees < 26.5 {
                assert!((after - before).abs() < run.bound(1e-8, 5e-8), "{what}: crept by {:e}", after - before);
                near(&format!("{what}: held"), reading.force.x, weight * sin, weight, 2e-3);
            } else {
                // v̇ = g (sin θ r(t) − μ cos θ) − c v from where that is above 0
                let (mut v, mut x, steps) = (0.0_f64, 0.0, 100_000);
                for step in 0..steps {
                    let time = 0.6 * (f64::from(step) + 0.5) / f64::from(steps);
                    let s = ((time - 0.2) / 0.1).clamp(0.0, 1.0);
                    let ramp = s * s * s * (10.0 + s * (6.0 * s - 15.0));
                    let rate = g * (sin * ramp - friction * cos) - damping * v;
                    v = (v + rate * 0.6 / f64::from(steps)).max(0.0);
                    x += v * 0.6 / f64::from(steps);
                }
                // it leans by ρ g sin θ H²/(2 G) beside, at most
                let lean = 1000.0 * g * sin * 1e-4 / (2.0 * 1e4 / 2.9);
                assert!(
                    after > 0.99 * x && after < 1.01 * x + lean,
                    "{what}: slid {after:e}, expected {x:e} and {lean:e}"
                );
                let ratio = reading.force.truncate().length() / -reading.force.z;
                near(&format!("{what}: ratio"), ratio, friction, friction, 1e-3);
                assert!(reading.loss.unwrap() > 0.0, "{what}");
            }
        }
    }
}

/// What sticks is held by the larger coefficient, what slides by the smaller one. One flat element, pressed evenly: a
/// larger block begins to slide at its edges, and slides as a whole long before it is pulled by the larger coefficient.
#[test]
fn what_sticks_is_held_better_than_what_slides() {
    for run in cpu_and_long_gpu() {
        for (pull, slides) in [(0.55, false), (0.65, true)] {
            let mut simulation = run.start(&format!(
                "(duration: 0.5, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.001), cells: (1, 1, 1)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: 40)}},
                loads: [Gravity(acceleration: (0, 0, -10), curve: Smooth(end: 0.1)),
                    Gravity(acceleration: ({}, 0, 0), curve: Smooth(start: 0.2, end: 0.3))],
                tools: {{\"table\": (shape: Plane())}},
                contacts: [Tool(tool: \"table\", friction: 0.3, static_friction: 0.6)],
                probes: {{\"all\": (what: Displacement, on: All)}})",
                10.0 * pull
            ));
            simulation.advance_to(0.5).unwrap();
            let reading = simulation.tool("table").unwrap();
            let ratio = reading.force.x / -reading.force.z;
            let what = format!("{}, pulled at {pull}: {reading:?}", run.name);
            if slides {
                // it rings as it slides: now and then more is held than 0.3
                assert!(ratio < 0.5 && simulation.probe("all").unwrap()[0] > 5e-3, "{what}");
            } else {
                near(&what, ratio, pull, 1.0, 2e-3);
            }
        }
    }
}

#[test]
fn friction_is_against_the_slip_whatever_its_direction() {
    for run in cpu_and_long_gpu() {
        for degrees in [0.0_f64, 33.0, 120.0, 250.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let mut simulation = run.start(&format!(
                "(duration: 0.3, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.005), cells: (4, 4, 1)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: 20)}},
                loads: [Gravity(acceleration: ({}, {}, -10), curve: Smooth(end: 0.1))],
                tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", friction: 0.2)])",
                6.0 * cos,
                6.0 * sin
            ));
            simulation.advance_to(0.3).unwrap();
            let force = simulation.tool("table").unwrap().force;
            let angle = (force.y.atan2(force.x).to_degrees() - degrees + 540.0).rem_euclid(360.0) - 180.0;
            assert!(angle.abs() < 0.5, "{}: {angle} degrees off {degrees}", run.name);
        }
    }
}

/// A block that slides to rest: v²/(2 μ g) far, in v/(μ g), and what friction takes is what it had.
#[test]
fn a_sliding_block_comes_to_rest_where_friction_says() {
    let (speed, friction, g) = (0.1, 0.3, 9.81);
    for run in configurations() {
        let mut simulation = run.start(&format!(
            "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.004), cells: (4, 4, 1)), material: \"m\", velocity: ({speed}, 0, 0))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.45))}},
            loads: [Gravity(acceleration: (0, 0, -{g}))],
            tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", friction: {friction})],
            probes: {{\"all\": (what: Displacement, on: All)}}, output: (energies_every: 0.1))"
        ));
        let rest = speed / (friction * g);
        simulation.advance_to(2.0 * rest).unwrap();
        let (way, mass) = (speed * speed / (2.0 * friction * g), 1000.0 * 1.6e-6);
        near(&format!("{}: way", run.name), simulation.probe("all").unwrap()[0], way, way, 0.03);
        let loss = simulation.tool("table").unwrap().loss.unwrap();
        // weight that falls on the table at once rings too: some of its energy is lost, none is won
        let kinetic = 0.5 * mass * speed * speed;
        near(&format!("{}: loss", run.name), loss, kinetic, kinetic, 0.05);
    }
}
