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

/// It was found after one iteration, with the distance 0: the scan itself.
#[test]
fn a_scene_in_which_no_load_acts_at_the_start_is_refused() {
    let place = Workspace::new();
    let unload = |set: &[&str]| place.sinew(&[&["unload", "block.ron", "--tolerance", "1e-2"], set].concat());
    let why = "no load acts at t = 0 s: the unloaded shape is the mesh as it is";
    unload(&["--set", "loads[0].curve=Smooth(end: 0.05)"]).wants(2, &[why, "Smooth(end: 0.05)", "leave `curve` out"]);
    unload(&["--set", "loads=[]"]).wants(2, &[why]);
    // one that begins later beside one that acts is what is to happen
    let push = "loads=[Pressure(on: Set(\"z1\"), pressure: 10, curve: Smooth(end: 0.05)), \
                Gravity(acceleration: (0, 0, -9.81))]";
    assert!(!place.path("out").exists());
    unload(&["--set", push]).wants(0, &[]);
}

/// What the search for rest leaves out, too: the scene that was written was refused when it was run.
#[test]
fn what_would_be_wrong_with_the_scene_that_is_written_is_told_before_anything_is_sought() {
    let removal = |on: &str| SCENE.replace("output:", &format!("removal: [(on: {on}, when: At(0.1))], output:"));
    let place = Workspace::with_scene(&removal("Sphere(center: (0.05, 0.05, 0.2), radius: 0.01)"));
    let ended = place.sinew(&["unload", "block.ron", "--tolerance", "1e-2"]);
    ended.wants(2, &["no element is here", "block.ron"]);
    assert!(ended.said.is_empty() && !place.path("out").exists(), "{}", ended.said);
    fs::write(place.path("block.ron"), removal("Sphere(center: (0.05, 0.05, 0.05), radius: 0.02)")).unwrap();
    place.done(&["unload", "block.ron", "--tolerance", "1e-2"]);
    place.done(&["run", "out/block-unloaded/scene.ron", "-o", "out/again", "--set", "duration=0.01"]);
}

/// Files of tools and skins go with the scene, and so do those that these name.
#[test]
fn unloaded_scene_has_all_files_that_it_names() {
    let skin = r#"material: "tissue", skin: (file: "pyramid.gltf", scale: 0.05)) }"#;
    let tool = r#"tools: { "hook": (mesh: (path: "pyramid.gltf", scale: 0.05, spacing: 5e-3), at: (0.02, 0.02, 0.3)) },
    contacts: [Tool(tool: "hook")], probes:"#;
    let text = SCENE.replace(r#"material: "tissue") }"#, skin).replace("probes:", tool);
    let place = Workspace::with_scene(&text.replace("young: 3000", "young: 3e4"));
    place.write_pyramid();
    let told = place.done(&["unload", "block.ron", "--tolerance", "1e-2"]);
    assert!(told.contains("unloaded.msh, pyramid.bin, pyramid.gltf, scene.ron"), "{told}");
    let remove = |folder: &str| {
        for name in ["pyramid.gltf", "pyramid.bin"] {
            fs::remove_file(place.path(folder).join(name)).unwrap();
        }
    };
    remove(".");
    let scene = "out/block-unloaded/scene.ron";
    place.done(&["run", scene, "-o", "out/again", "--set", "duration=0.01", "--backend", "cpu"]);
    // drawn without the files, too
    remove("out/block-unloaded");
    let drawn = place.sinew(&["render", "out/again", "--no-animation"]);
    drawn.wants(0, &[]);
    assert!(!drawn.complained.contains("is not drawn"), "{}", drawn.complained);
    assert!(place.path("out/again/skin_block_000000.vtu").exists() && place.path("out/again/tool_hook.ply").exists());
}

#[test]
fn a_part_that_is_placed_is_refused_before_anything_is_sought() {
    let whole = |place: &str| {
        let parts = format!(r#"parts: {{"p": (scene: "part.ron"{place})}}"#);
        format!("(duration: 0.1, {parts}, loads: [Gravity(acceleration: (0, 0, -9.81))])")
    };
    let part = r#"(
        bodies: {"block": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: "tissue")},
        materials: {"tissue": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 5)},
        constraints: [Fixed(on: Set("z0"))])"#;
    let place = Workspace::with_scene(&whole(", translate: (0.1, 0, 0)"));
    fs::write(place.path("part.ron"), part).unwrap();
    let ended = place.sinew(&["unload", "block.ron", "--tolerance", "1e-2"]);
    let why = "block.ron cannot begin at an unloaded shape, so none is sought: the part `p` is placed, and a \
               `rest_shape` is not";
    ended.wants(2, &[why]);
    assert!(ended.said.is_empty() && !place.path("out").exists(), "{}", ended.said);
    fs::write(place.path("block.ron"), whole("")).unwrap();
    place.done(&["unload", "block.ron", "--tolerance", "1e-2"]);
    assert!(place.read("out/block-unloaded/scene.ron").contains("rest_shape: \"unloaded.msh\""));
}
