//! Tools that are meshes, thin in one part and thick in another.

use crate::configurations::{configurations, scene_of};
use sinew::Simulation;
use sinew::systems::Registry;

/// A box as OBJ has it, about a place, behind so many points.
fn block(center: [f64; 3], size: [f64; 3], first: usize) -> String {
    let corner = |number: usize| {
        let at = |axis: usize| center[axis] + size[axis] * if number >> axis & 1 == 1 { 0.5 } else { -0.5 };
        format!("v {} {} {}\n", at(0), at(1), at(2))
    };
    let sides = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    let face = |side: [usize; 4]| {
        let [a, b, c, d] = side.map(|corner| first + corner);
        format!("f {a} {b} {c}\nf {a} {c} {d}\n")
    };
    (0..8).map(corner).chain(sides.into_iter().map(face)).collect()
}

/// A block of soft tissue that is thrown at the tool of a file, from a height (m).
fn thrown(file: &str, height: &str) -> String {
    format!(
        "(duration: 0.03, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (7, 7, 7), elements: Hex8),
            translate: (-0.005, -0.005, {height}), velocity: (0, 0, -0.3), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 500, poisson: 0.3), damping: 5)}},
        tools: {{\"t\": (mesh: (path: \"{file}\", scale: 0.001, spacing: 1e-4))}}, contacts: [Tool(tool: \"t\")],
        probes: {{\"b\": (what: Displacement, on: All)}})"
    )
}

/// A blade of .2 mm beside a handle of 6 mm stops what goes more than its thickness in a step, and it is told that it
/// may slip between nodes: it was taken for as thick as its handle, and fell through, 8 mm deep, without a word.
#[test]
fn a_thin_blade_with_a_thick_handle_is_thin() {
    let folder = tempfile::tempdir().unwrap();
    let handle = |first: usize| block([9.5, 0.0, 0.0], [3.0, 6.0, 6.0], first);
    let blade = block([0.0; 3], [12.0, 12.0, 0.2], 0);
    std::fs::write(folder.path().join("blade.obj"), blade + &handle(8)).unwrap();
    std::fs::write(folder.path().join("block.obj"), block([9.5, 0.0, 0.0], [6.0; 3], 0)).unwrap();
    let told = |file: &str| {
        let scene = scene_of(&thrown(file, "0.001"), folder.path());
        Simulation::check(&scene, &Registry::default()).render(false)
    };
    let slips = "the tool `t` may slip between nodes";
    assert!(told("blade.obj").contains(slips) && !told("block.obj").contains(slips), "{}", told("block.obj"));
    for run in configurations() {
        for height in ["0.001", "0.0012", "0.0013"] {
            let mut simulation = run.start_in(&thrown("blade.obj", height), folder.path());
            simulation.finish().unwrap();
            let deep = simulation.probe("b").unwrap()[2];
            assert!(deep > -2e-3, "{} from {height} m: {deep} m", run.name);
        }
    }
}
