//! `thickness` is a gap that stays between bodies, and between a body and itself.

use crate::configurations::{Configuration, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;

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

/// The least distance (m) between the inner walls of a ring that is pressed flat, in its middle.
fn of_a_flat_ring(run: &Configuration, thickness: f64, cells: u32) -> f64 {
    let mut simulation = run.start(&format!(
        "(duration: 0.3, bodies: {{\"t\": (mesh: Tube(inner: 0.008, outer: 0.01, height: 0.004, cells: (1, {cells}, 2)), material: \"m\", rotate: (0, 90, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 50)}},
        tools: {{\"top\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.0101), moves: [(displacement: (0, 0, -0.0079), curve: Smooth(end: 0.25))]),
            \"bottom\": (shape: Plane(), at: (0, 0, -0.0101), moves: [(displacement: (0, 0, 0.0079), curve: Smooth(end: 0.25))])}},
        contacts: [Tool(tool: \"top\"), Tool(tool: \"bottom\"), Itself(thickness: {thickness:?}, sweeps: 4)])"
    ));
    simulation.advance_to(0.3).unwrap();
    let all = places(&mut simulation, "t");
    let wall = |sign: f64| -> Vec<DVec3> {
        let of = |(rest, now): &(DVec3, DVec3)| {
            let inner = (rest.y.hypot(rest.z) - 0.008).abs() < 1e-6 && (rest.x - 0.002).abs() < 1e-6;
            inner && sign * rest.z > 1e-3 && now.y.abs() < 6e-3
        };
        let mut nodes: Vec<DVec3> = all.iter().filter(|both| of(both)).map(|(_, now)| *now).collect();
        nodes.sort_by(|a, b| a.y.total_cmp(&b.y));
        nodes
    };
    let (low, high) = (wall(-1.0), wall(1.0));
    assert!(low.len() > 4 && high.len() > 4, "{}: {} and {} nodes", run.name, low.len(), high.len());
    // of nodes of each wall from the lines between those of the other
    let mut least = f64::INFINITY;
    for (wall, other) in [(&low, &high), (&high, &low)] {
        for node in wall {
            let over = other.windows(2).find(|pair| pair[0].y <= node.y && pair[1].y >= node.y);
            let Some([a, b]) = over else { continue };
            let height = a.z + (b.z - a.z) * (node.y - a.y) / (b.y - a.y) - node.z;
            least = least.min(height.abs() * (b.y - a.y) / (b.y - a.y).hypot(b.z - a.z));
        }
    }
    println!("{}, thickness {thickness} m, {cells} cells: {least:.4e} m", run.name);
    least
}

/// The walls of a flat ring stay apart by the thickness, where there is room for .4 mm.
#[test]
fn the_walls_of_a_flat_ring_stay_apart_by_the_thickness() {
    for run in cpu_and_long_gpu() {
        let touching = of_a_flat_ring(&run, 0.0, 32);
        assert!(touching < 4.5e-4, "{}: {touching} m without a thickness", run.name);
        let apart = of_a_flat_ring(&run, 7e-4, 32);
        assert!(apart > 0.98 * 7e-4, "{}: {apart} m", run.name);
    }
}
