//! Scenes whose files are in memory: nothing is read from a disk.

use sinew::glam::DVec3;
use sinew::mesh::{CellKind, Cells, Ids, Mesh};
use sinew::scene::SceneFile;
use sinew::systems::Registry;
use sinew::{BackendChoice, Options, Simulation};
use std::collections::BTreeMap;
use std::sync::Arc;

const SCENE: &str = r#"(duration: 0.1,
bodies: {"a": (mesh: File(path: "meshes/a.msh"), material: "tissue")},
materials: {"tissue": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))},
constraints: [Fixed(on: Nodes([1, 2, 3]))],
systems: {"push": (file: "push.wgsl", curve: Smooth(end: 0.1))})"#;
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 0.1\n$EndNodes\n\
                    $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
const PUSH: &str = "fn push(node: Node) -> vec3f { return vec3f(0, 0, 0.1 * node.curve * node.mass); }";

fn files() -> BTreeMap<String, Vec<u8>> {
    [("meshes/a.msh", MESH), ("push.wgsl", PUSH)]
        .map(|(name, text)| (name.to_string(), text.as_bytes().to_vec()))
        .into()
}

#[test]
fn a_scene_in_memory_runs_as_the_same_on_a_disk() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("meshes")).unwrap();
    files().iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
    let scenes = [
        SceneFile::from_memory("memory", SCENE, files(), &[]).unwrap(),
        SceneFile::from_text("disk", SCENE, folder.path(), &[]).unwrap(),
    ];
    let [memory, disk] = scenes.map(|scene| {
        let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
        let mut simulation = Simulation::new(&scene, &options).unwrap();
        simulation.finish().unwrap();
        simulation.displacements("a").unwrap()
    });
    assert!(memory[3].z > 0.0, "{memory:?}");
    assert_eq!(memory, disk);
}

#[test]
fn what_is_not_in_memory_is_told_and_never_looked_for_on_a_disk() {
    let told = |scene: &str, files: BTreeMap<String, Vec<u8>>| {
        let scene = SceneFile::from_memory("memory", scene, files, &[]).unwrap();
        Simulation::check(&scene, &Registry::default()).to_string()
    };
    let without = |name: &str| files().into_iter().filter(|(other, _)| other != name).collect::<BTreeMap<_, _>>();
    assert_eq!(told(SCENE, files()), "");
    let no_mesh = told(SCENE, without("meshes/a.msh"));
    assert!(no_mesh.contains("there is no file `meshes/a.msh`"), "{no_mesh}");
    assert!(no_mesh.contains("no mesh files (.msh, .vtk, .vtu) among the files in memory"), "{no_mesh}");
    let mistyped = told(&SCENE.replace("meshes/a.msh", "meshes/b.msh"), files());
    assert!(mistyped.contains("there are: meshes/a.msh"), "{mistyped}");
    let no_system = told(SCENE, without("push.wgsl"));
    assert!(no_system.contains("there is no file `push.wgsl`"), "{no_system}");
    // a file that is there, on the disk
    let real = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/wind.wgsl");
    let outside = told(&SCENE.replace("push.wgsl", real), files());
    assert!(outside.contains("there is no file `"), "{outside}");
    let broken = files().into_keys().map(|name| (name, b"no mesh".to_vec())).collect();
    let broken = told(SCENE, broken);
    assert!(broken.contains("meshes/a.msh: "), "{broken}");
}

/// The scene with a mesh that a program has made in place of the file.
fn made(mesh: Mesh) -> SceneFile {
    let mut scene = SceneFile::from_memory("memory", SCENE, files(), &[]).unwrap();
    scene.meshes.insert("meshes/a.msh".into(), Arc::new(mesh));
    scene
}

fn corner(nodes: [u32; 4]) -> Mesh {
    Mesh {
        points: vec![DVec3::ZERO, DVec3::X, DVec3::Y, 0.1 * DVec3::Z],
        point_ids: Ids::Named(vec![1, 2, 3, 4]),
        cells: Cells::of(CellKind::Tet4, &[nodes]).unwrap(),
        ..Mesh::default()
    }
}

#[test]
fn a_mesh_that_a_program_has_made_runs_as_the_same_in_a_file() {
    let file = SceneFile::from_memory("memory", SCENE, files(), &[]).unwrap();
    let [file, made] = [file, made(corner([0, 1, 2, 3]))].map(|scene| {
        let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
        let mut simulation = Simulation::new(&scene, &options).unwrap();
        simulation.finish().unwrap();
        simulation.displacements("a").unwrap()
    });
    assert!(made[3].z > 0.0, "{made:?}");
    assert_eq!(made, file);
}

#[test]
fn a_made_mesh_that_cannot_be_simulated_is_told() {
    let told = |mesh: Mesh| Simulation::check(&made(mesh), &Registry::default()).to_string();
    let beyond = told(corner([0, 1, 2, 7]));
    assert!(beyond.contains("meshes/a.msh: the mesh cannot be simulated"), "{beyond}");
    let inside_out = told(corner([0, 2, 1, 3]));
    assert!(inside_out.contains("list their nodes in the other order"), "{inside_out}");
}
