//! A sinew without the feature `files`: what is left out says so, and the rest runs.
//! `cargo test -p sinew --no-default-features --test without_files`
#![cfg(not(feature = "files"))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::glam::DVec3;
use sinew::mesh::{CellKind, Cells, Mesh};
use sinew::systems::Registry;
use sinew::{Folder, Options, SceneFile, Simulation, Snapshot};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

fn scene(mesh: &str) -> SceneFile {
    let text = format!(
        r#"(duration: 0.01,
        bodies: {{"a": (mesh: {mesh}, material: "gel")}},
        materials: {{"gel": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: (0, 0, -9.81))],
        integration: (step: 0.0005),
        output: (fields_every: 0.001, energies_every: 0.001, snapshots_every: 0.005),
        probes: {{"top": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0.1), every: 0.001)}})"#
    );
    let files = BTreeMap::from([("a.msh".to_string(), b"$MeshFormat".to_vec())]);
    SceneFile::from_memory("a", &text, files, &[]).unwrap_or_else(|wrong| panic!("{}", wrong.render(false)))
}

#[test]
fn a_scene_runs_and_goes_back_to_a_snapshot_in_memory() {
    let corner = Mesh {
        points: vec![DVec3::ZERO, 0.1 * DVec3::X, 0.1 * DVec3::Y, 0.1 * DVec3::Z],
        cells: Cells::of(CellKind::Tet4, &[[0, 1, 2, 3]]).unwrap(),
        ..Mesh::default()
    };
    let mut given = scene(r#"File(path: "given")"#);
    given.meshes.insert("given".into(), Arc::new(corner));
    for scene in [scene("Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2))"), given] {
        let mut simulation = Simulation::new(&scene, &Options::default()).unwrap();
        simulation.advance(3).unwrap();
        let bytes = simulation.snapshot().unwrap().to_bytes().unwrap();
        simulation.finish().unwrap();
        let end = simulation.displacements("a").unwrap();
        assert!(simulation.probe("top").unwrap()[2] < 0.0);
        simulation.restore(&Snapshot::from_bytes(&bytes).unwrap()).unwrap();
        assert_eq!(simulation.step_count(), 3);
        simulation.finish().unwrap();
        assert_eq!(simulation.displacements("a").unwrap(), end);
    }
}

#[test]
fn a_mesh_file_is_refused_at_its_place_with_the_feature_that_is_missing() {
    let told = Simulation::check(&scene(r#"File(path: "a.msh")"#), &Registry::default()).to_string();
    assert!(told.contains("a.msh: this sinew was built without reading mesh files (feature `files`)"), "{told}");
    assert!(told.contains("a:2:"), "{told}");
}

#[test]
fn a_folder_is_refused_with_the_feature_that_is_missing() {
    let path = std::env::temp_dir().join("sinew_without_files");
    let told = Folder::create(Path::new(&path)).err().unwrap().to_string();
    assert!(told.ends_with("this sinew was built without writing result files (feature `files`)"), "{told}");
    assert!(!path.exists());
}
