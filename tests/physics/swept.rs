//! Nodes that go farther in a step against a tool than it is thick: a needle is fast, or they are drawn hard.
//!
//! A node that a tool first meets with a plane of its surface ends on that plane: of a needle that comes down on it,
//! below the needle by its radius, to rounding of its place (1e-12 of the body's size in f64, 1e-6 in f32).

use crate::configurations::{configurations, cpu_and_long_gpu, near, scene_of};
use glam::DVec3;
use sinew::{Options, Simulation};
use std::path::Path;

/// Half of what the needle measures across (m), and a step (s).
const RADIUS: f64 = 2e-4;
const STEP: f64 = 2e-6;

/// A needle that lies along y, .3 mm above a row of nodes of a slab 1 mm thick, and comes down by so many radii a step.
fn needle(radii: f64) -> String {
    let end = 3e-4 - 4.0 * radii * RADIUS;
    format!(
        "(duration: {}, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.001), cells: (10, 10, 1), elements: Hex8),
            material: \"m\", translate: (-0.005, -0.005, -0.001))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.4))}},
        tools: {{\"needle\": (shape: Capsule(length: 0.02, radius: {RADIUS}),
            path: [(t: 0, at: (0, -0.01, 3e-4), rotation: (-90, 0, 0)), (t: {}, at: (0, -0.01, {end}), rotation: (-90, 0, 0))])}},
        contacts: [Tool(tool: \"needle\", thin: true)], integration: (step: {STEP}))",
        4.0 * STEP,
        4.0 * STEP,
    )
}

/// Where the upper nodes are that the needle comes down on (m).
fn below_it(simulation: &mut Simulation) -> Vec<DVec3> {
    let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
    let upper = |x: &DVec3| x.x.abs() < 1e-9 && x.z.abs() < 1e-9;
    rest.iter().zip(u).filter(|(rest, _)| upper(rest)).map(|(rest, u)| *rest + u).collect()
}

#[test]
fn a_swept_needle_takes_nodes_along_that_it_would_have_jumped_over() {
    for run in cpu_and_long_gpu() {
        for radii in [0.4, 1.0, 1.9, 2.4] {
            let mut simulation = run.start(&needle(radii));
            let steps = if radii < 1.0 { 2 } else { 1 };
            for step in 1..=steps {
                simulation.advance(1).unwrap();
                let surface = 3e-4 - f64::from(step) * radii * RADIUS - RADIUS;
                let nodes = below_it(&mut simulation);
                assert_eq!(nodes.len(), 11);
                for node in nodes {
                    let what = format!("{}, {radii} radii a step, step {step}", run.name);
                    near(&what, node.z, surface.min(0.0), 0.01, run.bound(1e-12, 1e-6));
                }
            }
            assert!(simulation.tool("needle").unwrap().force.z > 0.0 || radii < 0.5);
        }
    }
}

#[test]
fn a_needle_may_go_half_an_edge_a_step() {
    let start = |radii: f64| Simulation::new(&scene_of(&needle(radii), Path::new(".")), &Options::default());
    let told = start(3.0).err().expect("it starts").to_string();
    assert!(told.contains("could be through a surface"), "{told}");
    assert!(start(1.9).unwrap().warnings().lines().is_empty());
}

/// How thick a wall is (m).
const WALL: f64 = 1e-4;

/// A block glued to the floor below a wall that rests on it, against which its upper side is drawn, by so many
/// thicknesses of the wall in a step were that not there.
fn drawn(walls: f64) -> String {
    // a layer of 1 mm, of which half goes with the upper nodes
    let pull = walls * WALL / (STEP_DRAWN * STEP_DRAWN) * 1000.0 * 5e-4;
    format!(
        "(duration: {}, bodies: {{\"b\": (mesh: Box(size: (0.004, 0.004, 0.002), cells: (4, 4, 2), elements: Hex8),
            material: \"m\", translate: (-0.002, -0.002, -0.002))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
        constraints: [Fixed(on: Set(\"z0\"))],
        loads: [Traction(on: Surface(normal: (0, 0, 1)), traction: (0, 0, {pull}), curve: Smooth(end: {}))],
        tools: {{\"wall\": (shape: Box(size: (0.02, 0.02, {WALL})), at: (0, 0, {}))}},
        contacts: [Tool(tool: \"wall\", thin: true)], integration: (step: {STEP_DRAWN}))",
        200.0 * STEP_DRAWN,
        50.0 * STEP_DRAWN,
        0.5 * WALL,
    )
}

const STEP_DRAWN: f64 = 2e-5;

/// Drawn by more than half a wall in a step, nodes came out on its other side, and by more than a wall they went
/// through: the wall stands still and yet did work on them.
#[test]
fn nodes_that_are_drawn_hard_stay_on_their_side_of_a_thin_wall() {
    for run in configurations() {
        for walls in [0.2, 0.7, 1.5] {
            let mut simulation = run.start(&drawn(walls));
            simulation.finish().unwrap();
            let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
            let upper = rest.iter().zip(u).filter(|(rest, _)| rest.z > -1e-9).map(|(rest, u)| rest.z + u.z);
            let highest = upper.fold(f64::NEG_INFINITY, f64::max);
            near(&format!("{}, drawn by {walls} walls", run.name), highest, 0.0, 2e-3, run.bound(1e-12, 1e-6));
            let energies = simulation.energies().unwrap();
            let (held, moving) = (simulation.tool("wall").unwrap(), energies.kinetic);
            assert!(
                held.force.z > 0.0 && held.loss.unwrap() > -1e-12 && moving < 1e-12,
                "{}: {held:?}, {moving} J",
                run.name
            );
        }
    }
}
