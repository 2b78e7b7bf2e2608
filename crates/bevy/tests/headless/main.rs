//! The plugin in apps without a window: Bevy's own plugins for tasks, time, assets, transforms and meshes, and updates
//! in a loop.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod assets;
mod bodies;
#[allow(dead_code)]
#[path = "../../examples/cube.rs"]
mod cube;
mod gizmos;
mod hands;
mod page;
mod time;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetPlugin, Assets, Handle};
use bevy_ecs::prelude::*;
use bevy_mesh::{Indices, Mesh, Mesh3d, MeshPlugin, VertexAttributeValues};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use sinew::BackendChoice;
use sinew_bevy::*;
use std::path::Path;

/// A bar that bends under its weight, which is an input.
const BAR: &str = r#"(
    duration: 10,
    bodies: {"bar": (mesh: Box(size: (0.06, 0.02, 0.02), cells: (6, 2, 2), elements: Hex8), material: "gel")},
    materials: {"gel": (density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4), damping: 5)},
    constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
    loads: [Gravity(acceleration: (0, 0, -9.81), curve: Input(name: "weight", initial: 1))],
    probes: {"tip": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.06), every: 0.01)},
)"#;

/// An app whose updates are a tick each, with assets in a folder.
fn app_in(folder: &Path) -> App {
    let mut app = App::new();
    let assets = AssetPlugin { file_path: folder.display().to_string(), ..AssetPlugin::default() };
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, assets, TransformPlugin, MeshPlugin, SinewPlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    // no test is about a machine that is busy but for that which says so
    app.world_mut().resource_mut::<SinewClock>().budget = std::time::Duration::from_secs(60);
    app
}

fn app() -> App {
    app_in(Path::new("nowhere"))
}

/// On the CPU, with one thread.
fn on_the_cpu() -> SoftOptions {
    let mut options = SoftOptions::default();
    (options.options.backend, options.options.threads) = (BackendChoice::Cpu, 1);
    options
}

/// A scene of a text.
fn spawn(app: &mut App, text: &str) -> Entity {
    let handle = app.world_mut().resource_mut::<Assets<SceneText>>().add(SceneText::new("scene", text));
    spawn_asset(app, handle)
}

fn spawn_asset(app: &mut App, handle: Handle<SceneText>) -> Entity {
    app.world_mut().spawn((SoftScene(handle), on_the_cpu())).id()
}

fn update(app: &mut App, times: usize) {
    (0..times).for_each(|_| app.update());
}

fn simulation(app: &App, scene: Entity) -> &SoftSimulation {
    app.world().get::<SoftSimulation>(scene).expect("it is running")
}

fn simulation_mut(app: &mut App, scene: Entity) -> Mut<'_, SoftSimulation> {
    app.world_mut().get_mut::<SoftSimulation>(scene).expect("it is running")
}

/// The entity of a scene's body.
fn body(app: &App, scene: Entity, name: &str) -> Entity {
    let children = app.world().get::<Children>(scene).expect("it has bodies");
    let is_it = |child: &&Entity| app.world().get::<SoftBody>(**child).is_some_and(|body| body.name == name);
    *children.iter().collect::<Vec<_>>().iter().find(is_it).expect("it has this body")
}

fn mesh(app: &App, body: Entity) -> &Mesh {
    let handle = app.world().get::<Mesh3d>(body).expect("it is drawn");
    app.world().resource::<Assets<Mesh>>().get(&handle.0).expect("its mesh is there")
}

fn vectors(mesh: &Mesh, attribute: bevy_mesh::MeshVertexAttribute) -> Vec<[f32; 3]> {
    match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(values)) => values.clone(),
        other => panic!("{other:?}"),
    }
}

fn places(app: &App, body: Entity) -> Vec<[f32; 3]> {
    vectors(mesh(app, body), Mesh::ATTRIBUTE_POSITION)
}

fn triangles(app: &App, body: Entity) -> Vec<u32> {
    match mesh(app, body).indices() {
        Some(Indices::U32(indices)) => indices.clone(),
        other => panic!("{other:?}"),
    }
}

/// All messages of a kind that are there, taken.
fn messages<M: Message>(app: &mut App) -> Vec<M> {
    app.world_mut().resource_mut::<Messages<M>>().drain().collect()
}
