//! `sinew unload`.

use crate::sinew::{SCENE, Workspace};
use std::fs;

/// The rows of a table of nodes: number, place at rest, displacement.
fn nodes(path: &std::path::Path) -> Vec<[f64; 7]> {
    let text = fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').take(7).map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn unloaded_scene_runs_from_where_the_mesh_is_and_stays_there() {
    // what swings comes to rest: only what was not at equilibrium would move
    let place =
        Workspace::with_scene(&SCENE.replace("Fixed(on: Set(\"z0\"))", "Fixed(on: Plane(normal: (0, 0, 1), at: 0))"));
    let told = place.done(&["unload", "block.ron", "--tolerance", "1e-5"]);
    assert!(told.contains("unloaded    after ") && told.contains("unloaded.msh, scene.ron"), "{told}");
    let folder = place.folder.path().join("out/block-unloaded");
    let scene = fs::read_to_string(folder.join("scene.ron")).unwrap();
    assert!(scene.contains("rest_shape: \"unloaded.msh\"") && scene.contains("start: Equilibrium()"), "{scene}");
    let told = place.done(&["run", "out/block-unloaded/scene.ron", "-o", "out/again", "--precision", "f64"]);
    assert!(told.contains("preload     at rest before the first step"), "{told}");
    place.done(&["run", "block.ron", "-o", "out/sagging", "--precision", "f64"]);
    let (again, sagging) = (
        nodes(&place.folder.path().join("out/again/nodes.csv")),
        nodes(&place.folder.path().join("out/sagging/nodes.csv")),
    );
    assert_eq!(again.len(), sagging.len());
    let mut highest = 0.0_f64;
    for (unloaded, scan) in again.iter().zip(&sagging) {
        let off: f64 = (1..4).map(|i| (unloaded[i] + unloaded[i + 3] - scan[i]).powi(2)).sum::<f64>().sqrt();
        assert!(off <= 1e-5 * 0.18, "node {}: {off:e} m from the mesh", unloaded[0]);
        highest = highest.max(unloaded[3]);
    }
    assert!(highest > 0.101, "the block is not higher at rest: {highest}");
    // its mesh is one, with the sets of the scene's
    let told = place.done(&["mesh", "out/block-unloaded/unloaded.msh", "--no-picture"]);
    assert!(told.contains("z0") && told.contains("z1"), "{told}");
}

#[test]
fn what_is_not_found_is_told_with_status_1_and_nothing_is_written() {
    let place = Workspace::new();
    let ended = place.sinew(&["unload", "block.ron", "--tolerance", "1e-7", "--most", "2"]);
    assert_eq!(ended.status, Some(1), "{}", ended.complained);
    assert!(ended.complained.contains("no unloaded shape was found: after 2 iterations"), "{}", ended.complained);
    assert!(!place.folder.path().join("out").exists());
    assert_eq!(place.sinew(&["unload", "block.ron", "--tolerance", "2"]).status, Some(2));
}
