//! Scenes as files, with what they name, and files that change.

use crate::*;
use bevy_asset::AssetServer;

const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 0.1 0 0\n3 0 0.1 0\n4 0 0 0.1\n$EndNodes\n\
                    $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
const ONE: &str = r#"(
    duration: 1, // "not.msh"
    bodies: {"one": (mesh: File(path: "meshes/one.msh"), material: "gel")},
    materials: {"gel": (density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4))},
    loads: [Gravity(acceleration: (0, 0, -1))],
)"#;

/// Updates until something is so.
fn until(app: &mut App, mut is_so: impl FnMut(&mut App) -> bool) {
    for _ in 0..2000 {
        app.update();
        if is_so(app) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    panic!("it did not come to be: {:?}", messages::<Refused>(app));
}

fn file_of(app: &App, name: &str) -> Handle<SceneText> {
    app.world().resource::<AssetServer>().load(name.to_string())
}

fn runs(app: &App, scene: Entity) -> bool {
    app.world().get::<SoftSimulation>(scene).is_some()
}

#[test]
fn a_file_is_loaded_with_the_files_that_it_names() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("scenes/meshes")).unwrap();
    std::fs::write(folder.path().join("scenes/one.ron"), ONE).unwrap();
    std::fs::write(folder.path().join("scenes/meshes/one.msh"), MESH).unwrap();
    let mut app = app_in(folder.path());
    let handle = file_of(&app, "scenes/one.ron");
    let scene = spawn_asset(&mut app, handle.clone());
    until(&mut app, |app| runs(app, scene));
    app.update();
    assert_eq!(places(&app, body(&app, scene, "one")).len(), 4);
    let texts = app.world().resource::<Assets<SceneText>>();
    let names: Vec<&String> = texts.get(&handle).unwrap().files.keys().collect();
    assert_eq!(names, ["meshes/one.msh"]);
}

#[test]
fn a_file_may_have_a_space_in_its_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("my meshes")).unwrap();
    std::fs::write(folder.path().join("one.ron"), ONE.replace("meshes/one.msh", "my meshes/number one.msh")).unwrap();
    std::fs::write(folder.path().join("my meshes/number one.msh"), MESH).unwrap();
    let mut app = app_in(folder.path());
    let handle = file_of(&app, "one.ron");
    let scene = spawn_asset(&mut app, handle);
    until(&mut app, |app| runs(app, scene));
}

#[test]
fn a_file_that_changes_starts_anew_and_one_that_is_wrong_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bar.ron");
    std::fs::write(&path, BAR).unwrap();
    let mut app = app_in(folder.path());
    let handle = file_of(&app, "bar.ron");
    let scene = spawn_asset(&mut app, handle);
    until(&mut app, |app| runs(app, scene));
    update(&mut app, 10);
    let (bar, time) = (body(&app, scene, "bar"), simulation(&app, scene).time());

    std::fs::write(&path, BAR.replace("duration", "duratoin")).unwrap();
    app.world().resource::<AssetServer>().reload("bar.ron");
    let mut refused = Vec::new();
    until(&mut app, |app| {
        refused.extend(messages::<Refused>(app));
        !refused.is_empty()
    });
    assert!(refused[0].scene == scene && refused[0].error.contains("duratoin"), "{refused:?}");
    assert!(simulation(&app, scene).time() > time, "the old one goes on");

    std::fs::write(&path, BAR.replace("(6, 2, 2)", "(3, 2, 2)")).unwrap();
    app.world().resource::<AssetServer>().reload("bar.ron");
    until(&mut app, |app| simulation(app, scene).time() < time);
    update(&mut app, 2);
    assert_eq!(body(&app, scene, "bar"), bar, "the entity keeps its material");
    assert_eq!(places(&app, bar).len(), 4 * 3 * 3 - 2);
}

#[test]
fn a_wrong_scene_is_refused_once() {
    let mut app = app();
    let scene = spawn(&mut app, "(duration: 1)");
    let mut refused = Vec::new();
    for _ in 0..5 {
        app.update();
        refused.extend(messages::<Refused>(&mut app));
    }
    assert!(refused.len() == 1 && refused[0].error.contains("the scene has no body"), "{refused:?}");
    assert!(!runs(&app, scene));
}
