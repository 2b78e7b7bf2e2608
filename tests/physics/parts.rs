//! A part that is turned and moved does what it does unturned, turned: meshes, selections, fibres, loads, motions of
//! nodes, tools, starts and probes are all placed alike.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use glam::{DMat3, DVec3};
use sinew::Simulation;

/// Something of everything that has a place or a direction, about the middle of nothing.
const PART: &str = r#"
    bodies: {"b": (mesh: Box(size: (0.02, 0.03, 0.02), cells: (4, 5, 4), elements: Hex8), material: "m",
        translate: (0.01, 0, 0), rotate: (0, 20, 0), velocity: (0.01, 0, 0.02), spin: (0, 0.3, 0.5),
        start: Affine(gradient: ((0, 0.02, 0), (0, 0.01, 0), (0, 0, -0.02)), center: (0.01, 0, 0)),
        regions: [(on: Box(min: (0, 0, -0.1), max: (0.03, 0.015, 0.1), rotate: (0, 0, 5)), material: "n")])},
    materials: {
        "m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20,
            fibres: (eta: 2e3, direction: Along(1, 2, 0))),
        "n": (density: 1100, neo_hookean: Young(young: 4e3, poisson: 0.4), damping: 20,
            exponential_fibres: [(k1: 1e3, k2: 2, direction: Around(center: (0.02, 0, 0), axis: (0, 1, 0)))]),
    },
    constraints: [
        Fixed(on: Surface(normal: (0, -1, 0))),
        Prescribed(on: And([Set("y1"), Ellipsoid(center: (0.012, 0.03, -0.004), radii: (0.006, 0.002, 0.004))]),
            displacement: (0, 1e-3, 0), rotation: (0, 10, 5), center: (0.02, 0.03, 0), curve: Smooth(end: 0.04),
            gradient: ((0.1, 0, 0), (0, 0, 0.1), (0, 0, 0)))],
    loads: [
        NodalForce(on: Plane(normal: (0, 1, 0), at: 0.03), force: (0, 0, 1e-4), curve: Smooth(end: 0.04)),
        Traction(on: Surface(normal: (0, 1, 0)), traction: (20, 0, 10)),
        Pressure(on: Surface(normal: (1, 0, -0.3), within: 20), pressure: 40)],
    tools: {"t": (shape: Cone(length: 0.03, tip: 4e-3, base: 8e-3), path: [
        (t: 0, at: (0.02, 0.015, 0.02), rotation: (0, 15, 0)), (t: 0.05, at: (0.02, 0.016, 0.014), rotation: (10, 0, 20))],
        moves: [(displacement: (1e-3, 0, 0), rotation: (0, 0, 30), curve: Smooth(end: 0.05))])},
    contacts: [Tool(tool: "t", friction: 0.2)],
    probes: {
        "force": (what: Force(direction: (0, 1, 1)), on: Surface(normal: (0, -1, 0)), every: 0.01),
        "moment": (what: Torque(center: (0, 0.01, 0), axis: (1, 0, 1)), on: Surface(normal: (0, -1, 0)), every: 0.01)},
"#;
const REST: &str = "duration: 0.05, integration: (step: 2e-5)";

/// The part as a scene of its own, and as a part.
fn alone() -> String {
    format!("({REST}, {PART})")
}

fn placed(placement: &str) -> String {
    format!("({REST}, parts: {{\"p\": (content: ({PART}), {placement})}})")
}

fn end(run: &Configuration, scene: &str) -> Simulation {
    let mut simulation = run.start(scene);
    simulation.finish().unwrap();
    simulation
}

#[test]
fn a_part_that_is_not_placed_gives_the_bits_of_the_scene_without_parts() {
    for run in cpu_and_long_gpu() {
        let (mut alone, mut part) = (end(&run, &alone()), end(&run, &placed("")));
        assert_eq!(alone.displacements("b").unwrap(), part.displacements("p.b").unwrap(), "{}", run.name);
        assert_eq!(alone.tool("t").unwrap().force, part.tool("p.t").unwrap().force, "{}", run.name);
    }
}

#[test]
fn a_part_that_is_turned_and_moved_moves_turned() {
    let (rotate, translate) = (DVec3::new(40.0, -70.0, 130.0), DVec3::new(0.02, -0.01, 0.03));
    let turn = [DMat3::from_rotation_z, DMat3::from_rotation_y, DMat3::from_rotation_x];
    let turn = turn[0](rotate.z.to_radians()) * turn[1](rotate.y.to_radians()) * turn[2](rotate.x.to_radians());
    for run in cpu_and_long_gpu() {
        let placement = format!(
            "rotate: {:?}, translate: {:?}",
            <(f64, f64, f64)>::from(rotate),
            <(f64, f64, f64)>::from(translate)
        );
        let (mut alone, mut part) = (end(&run, &alone()), end(&run, &placed(&placement)));
        let (before, after) = (alone.displacements("b").unwrap(), part.displacements("p.b").unwrap());
        let size = before.iter().map(|u| u.length()).fold(0.0, f64::max);
        let worst = before.iter().zip(&after).map(|(u, v)| (turn * *u).distance(*v)).fold(0.0, f64::max);
        near(&format!("{}: nodes", run.name), worst, 0.0, size, run.bound(1e-12, 1e-5));
        let (felt, turned) = (alone.tool("t").unwrap(), part.tool("p.t").unwrap());
        assert!(felt.nodes > 0 && felt.nodes == turned.nodes, "{felt:?} {turned:?}");
        let (at, expected) = (turned.place, turn * felt.place + translate);
        near(&format!("{}: place", run.name), at.distance(expected), 0.0, 0.02, 1e-14);
        for (what, before, after) in [("force", felt.force, turned.force), ("torque", felt.torque, turned.torque)] {
            let wrong = (turn * before).distance(after);
            near(&format!("{}: {what}", run.name), wrong, 0.0, before.length(), run.bound(1e-9, 3e-2));
        }
        for name in ["force", "moment"] {
            let (before, after) = (alone.probe(name).unwrap(), part.probe(&format!("p.{name}")).unwrap());
            near(&format!("{}: {name}", run.name), after[0], before[0], before[0], run.bound(1e-11, 1e-4));
        }
    }
}

/// Lengths become so many times as large, and nothing else does: of a body with times as large a mesh the same strain.
#[test]
fn scale_multiplies_lengths() {
    let part = r#"bodies: {"b": (mesh: Box(size: (10, 10, 10), cells: (2, 2, 2)), material: "m", translate: (0, 0, 5))},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 5)),
            Prescribed(on: Box(min: (0, 0, 15), max: (10, 10, 15)), displacement: (0, 0, 2))],
        tools: {"t": (shape: Sphere(radius: 3), at: (5, 5, 18.5), moves: [(displacement: (0, 0, 1))])}"#;
    let run = &configurations()[0];
    let mut simulation = run.start(&format!(
        "(duration: 1, analysis: Static(), parts: {{\"p\": (content: ({part}), scale: 1e-3, translate: (0, 0, 1))}},
            contacts: [Tool(tool: \"p.t\")])"
    ));
    simulation.finish().unwrap();
    let largest = simulation.displacements("p.b").unwrap().iter().map(|u| u.z).fold(0.0, f64::max);
    near("the upper side", largest, 2e-3, 2e-3, 1e-12);
    let place = simulation.tool("p.t").unwrap().place;
    near("the tool", place.distance(DVec3::new(5e-3, 5e-3, 1.0195)), 0.0, 1e-3, 1e-12);
}

/// Masses, moments of inertia, speeds and rates are no lengths.
#[test]
fn scale_leaves_masses_speeds_and_rates() {
    let part = r#"bodies: {"b": (mesh: Box(size: (0.08, 0.08, 0.08), cells: (8, 8, 8)), material: "m")},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.4), damping: 50)},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {"ball": (shape: Sphere(radius: 0.02), at: (0, 0, 1),
                free: (mass: 0.01, inertia: (3e-6, 3e-6, 3e-6), velocity: (0, 0, 0.2), spin: (0, 0, 90))),
            "tip": (shape: Tube(length: 0.1, inner: 0.02, outer: 0.03), at: (0.04, 0.04, 0.081))},
        removal: [(when: InTool(tool: "tip", reach: 0.06, rate: 4e-5, crumb: 0))],
        contacts: [Tool(tool: "ball")]"#;
    let run = &configurations()[0];
    for scale in [1.0, 0.5] {
        let mut simulation =
            run.start(&format!("(duration: 0.05, parts: {{\"p\": (content: ({part}), scale: {scale})}})"));
        simulation.advance_to(0.05).unwrap();
        let free = simulation.tool("p.ball").unwrap().free.unwrap();
        near("velocity", free.velocity.z, 0.2, 0.2, 1e-9);
        near("spin", free.angular_momentum.z, 3e-6 * 90.0_f64.to_radians(), 1e-6, 1e-6);
        let gone = simulation.summary("").unwrap().removed_mass;
        // up to ten steps of .8 ms pass before it is looked what is in reach, and elements are up to a twelfth
        near("what is gone", gone, 1000.0 * 2e-6, 1000.0 * 2e-6, 0.25);
    }
}

#[test]
#[ignore = "long"]
fn what_a_part_brings_changes_while_it_runs_and_snapshots_hold_it() {
    for run in configurations() {
        let scene = placed("translate: (1, 0, 0)");
        let mut simulation = run.start(&scene);
        simulation.advance_to(0.02).unwrap();
        simulation.change(&["materials.\"p.m\".neo_hookean=Young(young: 6e3, poisson: 0.4)".into()]).unwrap();
        simulation.change(&["loads[0].force=(0, 0, 2e-4)".into()]).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        simulation.snapshot().unwrap().write(file.path()).unwrap();
        let mut again = run.start(&scene);
        again.restore(&sinew::Snapshot::read(file.path()).unwrap()).unwrap();
        simulation.finish().unwrap();
        again.finish().unwrap();
        let (ends, same) = (simulation.displacements("p.b").unwrap(), again.displacements("p.b").unwrap());
        assert_eq!(ends, same, "{}", run.name);
        assert_ne!(ends, end(&run, &scene).displacements("p.b").unwrap(), "{}", run.name);
        let refused = again.change(&["parts.p.translate=(0, 0, 0)".into()]).unwrap_err().to_string();
        assert!(refused.contains("this cannot change while the scene runs"), "{refused}");
    }
}
