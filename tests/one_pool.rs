//! Threads are those that a run is told to have: from reading a scene to its files nothing is shared among those that
//! rayon makes for a whole process. One test, for there is one such pool.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::components::Precision;
use sinew::{BackendChoice, Folder, Options, SceneFile, Simulation};

/// A tool from a file, mass that is added for a larger step, fields that are written.
const SCENE: &str = r#"(duration: 0.02, materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 60)},
    bodies: {"b": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (10, 10, 10), elements: Tet4), material: "m")},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
    tools: {"pick": (mesh: (path: "octahedron.obj", scale: 0.001), at: (0.01, 0.01, 0.027),
        moves: [(displacement: (0, 0, -3e-3), curve: Smooth(end: 0.02))])},
    contacts: [Tool(tool: "pick")],
    integration: (step: 2.5e-4, when_unstable: ScaleMass(most: 0.3)),
    output: (fields_every: 0.01, fields: [Displacement, VonMises]))"#;

#[test]
fn nothing_is_shared_among_other_threads_than_those_of_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let octahedron = "v 6 0 0\nv -6 0 0\nv 0 6 0\nv 0 -6 0\nv 0 0 6\nv 0 0 -6\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n\
                      f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    std::fs::write(folder.path().join("octahedron.obj"), octahedron).unwrap();
    let scene = SceneFile::from_text("pick.ron", SCENE, folder.path(), &[]);
    let scene = scene.unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    for (precision, threads) in [(Precision::F32, 1), (Precision::F64, 2)] {
        let options = Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() };
        let mut simulation = Simulation::new(&scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"));
        let mut out = Folder::create(&folder.path().join(format!("out_{threads}"))).unwrap();
        simulation.write_into(&mut out).unwrap();
        simulation.finish().unwrap();
        assert!(simulation.tool("pick").unwrap().force.z > 1e-4);
        assert!(simulation.step_history().unwrap().added_mass > 0.0);
    }
    let first = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    assert!(first.is_ok(), "the pool of the whole process has been made before: {first:?}");
}
