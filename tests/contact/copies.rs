//! Copies of a body under a tool, and what it takes of them: each does what the body does by itself.

use crate::configurations::{Configuration, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;

/// A block of 2 cm × 2 cm × 1 cm, glued below, so many copies of it 3 cm from each other along x, and what is done to
/// them by a tool.
fn blocks(run: &Configuration, elements: &str, copies: &str, done: &str) -> Simulation {
    run.start(&format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (6, 6, 3), elements: {elements}), material: \"m\", {copies})}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], integration: (step: 1e-4), {done})"
    ))
}

const PRESSED: &str = "tools: {\"tip\": (shape: Sphere(radius: 6e-3), at: (0.041, 0.009, 0.0161), moves: [(displacement: (1e-3, 0, -2e-3), curve: Smooth(end: 0.08))])},
    contacts: [Tool(tool: \"tip\", friction: 0.3)]";
const TAKEN: &str = "tools: {\"tip\": (shape: Tube(length: 0.03, inner: 4e-3, outer: 6e-3), rounding: 5e-4,
        path: [(t: 0, at: (0.041, 0.009, 0.0105)), (t: 0.1, at: (0.041, 0.009, 8e-3))])},
    contacts: [Tool(tool: \"tip\", friction: 0.1)],
    removal: [(when: InTool(tool: \"tip\", reach: 6e-3, threshold: EnergyDensityAbove(8)))], probes: {\"hole\": (what: RemovedVolume)}";
/// All copies at once.
const FLAT: &str = "tools: {\"tip\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.0101), moves: [(displacement: (1e-3, 0, -1e-3), curve: Smooth(end: 0.08))])},
    contacts: [Tool(tool: \"tip\", friction: 0.3)]";

/// The same .3 mm inside of all copies.
const INSIDE: &str =
    "tools: {\"tip\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 9.7e-3))}, contacts: [Tool(tool: \"tip\")]";

/// What begins inside a tool comes out while a wave goes through the body: of copies through one of them, however many
/// there are and however far apart.
#[test]
fn copies_come_out_of_a_tool_as_fast_as_the_body_by_itself() {
    for run in cpu_and_long_gpu() {
        let mut alone = blocks(&run, "Hex8", "", INSIDE);
        let mut copies = blocks(&run, "Hex8", "copies: 3, apart: (0.1, 0, 0)", INSIDE);
        for time in [5e-4, 1e-3, 2e-3, 5e-3] {
            for simulation in [&mut alone, &mut copies] {
                simulation.advance_to(time).unwrap();
            }
            let (one, all) = (alone.displacements("b").unwrap(), copies.displacements("b").unwrap());
            let largest = one.iter().map(|u| u.length()).fold(0.0, f64::max);
            assert!(largest > 5e-5, "{}, {time} s: {largest} m", run.name);
            for (copy, own) in all.chunks(one.len()).enumerate() {
                let off = own.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                near(&format!("{}, {time} s, copy {copy}", run.name), off, 0.0, largest, run.bound(1e-9, 1e-3));
            }
        }
    }
}

/// On a GPU places are counted in f32 from the middle of the body: of copies that stand so far from each other that
/// gaps lose their digits it is told. The CPU counts them in f64.
#[test]
fn copies_that_stand_too_far_from_each_other_for_a_gpu_are_told_of() {
    for run in cpu_and_long_gpu() {
        for (apart, is_far) in [("0.03", false), ("20", true)] {
            let mut copies = blocks(&run, "Hex8", &format!("copies: 3, apart: ({apart}, 0, 0)"), FLAT);
            let warnings = copies.summary("finished").unwrap().guards.warnings;
            let told = warnings.iter().filter(|notice| notice.criterion == "rounding" && notice.part == "b").count();
            let expected = is_far && copies.is_on_gpu();
            assert_eq!(told, usize::from(expected), "{}, {apart} m: {warnings:?}", run.name);
        }
    }
}

#[test]
#[ignore = "long"]
fn copies_under_a_tool_do_what_the_body_does_by_itself() {
    for run in cpu_and_long_gpu() {
        for (name, done, touched) in [("pressed", PRESSED, 1..2), ("taken", TAKEN, 1..2), ("flat", FLAT, 0..3)] {
            for elements in ["Hex8", "Tet4"] {
                // the one that the tool meets, by itself
                let place = 0.03;
                let mut alone = blocks(&run, elements, &format!("translate: ({place}, 0, 0)"), done);
                let mut copies = blocks(&run, elements, "copies: 3, apart: (0.03, 0, 0)", done);
                for simulation in [&mut alone, &mut copies] {
                    simulation.advance_to(0.1).unwrap();
                }
                let (one, all) = (alone.displacements("b").unwrap(), copies.displacements("b").unwrap());
                let (nodes, what) = (one.len(), format!("{}, {elements}, {name}", run.name));
                let largest = one.iter().map(|u| u.length()).fold(0.0, f64::max);
                assert!(largest > 1e-4, "{what}: {largest} m");
                for copy in 0..3 {
                    let own = &all[copy * nodes..(copy + 1) * nodes];
                    if !touched.contains(&copy) {
                        assert!(own.iter().all(|u| *u == DVec3::ZERO), "{what}: copy {copy} is not touched");
                        continue;
                    }
                    let off = own.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
                    assert!(off <= run.bound(1e-12, 1e-5), "{what}: copy {copy} is {off:e} off");
                }
                let [a, b] = [&mut alone, &mut copies].map(|simulation| simulation.tool("tip").unwrap());
                let times = touched.len();
                assert!(b.nodes == times * a.nodes && a.force.length() > 1e-3, "{what}: {a:?} {b:?}");
                let scale = times as f64 * a.force.length();
                // in f32 places of 4 cm are known to 2e-9 m, which is m/Δt² times that of force: 3e-6 N a node
                near(&what, b.force.distance(times as f64 * a.force), 0.0, scale, run.bound(1e-10, 2e-3));
                if name == "taken" {
                    let [a, b] = [&mut alone, &mut copies].map(|simulation| {
                        (simulation.probe("hole").unwrap()[0], simulation.summary("").unwrap().removed_elements)
                    });
                    assert!(a.1 > 5 && a.1 == b.1, "{what}: {a:?} {b:?}");
                    near(&what, b.0, a.0, a.0, run.bound(1e-12, 1e-5));
                }
            }
        }
    }
}
