//! Needles that go farther in a step than they are thick.
//!
//! A node that a tool first meets with a plane of its surface ends on that plane: of a needle that comes down on it,
//! below the needle by its radius, to rounding of its place (1e-12 of the body's size in f64, 1e-6 in f32).

use crate::configurations::{cpu_and_long_gpu, near, scene_of};
use glam::DVec3;
use sinew::{Options, Simulation};

/// Half of what the needle measures across (m), and a step (s).
const RADIUS: f64 = 2e-4;
const STEP: f64 = 2e-6;

/// A needle that lies along y, .3 mm above a row of nodes of a slab 1 mm thick, and comes down by so many radii a step.
fn needle(radii: f64, contact: &str) -> String {
    let end = 3e-4 - 4.0 * radii * RADIUS;
    format!(
        "(duration: {}, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.001), cells: (10, 10, 1), elements: Hex8),
            material: \"m\", translate: (-0.005, -0.005, -0.001))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.4))}},
        tools: {{\"needle\": (shape: Capsule(length: 0.02, radius: {RADIUS}),
            path: [(t: 0, at: (0, -0.01, 3e-4), rotation: (-90, 0, 0)), (t: {}, at: (0, -0.01, {end}), rotation: (-90, 0, 0))])}},
        contacts: [Tool(tool: \"needle\", thin: true{contact})], integration: (step: {STEP}))",
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
            let mut simulation = run.start(&needle(radii, ", swept: true"));
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
fn tools_that_may_go_through_nodes_are_refused_or_warned_of() {
    let start = |scene: &str| Simulation::new(&scene_of(scene, std::path::Path::new(".")), &Options::default());
    let refused = |scene: &str, word: &str| {
        let told = start(scene).err().unwrap_or_else(|| panic!("it starts: {scene}")).to_string();
        assert!(told.contains(word), "{told}");
    };
    refused(&needle(1.9, ""), "nodes could go through it unseen");
    refused(&needle(3.0, ", swept: true"), "could be through a surface");
    let warns = |radii: f64, contact: &str| {
        let simulation = start(&needle(radii, contact)).unwrap();
        simulation.warnings().lines().iter().any(|line| line.contains("nodes could go through it"))
    };
    assert!(warns(0.6, "") && warns(1.0, ""));
    assert!(!warns(0.4, "") && !warns(1.9, ", swept: true"));
    let scene = needle(0.4, ", swept: true, law: Penalty(share: 0.1)");
    refused(&scene, "`swept` looks at its way");
}
