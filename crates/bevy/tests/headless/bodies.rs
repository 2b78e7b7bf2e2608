//! Bodies as meshes.

use crate::*;
use bevy_camera::visibility::Visibility;
use sinew::{Options, SceneFile, Simulation};

#[test]
fn a_body_is_a_mesh_that_moves_and_has_normals() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 2);
    let bar = body(&app, scene, "bar");
    // all nodes but the 5 within, and two triangles a face
    assert_eq!(places(&app, bar).len(), 7 * 3 * 3 - 5);
    assert_eq!(triangles(&app, bar).len(), 3 * 2 * (4 * 6 * 2 + 2 * 2 * 2));
    assert!(app.world().get::<Visibility>(scene).is_some(), "what is drawn has parents that are seen");
    let lowest = |app: &App| places(app, bar).iter().map(|place| place[2]).fold(f32::INFINITY, f32::min);
    let before = lowest(&app);
    update(&mut app, 10);
    assert!(lowest(&app) < before - 1e-4, "{} {before}", lowest(&app));
    for normal in vectors(mesh(&app, bar), Mesh::ATTRIBUTE_NORMAL) {
        let length = normal.iter().map(|x| x * x).sum::<f32>();
        assert!((length - 1.0).abs() < 1e-4, "{normal:?}");
    }
}

#[test]
fn the_cube_of_the_example_sags() {
    let (mut app, scene) = cube::app();
    update(&mut app, 2);
    let top = |app: &App| places(app, body(app, scene, "cube")).iter().map(|place| place[2]).fold(f32::MIN, f32::max);
    let before = top(&app);
    update(&mut app, 8);
    assert!(top(&app) < before - 1e-3, "{} m high, then {} m", before, top(&app));
}

#[test]
fn normals_point_out_of_the_body() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 2);
    let bar = body(&app, scene, "bar");
    let normals = vectors(mesh(&app, bar), Mesh::ATTRIBUTE_NORMAL);
    let outward = |(place, normal): (&[f32; 3], &[f32; 3])| {
        let center = [0.03, 0.01, 0.01];
        (0..3).map(|i| (place[i] - center[i]) * normal[i]).sum::<f32>() > 0.0
    };
    assert!(places(&app, bar).iter().zip(&normals).all(outward));
}

#[test]
fn the_bits_are_those_without_bevy() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 12);
    let steps = simulation(&app, scene).step_count();
    assert!(steps > 20, "{steps}");
    let SoftOptions { options, .. } = on_the_cpu();
    let file = SceneFile::from_text("scene", BAR, Path::new(""), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let mut plain = Simulation::new(&file, &Options { grabs: false, ..options }).unwrap();
    plain.advance(steps).unwrap();
    let moved = simulation_mut(&mut app, scene).displacements("bar").unwrap();
    assert_eq!(moved, plain.displacements("bar").unwrap());
    assert!(moved.iter().any(|u| u.length() > 1e-4));
}

#[test]
fn elements_that_go_are_told_and_their_triangles_go() {
    let removal = r#"removal: [(on: Sphere(center: (0.06, 0.01, 0.01), radius: 0.012), when: At(0.05))],)"#;
    let mut app = app();
    let scene = spawn(&mut app, &BAR.replace("\n)", &format!("\n{removal}")));
    update(&mut app, 2);
    let bar = body(&app, scene, "bar");
    let before = triangles(&app, bar).len();
    assert_eq!(messages::<ElementsRemoved>(&mut app), []);
    let mut told = Vec::new();
    for _ in 0..8 {
        app.update();
        told.extend(messages::<ElementsRemoved>(&mut app));
    }
    let left = simulation_mut(&mut app, scene).elements_left("bar").unwrap();
    assert!(left < 24);
    assert_eq!(told, [ElementsRemoved { scene, body: "bar".into(), left }]);
    assert!(triangles(&app, bar).len() < before);
    assert!(triangles(&app, bar).iter().all(|vertex| (*vertex as usize) < places(&app, bar).len()));
}

#[test]
fn what_is_despawned_is_gone() {
    let mut app = app();
    let (first, second) = (spawn(&mut app, BAR), spawn(&mut app, BAR));
    update(&mut app, 3);
    assert_eq!(app.world().resource::<Assets<Mesh>>().len(), 2);
    app.world_mut().despawn(first);
    update(&mut app, 3);
    assert_eq!(app.world().resource::<Assets<Mesh>>().len(), 1);
    assert_eq!(app.world_mut().query::<&SoftBody>().iter(app.world()).count(), 1);
    assert!(simulation(&app, second).time() > 0.0);
}
