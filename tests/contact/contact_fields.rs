//! Fields and probes of contact, against what is known of blocks that rest and that slide.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use crate::frames::{Frame, run_into};
use sinew::Simulation;

/// Runs a scene to its end into a folder, and reads a frame.
fn last_frame(run: &Configuration, scene: &str, number: usize) -> (Simulation, Frame) {
    let place = tempfile::tempdir().unwrap();
    let mut simulation = run.start(scene);
    run_into(&mut simulation, place.path());
    let frame = Frame::read(place.path(), number);
    (simulation, frame)
}

/// A block rests on another, both between smooth walls: at every node the pressure is what is above it, ρ g H, whatever
/// the node's share of the area; the shares are the footprint in sum.
#[test]
#[ignore = "long"]
fn the_pressure_under_a_block_is_its_weight_over_its_area() {
    let (pressure, area) = (1000.0 * 9.81 * 0.02, 4e-4);
    for run in configurations() {
        for (points, sweeps) in [("Nodes", 1), ("Faces", 1), ("Faces", 4)] {
            let mut block = String::new();
            for (name, at) in [("high", 0.02), ("low", 0.0)] {
                block += &format!(
                    "\"{name}\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Hex8), material: \"m\", translate: (0, 0, {at})),"
                );
            }
            let mut wall = String::new();
            for name in ["high", "low"] {
                wall += &format!(
                    "Fixed(body: \"{name}\", on: Or([Set(\"x0\"), Set(\"x1\")]), axes: [X]), Fixed(body: \"{name}\", on: Or([Set(\"y0\"), Set(\"y1\")]), axes: [Y]),"
                );
            }
            let mut probe = String::new();
            for what in ["ContactForce", "ContactPressure", "ContactArea", "ContactGap", "ContactSlip"] {
                probe += &format!("\"{what}\": (body: \"high\", what: {what}, on: Set(\"z0\"), every: 0.5),");
            }
            let scene = format!(
                "(duration: 1, bodies: {{{block}}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 40)}},
                constraints: [Fixed(body: \"low\", on: Set(\"z0\"), axes: [Z]), {wall}],
                loads: [Gravity(body: \"high\", acceleration: (0, 0, -9.81), curve: Smooth(end: 0.2))],
                contacts: [Between(bodies: (\"high\", \"low\"), points: {points}, sweeps: {sweeps})], probes: {{{probe}}},
                output: (fields_every: 0.5, fields: [Displacement, Velocity, VonMises, ContactPressure, ContactArea, ContactGap, ContactSlip, ContactForce, ContactTraction]))"
            );
            let (mut simulation, frame) = last_frame(&run, &scene, 2);
            let what = format!("{}, {points}, {sweeps}", run.name);
            let rest = simulation.rest_positions("high").unwrap();
            // what is left of the motion, e^(−20 · .8 s), and of f32
            let bound = run.bound(1e-5, 1e-3);
            let (mut footprint, mut touching) = (0.0, 0);
            for (node, place) in rest.iter().enumerate() {
                let number = |name: &str| frame.array(name)[node][0];
                if place.z < 0.0201 {
                    near(&what, number("node:contact_pressure"), pressure, pressure, bound);
                    // what one sweep leaves: .13 h p/E; of f32 the digits of a place
                    assert!(number("node:contact_gap").abs() < 0.2 * 0.007 * pressure / 2e4, "{what}: {node}");
                    footprint += number("node:contact_area");
                    touching += 1;
                } else {
                    let all = ["pressure", "area"].map(|name| number(&format!("node:contact_{name}")));
                    assert_eq!(all, [0.0, 0.0], "{what}: nothing touches node {node} at {place}");
                    assert!(number("node:contact_gap") > 1e-3, "{what}: nothing is near node {node}");
                }
                // it stands still, but for rounding
                assert!(number("node:contact_slip") < 1e-6, "{what}");
            }
            assert_eq!(touching, 16);
            // f32 places in the frame's sums
            near(&what, footprint, area, area, 1e-5);
            let mut probe = |name: &str| simulation.probe(name).unwrap();
            near(&what, probe("ContactPressure")[0], pressure, pressure, bound);
            near(&what, probe("ContactArea")[0], area, area, 1e-5);
            near(&what, probe("ContactForce")[2], pressure * area, pressure * area, bound);
            assert!(probe("ContactGap")[0].abs() < 0.2 * 0.007 * pressure / 2e4, "{what}");
            assert!(probe("ContactSlip")[0] < 1e-6, "{what}");
        }
    }
}

/// A block whose top is moved by 2 cm along another slides by as much below, less what it leans: μ p/G of its height,
/// half a per cent of the way. What holds it is μ times what presses it, by the law exactly where all of it slides.
#[test]
#[ignore = "long"]
fn a_block_that_is_drawn_slides_as_far_as_it_is_drawn() {
    for run in configurations() {
        for points in ["Nodes", "Faces"] {
            let scene = format!(
                "(duration: 0.6, bodies: {{
                    \"low\": (mesh: Box(size: (0.06, 0.02, 0.01), cells: (9, 3, 2)), material: \"m\"),
                    \"high\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\", translate: (0.01, 0.005, 0.01))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 40)}},
                constraints: [Fixed(body: \"low\", on: Set(\"z0\")),
                    Prescribed(body: \"high\", on: Set(\"z1\"), axes: [Z], displacement: (0, 0, -3e-4), curve: Smooth(end: 0.1)),
                    Fixed(body: \"high\", on: Set(\"z1\"), axes: [Y]),
                    Prescribed(body: \"high\", on: Set(\"z1\"), axes: [X], displacement: (0.02, 0, 0), curve: Smooth(start: 0.1, end: 0.5))],
                contacts: [Between(bodies: (\"high\", \"low\"), friction: 0.1, points: {points})],
                probes: {{\"slip\": (body: \"high\", what: ContactSlip, on: Set(\"z0\")), \"force\": (body: \"high\", what: ContactForce, on: Set(\"z0\"))}})"
            );
            let mut simulation = run.start(&scene);
            simulation.advance_to(0.3).unwrap();
            let what = format!("{}, {points}", run.name);
            let force = simulation.probe("force").unwrap();
            assert!(force[2] > 1e-3, "{what}: {force:?}");
            // nodes of the lower block that press from below act on the sides as well
            near(&what, -force[0] / force[2], 0.1, 0.1, 0.05);
            simulation.finish().unwrap();
            near(&what, simulation.probe("slip").unwrap()[0], 0.02, 0.02, 0.03);
        }
    }
}

/// What slides without friction, and under a free tool, is told as what slides with it.
#[test]
fn smooth_bodies_and_free_tools_slide_as_far_as_they_go() {
    let block = "(duration: 0.05, bodies: {
            \"low\": (mesh: Box(size: (0.06, 0.02, 0.01), cells: (12, 4, 2), elements: Hex8), material: \"m\"),
            \"high\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), translate: (0.01, 0.005, 0.01),
                material: \"m\", velocity: (0.3, 0, 0))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3))},
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(body: \"high\", acceleration: (0, 0, -9.81))], contacts: [Between(bodies: (\"low\", \"high\"))],
        probes: {\"slip\": (what: ContactSlip, body: \"high\", on: Plane(normal: (0, 0, 1), at: 0.01)),
            \"u\": (what: Displacement, body: \"high\", on: Plane(normal: (0, 0, 1), at: 0.01))})";
    // a node that the box, 14 mm long, goes over from end to end
    let thrown = "(duration: 0.1, bodies: {\"slab\": (mesh: Box(size: (0.06, 0.02, 0.01), cells: (24, 8, 2),
            elements: Hex8MeanDilatation), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 100)},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.01))],
        tools: {\"box\": (shape: Box(size: (0.014, 0.014, 0.006)), rounding: 1e-3, at: (0.012, 0.01, 0.01305),
            free: (density: 2000, velocity: (0.3, 0, 0)))},
        contacts: [Tool(tool: \"box\", friction: 0.1)],
        probes: {\"slip\": (what: ContactSlip, on: Box(min: (0.0249, 0.0099, 0.0099), max: (0.0251, 0.0101, 0.0101)))})";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(block);
        simulation.finish().unwrap();
        let [slip, gone] = ["slip", "u"].map(|name| simulation.probe(name).unwrap()[0]);
        near(&format!("{}: a smooth block", run.name), slip, gone, gone, 0.03);
        assert!(gone > 0.0145, "{gone}");
        let mut simulation = run.start(thrown);
        simulation.finish().unwrap();
        near(&format!("{}: a free box", run.name), simulation.probe("slip").unwrap()[0], 0.0125, 0.0125, 0.12);
    }
}

/// Points of faces come and go beyond edges: what nodes have slid only grows all the same, and who is pressed is near.
#[test]
fn with_points_of_faces_what_has_slid_only_grows_and_who_is_pressed_is_near() {
    // the lower nodes of the upper block
    let low = 0..16;
    let probe = |node: usize| {
        let of = |name: &str, what: &str| format!("\"{name}{node}\": (body: \"c\", what: {what}, on: Nodes([{node}]))");
        [of("slip", "ContactSlip"), of("gap", "ContactGap"), of("force", "ContactForce")].join(", ")
    };
    let probes: Vec<String> = low.clone().map(probe).collect();
    let scene = format!(
        "(duration: 0.03, bodies: {{
            \"b\": (mesh: Box(size: (0.03, 0.03, 0.01), cells: (6, 6, 2)), translate: (-0.015, -0.015, -0.01), material: \"t\"),
            \"c\": (mesh: Box(size: (0.012, 0.012, 0.006), cells: (3, 3, 2)), translate: (-0.0071, -0.0063, 0), material: \"t\")}},
        materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 20)}},
        constraints: [Fixed(body: \"b\", on: All),
            Prescribed(body: \"c\", on: Set(\"z1\"), axes: [Z], displacement: (0, 0, -0.0002),
                curve: Table([(0, 0), (0.004, 1), (0.016, 1), (0.02, -2), (0.03, -2)])),
            Prescribed(body: \"c\", on: Set(\"z1\"), axes: [X, Y], displacement: (0.002, 0.001, 0),
                curve: Table([(0, 0), (0.004, 0), (0.014, 1)]))],
        contacts: [Between(bodies: (\"b\", \"c\"), friction: 0.2, points: Faces)], probes: {{{}}})",
        probes.join(", ")
    );
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&scene);
        assert!(low.clone().all(|node| simulation.rest_positions("c").unwrap()[node].z.abs() < 1e-9));
        let (mut before, mut pressed) = ([0.0; 16], 0);
        for step in 1..=30 {
            simulation.advance_to(1e-3 * f64::from(step)).unwrap();
            for node in low.clone() {
                let [slip, gap, force] =
                    ["slip", "gap", "force"].map(|of| simulation.probe(&format!("{of}{node}")).unwrap());
                let what = format!("{}, {step} ms, node {node}", run.name);
                assert!(slip[0] >= before[node], "{what}: {} m after {} m", slip[0], before[node]);
                before[node] = slip[0];
                if force[2] > 1e-4 {
                    pressed += 1;
                    assert!(gap[0] < 5e-5, "{what}: pressed {} m away", gap[0]);
                }
            }
        }
        assert!(pressed > 100, "{}: {pressed}", run.name);
        assert!(before.iter().all(|&slid| slid > 1e-3 && slid < 3.5e-3), "{}: {before:?}", run.name);
    }
}

/// A block goes at .1 m/s towards another, 10 mm away: from the length of its edges on, 6 mm, its gap and that of the
/// other one are told as they are, whatever the step, the law and the points, and however the scene is turned. Contact
/// itself looks no farther than a step goes.
#[test]
fn a_gap_is_told_from_an_edge_on_whatever_a_step_reaches() {
    let spring = "law: Penalty(share: 0.5, damping: 0)";
    for run in cpu_and_long_gpu() {
        for (steps, law, points, turned) in [
            ("integration: (step: 5e-4)", "law: Kinematic", "Nodes", "0, 0, 0"),
            ("integration: (step: 1e-4)", "law: Kinematic", "Nodes", "0, 0, 0"),
            ("integration: (step: 5e-4)", "law: Kinematic", "Faces", "20, 30, 50"),
            ("integration: (step: 5e-4)", spring, "Nodes", "20, 30, 50"),
            ("integration: (step: 1e-4)", spring, "Faces", "0, 0, 0"),
            ("solver: Implicit(step: 2e-3)", spring, "Nodes", "20, 30, 50"),
            ("solver: Implicit(step: 2e-3)", spring, "Faces", "0, 0, 0"),
        ] {
            // contacts take part in implicit steps on the CPU only
            if steps.starts_with("solver") && run.name.starts_with("GPU") {
                continue;
            }
            for thickness in [0.0, 1e-3] {
                let mut simulation = run.start(&format!(
                    "(duration: 0.1, {steps}, parts: {{\"x\": (rotate: ({turned}), content: (
                        bodies: {{
                            \"b\": (mesh: Box(size: (0.04, 0.04, 0.012), cells: (4, 4, 2), elements: Hex8), material: \"m\"),
                            \"c\": (mesh: Box(size: (0.012, 0.012, 0.012), cells: (2, 2, 2), elements: Hex8), material: \"m\",
                                translate: (0.0141, 0.0133, 0.022), velocity: (0, 0, -0.1))}},
                        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
                        contacts: [Between(bodies: (\"b\", \"c\"), {law}, points: {points}, thickness: {thickness:?})],
                        probes: {{\"b\": (body: \"b\", what: ContactGap, on: All),
                            \"c\": (body: \"c\", what: ContactGap, on: All)}}))}})"
                ));
                for time in [0.01, 0.02, 0.046, 0.06, 0.07, 0.08] {
                    simulation.advance_to(time).unwrap();
                    let gap = 0.01 - 0.1 * time - thickness;
                    let what = format!("{}, {steps}, {law}, {points}, {turned}, {thickness}, {time} s", run.name);
                    let [b, c] = ["x.b", "x.c"].map(|probe| simulation.probe(probe).unwrap()[0]);
                    // in f32 each of up to 800 steps rounds by 5e-10 m, and forces of nothing by 1e-3 Pa
                    let bound = run.bound(1e-8, 1e-3);
                    near(&format!("{what}: of what goes"), c, gap.min(6e-3), 0.01, bound);
                    if gap < 6e-3 {
                        near(&format!("{what}: of what stands"), b, gap, 0.01, bound);
                    }
                }
            }
        }
    }
}

/// What is gone faces nothing: its gap is the mean length of an edge, as of all that is far from everything.
#[test]
fn what_is_gone_touches_nothing() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 0.02, integration: (step: 5e-4), bodies: {
                \"b\": (mesh: Box(size: (0.012, 0.012, 0.012), cells: (2, 2, 2), elements: Hex8), material: \"m\"),
                \"c\": (mesh: Box(size: (0.012, 0.012, 0.012), cells: (2, 2, 2), elements: Hex8), material: \"m\",
                    translate: (0, 0, 0.014))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))},
            contacts: [Between(bodies: (\"b\", \"c\"))], removal: [(body: \"c\", when: At(0.01))],
            probes: {\"b\": (body: \"b\", what: ContactGap, on: All),
                \"c\": (body: \"c\", what: ContactGap, on: All)})",
        );
        for (time, gap) in [(0.005, 2e-3), (0.015, 6e-3)] {
            simulation.advance_to(time).unwrap();
            for body in ["b", "c"] {
                let what = format!("{}, {body} at {time} s", run.name);
                near(&what, simulation.probe(body).unwrap()[0], gap, gap, 1e-5);
            }
        }
    }
}
