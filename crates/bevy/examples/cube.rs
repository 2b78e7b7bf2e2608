//! A cube of tissue in an app without a window: how high its top is while it sags.
//!
//! `cargo run -p sinew-bevy --example cube`

use bevy_app::{App, Last, TaskPoolPlugin};
use bevy_asset::{AssetPlugin, Assets};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d, MeshPlugin, VertexAttributeValues};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use sinew_bevy::{SceneText, SinewClock, SinewPlugin, SoftBody, SoftScene, z_up};
use std::time::Duration;

const CUBE: &str = include_str!("../../../scenes/cube_under_gravity.ron");

fn main() {
    let (mut app, _) = app();
    app.add_systems(Last, tell);
    (0..32).for_each(|_| app.update());
}

/// The app, and the entity of the scene: each update is a tick.
pub fn app() -> (App, Entity) {
    let mut app = App::new();
    let parts = (TaskPoolPlugin::default(), TimePlugin, AssetPlugin::default(), TransformPlugin, MeshPlugin);
    app.add_plugins((parts, SinewPlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    // nobody waits for a frame: no tick is cut short, however slow the machine
    app.world_mut().resource_mut::<SinewClock>().budget = Duration::from_secs(60);
    let cube = app.world_mut().resource_mut::<Assets<SceneText>>().add(SceneText::new("cube", CUBE));
    let scene = app.world_mut().spawn((SoftScene(cube), z_up())).id();
    (app, scene)
}

/// Says where the highest vertex is. Meshes have the scene's axes: z goes up.
fn tell(time: Res<Time<Fixed>>, bodies: Query<(&SoftBody, &Mesh3d)>, meshes: Res<Assets<Mesh>>) {
    for (body, mesh) in &bodies {
        let positions = meshes.get(&mesh.0).and_then(|mesh| mesh.attribute(Mesh::ATTRIBUTE_POSITION));
        let Some(VertexAttributeValues::Float32x3(positions)) = positions else { continue };
        let top = positions.iter().map(|place| place[2]).fold(f32::MIN, f32::max);
        println!("t = {:.3} s: the {} is {:.1} mm high", time.elapsed_secs_f64(), body.name, 1e3 * top);
    }
}
