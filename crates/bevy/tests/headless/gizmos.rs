//! What holds and pushes, drawn over bodies; skins.

use crate::*;
use bevy_gizmos::{GizmoAsset, GizmoPlugin};
use bevy_math::Vec3;

/// Ends of all lines that were drawn in the last frame, in the world.
fn lines(app: &App) -> Vec<[Vec3; 2]> {
    let all = app.world().resource::<Assets<GizmoAsset>>().iter();
    all.flat_map(|(_, asset)| asset.buffer().buffer().list_positions.as_chunks::<2>().0.to_vec()).collect()
}

/// The bar with its gizmos, after some ticks.
fn drawn(wanted: SoftGizmos, text: &str) -> (App, Entity) {
    let mut app = app();
    app.add_plugins((GizmoPlugin, SinewGizmosPlugin));
    let scene = spawn(&mut app, text);
    app.world_mut().entity_mut(scene).insert(wanted);
    update(&mut app, 4);
    (app, scene)
}

const NONE: SoftGizmos = SoftGizmos { supports: false, forces: false, tools: false, grabs: false };

#[test]
fn supports_are_crosses_where_nodes_are_held() {
    let (app, _) = drawn(SoftGizmos { supports: true, ..NONE }, BAR);
    let lines = lines(&app);
    // nine nodes, three lines each, about places at x = 0
    assert_eq!(lines.len(), 9 * 3);
    assert!(lines.iter().all(|[from, to]| (0.5 * (*from + *to)).x.abs() < 1e-6), "{lines:?}");
    assert_eq!(drawn_lines(NONE), 0);
}

fn drawn_lines(wanted: SoftGizmos) -> usize {
    lines(&drawn(wanted, BAR).0).len()
}

#[test]
fn forces_are_arrows_along_loads_the_longest_an_eighth_of_the_body() {
    let (app, _) = drawn(SoftGizmos { forces: true, ..NONE }, BAR);
    let lines = lines(&app);
    let downwards = lines.iter().filter(|[from, to]| {
        let way = *to - *from;
        way.z < 0.0 && way.truncate().length() < 1e-3 * -way.z
    });
    // one shaft a node, the middle of which weighs most: an eighth of the diagonal of 0.06, 0.02, 0.02 m, which bends
    let longest = downwards.clone().map(|[from, to]| (*to - *from).length()).fold(0.0, f32::max);
    let diagonal = Vec3::new(0.06, 0.02, 0.02).length();
    assert_eq!(downwards.count(), 7 * 3 * 3);
    assert!((longest / (diagonal / 8.0) - 1.0).abs() < 0.1, "{longest}");
}

#[test]
fn tools_and_hands_are_where_they_are() {
    let tool = "\n    tools: {\"ball\": (shape: Sphere(radius: 0.004), at: (0.05, 0.01, 0.05))},\n    \
                contacts: [Tool(tool: \"ball\")],\n)";
    let text = BAR.replace("\n)", tool);
    let (mut app, scene) = drawn(SoftGizmos { tools: true, grabs: true, ..NONE }, &text);
    let center = Vec3::new(0.05, 0.01, 0.05);
    let found = lines(&app);
    assert_eq!(found.len(), 3);
    assert!(found.iter().all(|[from, to]| (0.5 * (*from + *to)).distance(center) < 1e-6), "{found:?}");
    let ray = bevy_shape::Ray3d::new(Vec3::new(0.05, 0.011, 0.1), bevy_math::Dir3::NEG_Z);
    let place = *app.world().get::<bevy_transform::components::GlobalTransform>(scene).unwrap();
    let pick = simulation_mut(&mut app, scene).pick_from(ray, &place).unwrap().expect("the bar is below");
    let target = Vec3::new(0.05, 0.011, 0.06);
    app.world_mut().spawn(SoftGrab::new(scene, pick, target));
    update(&mut app, 2);
    let found = lines(&app);
    let held = found.iter().find(|[_, to]| to.distance(target) < 1e-6).expect("a line to the hand");
    let top = simulation_mut(&mut app, scene).positions("bar").unwrap().iter().map(|node| node.z).fold(0.0, f64::max);
    assert!((held[0].x - 0.05).abs() < 2e-3 && f64::from(held[0].z) <= top + 1e-6, "{held:?}");
}

/// The bar with a skin of a Wavefront text, once it has run so far (s).
fn bar_with_skin(folder: &Path, skin: &str, time: f64) -> (App, Entity) {
    let scene = BAR.replace("material: \"gel\"", "material: \"gel\", skin: (file: \"skin.obj\")");
    std::fs::write(folder.join("skin.obj"), skin).unwrap();
    std::fs::write(folder.join("bar.ron"), scene).unwrap();
    let mut app = app_in(folder);
    let handle = app.world().resource::<bevy_asset::AssetServer>().load("bar.ron");
    let scene = spawn_asset(&mut app, handle);
    for _ in 0..2000 {
        app.update();
        if app.world().get::<SoftSimulation>(scene).is_some_and(|running| running.time() > time) {
            break;
        }
    }
    (app, scene)
}

/// Two triangles through the bar, with a picture on them.
const SKIN: &str = "v 0 0 0.015\nv 0.06 0 0.015\nv 0.06 0.02 0.015\nv 0 0.02 0.015\n\
    vt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 0.75\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

#[test]
fn a_body_with_a_skin_is_drawn_as_that_with_its_texture_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let (mut app, scene) = bar_with_skin(folder.path(), SKIN, 0.1);
    let bar = body(&app, scene, "bar");
    assert_eq!(triangles(&app, bar), [0, 1, 2, 0, 2, 3]);
    match mesh(&app, bar).attribute(Mesh::ATTRIBUTE_UV_0) {
        // from the top of the picture downwards
        Some(VertexAttributeValues::Float32x2(found)) => {
            assert_eq!(*found, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.25], [0.0, 0.25]]);
        }
        other => panic!("{other:?}"),
    }
    // between two ticks a mesh is where it was in a share of them; what stands still is where it is
    app.world_mut().resource_mut::<SinewClock>().paused = true;
    update(&mut app, 2);
    let moved = simulation_mut(&mut app, scene).skin("bar").unwrap().points;
    let drawn = places(&app, bar);
    let off = moved.iter().zip(&drawn).map(|(a, b)| a.as_vec3().distance(Vec3::from_array(*b))).fold(0.0, f32::max);
    // the free end has sunk
    assert!(off < 1e-6 && drawn[1][2] < 0.0145, "{off} {drawn:?}");
}

/// A roof over the bar, each side of which has places of its own in the picture.
const ROOF: &str = "v 0 0 0.015\nv 0.06 0 0.015\nv 0 0.01 0.02\nv 0.06 0.01 0.02\nv 0 0.02 0.015\nv 0.06 0.02 0.015\n\
    vt 0 0\nvt 1 0\nvt 0 0.4\nvt 1 0.4\nvt 0 0.6\nvt 1 0.6\nvt 0 1\nvt 1 1\n\
    f 1/1 2/2 4/4\nf 1/1 4/4 3/3\nf 3/5 4/6 6/8\nf 3/5 6/8 5/7\n";

#[test]
fn a_skin_has_one_normal_at_a_place_whatever_its_texture_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let (app, scene) = bar_with_skin(folder.path(), ROOF, 0.01);
    let bar = body(&app, scene, "bar");
    let (places, normals) = (places(&app, bar), vectors(mesh(&app, bar), Mesh::ATTRIBUTE_NORMAL));
    let mut shared = 0;
    assert_eq!((places.len(), normals.len()), (8, 8));
    for (row, place) in places.iter().enumerate() {
        for other in (0..row).filter(|other| places[*other] == *place) {
            let [one, two] = [row, other].map(|row| Vec3::from_array(normals[row]));
            assert!(one.distance(two) < 1e-6 && one.is_normalized() && one.z > 0.9, "{one} {two}");
            shared += 1;
        }
    }
    assert_eq!(shared, 2);
}
