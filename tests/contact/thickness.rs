//! `thickness` is a gap that stays between bodies, and between a body and itself.

use crate::configurations::{Configuration, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::mesh::OnTriangle;

/// Where nodes of a body are at rest and where they are (m).
fn places(simulation: &mut Simulation, body: &str) -> Vec<(DVec3, DVec3)> {
    let (rest, u) = (simulation.rest_positions(body).unwrap(), simulation.displacements(body).unwrap());
    rest.into_iter().zip(u).map(|(rest, u)| (rest, rest + u)).collect()
}

/// The least and the largest height (m) of nodes above those below them, whose cells match.
fn gaps(below: &[DVec3], above: &[DVec3]) -> [f64; 2] {
    let gap = |foot: &DVec3| {
        let aside = |place: &DVec3| place.truncate().distance(foot.truncate());
        foot.z - below.iter().min_by(|a, b| aside(a).total_cmp(&aside(b))).unwrap().z
    };
    let all = above.iter().map(gap);
    [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
}

/// A block falls on another that stands on the ground, with and without a gap that is to stay: at rest the gap is there
/// at each node. Two bodies, and two copies of one that meets itself.
#[test]
fn a_block_rests_above_another_by_the_thickness() {
    for run in cpu_and_long_gpu() {
        for (side, young, thickness, points) in [
            (0.02, 3e4, 5e-4, "Nodes"),
            (0.02, 3e4, 5e-4, "Faces"),
            (0.008, 1e4, 2e-4, "Nodes"),
            (0.02, 3e4, 0.0, "Nodes"),
        ] {
            let mesh =
                format!("mesh: Box(size: ({side}, {side}, {side}), cells: (2, 2, 2), elements: Hex8), material: \"m\"");
            let law = format!("thickness: {thickness:?}, friction: 0.3, points: {points}, sweeps: 4");
            // farther away at rest than what a body leaves out of itself: 1.5 times the thickness, .015 of an edge
            let at = side + 2.0 * thickness + 2e-4;
            for (bodies, [low, high], contact) in [
                (
                    format!("\"low\": ({mesh}), \"high\": ({mesh}, translate: (0, 0, {at}))"),
                    ["low", "high"],
                    format!("Between(bodies: (\"low\", \"high\"), {law})"),
                ),
                (
                    format!("\"both\": ({mesh}, copies: 2, apart: (0, 0, {at}))"),
                    ["both", "both"],
                    format!("Itself({law})"),
                ),
            ] {
                let mut simulation = run.start(&format!(
                    "(duration: 0.6, bodies: {{{bodies}}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young:?}, poisson: 0.3), damping: 40)}},
                    constraints: [Fixed(body: \"{low}\", on: Plane(normal: (0, 0, 1), at: 0))],
                    loads: [Gravity(acceleration: (0, 0, -9.81))], contacts: [{contact}])"
                ));
                simulation.advance_to(0.6).unwrap();
                let what = format!("{}, {side} m, {contact}", run.name);
                let mut of = |body: &str, height: f64| -> Vec<DVec3> {
                    let all = places(&mut simulation, body).into_iter();
                    all.filter(|(rest, _)| (rest.z - height).abs() < 1e-6).map(|(_, now)| now).collect()
                };
                let (heads, feet) = (of(low, side), of(high, at));
                assert_eq!((heads.len(), feet.len()), (9, 9), "{what}");
                let [least, most] = gaps(&heads, &feet);
                // what sweeps leave, and with points of faces the nodes are free to be a little off
                let bound = 2e-3 * thickness + run.bound(1e-7, 2e-7);
                near(&format!("{what}: least"), least, thickness, 1.0, bound);
                near(&format!("{what}: most"), most, thickness, 1.0, bound);
                let weight = 1000.0 * side.powi(3) * 9.81;
                if low != high {
                    near(&what, simulation.contact(high).unwrap().force.z, weight, weight, 1e-3);
                }
            }
        }
    }
}

/// The least distance (m) of nodes of the inner walls of a ring that is pressed flat from triangles of the wall across,
/// at several times while they touch. Without the rule of `which` the walls may slide off each other.
fn of_a_flat_ring(run: &Configuration, elements: &str, cells: u32, thickness: f64, (young, more): (f64, &str)) -> f64 {
    let mut simulation = run.start(&format!(
        "(duration: 0.3, bodies: {{\"t\": (mesh: Tube(inner: 0.008, outer: 0.01, height: 0.004, cells: (1, {cells}, 2), elements: {elements}), material: \"m\", rotate: (0, 90, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young:?}, poisson: 0.3), damping: 50)}}, {more}
        tools: {{\"top\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.0101), moves: [(displacement: (0, 0, -0.0079), curve: Smooth(end: 0.25))]),
            \"bottom\": (shape: Plane(), at: (0, 0, -0.0101), moves: [(displacement: (0, 0, 0.0079), curve: Smooth(end: 0.25))])}},
        contacts: [Tool(tool: \"top\"), Tool(tool: \"bottom\"), Itself(thickness: {thickness:?}, sweeps: 16)])"
    ));
    let triangles = simulation.surface_triangles("t").unwrap();
    let mut least = f64::INFINITY;
    for step in 0..=10 {
        simulation.advance_to(0.2 + 0.01 * f64::from(step)).unwrap();
        let all = places(&mut simulation, "t");
        // not where it folds: there a wall goes on beside itself
        let wall = |sign: f64| {
            let all = &all;
            move |&node: &u32| {
                let rest = all[node as usize].0;
                (rest.y.hypot(rest.z) - 0.008).abs() < 1e-6 && sign * rest.z > 4e-3
            }
        };
        for sign in [-1.0, 1.0] {
            let nodes = 0..all.len() as u32;
            let across: Vec<_> = triangles.iter().filter(|corners| corners.iter().all(wall(-sign))).collect();
            assert!(across.len() >= 16, "{} triangles", across.len());
            for node in nodes.filter(wall(sign)) {
                let at = all[node as usize].1;
                for corners in &across {
                    let nearest = OnTriangle::nearest(at, corners.map(|corner| all[corner as usize].1));
                    least = least.min(at.distance(nearest.at));
                }
            }
        }
    }
    println!("{}, {elements}, {cells} cells, {young} Pa: {:.4} of {thickness} m", run.name, least / thickness);
    least
}

/// The walls of a flat ring stay apart by the thickness, on coarse meshes and fine ones: up to .6 of an edge. Those of
/// tetrahedra slide off each other meanwhile, by a third of how wide they are, so that they lie askew and nodes have
/// several triangles in front of them: the nearest is in their way, and not one that they face more. Those of hexahedra
/// are kept above each other; else they are pressed out sidewards.
#[test]
fn the_walls_of_a_flat_ring_stay_apart_by_the_thickness() {
    let held = "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0.002), axes: [X])],";
    for run in cpu_and_long_gpu() {
        let touching = of_a_flat_ring(&run, "Tet4", 32, 1e-6, (3e3, ""));
        assert!(touching < 4.5e-4, "{}: {touching} m without a thickness", run.name);
        let all = [
            ("Tet4", 16, 1e-3, 3e4, ""),
            ("Hex8", 24, 1.2e-3, 3e3, held),
            ("Tet4", 32, 7e-4, 3e3, ""),
            ("Tet4", 24, 1e-3, 3e3, ""),
            ("Tet4", 24, 1.2e-3, 3e3, held),
            ("Hex8", 40, 6e-4, 3e4, held),
        ];
        // in software a GPU takes long enough for two
        let some = if run.name.starts_with("GPU") { &all[..2] } else { &all[..] };
        for &(elements, cells, thickness, young, more) in some {
            let apart = of_a_flat_ring(&run, elements, cells, thickness, (young, more));
            assert!(apart > 0.98 * thickness, "{}, {elements}, {cells} cells: {apart} m", run.name);
        }
    }
}
