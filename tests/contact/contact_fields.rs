//! Fields and probes of contact, against what is known of blocks that rest and that slide.

use crate::configurations::{Configuration, configurations, near};
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
                assert_eq!(number("node:contact_slip"), 0.0, "{what}");
            }
            assert_eq!(touching, 16);
            // f32 places in the frame's sums
            near(&what, footprint, area, area, 1e-5);
            let mut probe = |name: &str| simulation.probe(name).unwrap();
            near(&what, probe("ContactPressure")[0], pressure, pressure, bound);
            near(&what, probe("ContactArea")[0], area, area, 1e-5);
            near(&what, probe("ContactForce")[2], pressure * area, pressure * area, bound);
            assert!(probe("ContactGap")[0].abs() < 0.2 * 0.007 * pressure / 2e4, "{what}");
            assert_eq!(probe("ContactSlip"), [0.0], "{what}");
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
