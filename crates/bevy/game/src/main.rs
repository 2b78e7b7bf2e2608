//! A jelly to drag with the mouse.

use bevy::prelude::*;
use sinew_bevy::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, SinewPlugin))
        .add_systems(Startup, setup)
        .add_systems(Update, (paint, drag, keys, tell))
        .run();
}

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    commands.spawn((SoftScene(assets.load("jelly.ron")), z_up()));
    commands.spawn((Camera3d::default(), Transform::from_xyz(1.2, 1.0, 1.6).looking_at(0.3 * Vec3::Y, Vec3::Y)));
    commands.spawn((DirectionalLight::default(), Transform::from_xyz(1.0, 3.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y)));
}

/// Bodies appear without a material.
fn paint(
    mut commands: Commands,
    bodies: Query<Entity, Added<SoftBody>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for body in &bodies {
        let material = StandardMaterial { base_color: Color::srgb(0.9, 0.3, 0.25), ..default() };
        commands.entity(body).insert(MeshMaterial3d(materials.add(material)));
    }
}

fn drag(
    mut commands: Commands,
    mouse: Res<ButtonInput<MouseButton>>,
    window: Single<&Window>,
    camera: Single<(&Camera, &GlobalTransform)>,
    mut scenes: Query<(Entity, &mut SoftSimulation, &GlobalTransform)>,
    mut hands: Query<(Entity, &mut SoftGrab)>,
) {
    let (camera, eye) = *camera;
    let Some(ray) = window.cursor_position().and_then(|at| camera.viewport_to_world(eye, at).ok()) else { return };
    if mouse.just_pressed(MouseButton::Left) {
        for (scene, mut simulation, place) in &mut scenes {
            if let Ok(Some(pick)) = simulation.pick_from(ray, place) {
                let target = place.transform_point(pick.point.as_vec3());
                commands.spawn(SoftGrab::new(scene, pick, target));
            }
        }
    }
    for (hand, mut grab) in &mut hands {
        if mouse.pressed(MouseButton::Left) {
            // in the plane of the screen through the point
            let away = InfinitePlane3d::new(eye.forward());
            if let Some(distance) = ray.intersect_plane(grab.target, away) {
                grab.target = ray.get_point(distance);
            }
        } else {
            commands.entity(hand).despawn();
        }
    }
}

fn keys(keys: Res<ButtonInput<KeyCode>>, mut clock: ResMut<SinewClock>, mut scenes: Query<&mut SoftSimulation>) {
    if keys.just_pressed(KeyCode::Space) {
        clock.paused = !clock.paused;
    }
    if keys.just_pressed(KeyCode::KeyR) {
        for mut simulation in &mut scenes {
            if let Err(error) = simulation.restart() {
                error!("{error}");
            }
        }
    }
}

fn tell(mut broke_down: MessageReader<BrokeDown>, mut refused: MessageReader<Refused>) {
    broke_down.read().for_each(|message| error!("{}", message.error));
    refused.read().for_each(|message| warn!("{}", message.error));
}
