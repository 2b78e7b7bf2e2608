//! Picking and grabbing in a world whose y points up.

use crate::*;
use bevy_math::{Dir3, Vec3};
use bevy_shape::Ray3d;
use bevy_transform::components::GlobalTransform;

#[test]
fn a_hand_lifts_what_it_has_picked_and_lets_go() {
    let mut app = app();
    let (scene, other) = (spawn(&mut app, BAR), spawn(&mut app, BAR));
    for scene in [scene, other] {
        app.world_mut().entity_mut(scene).insert((z_up(), SoftProbes::default()));
    }
    update(&mut app, 3);
    let place = *app.world().get::<GlobalTransform>(scene).unwrap();
    // from above in the world: the scene's z is its y, the scene's y its -z
    let ray = Ray3d { origin: Vec3::new(0.055, 1.0, -0.01), direction: Dir3::NEG_Y };
    let pick = simulation_mut(&mut app, scene).pick_from(ray, &place).unwrap().expect("the bar is below");
    let point = place.transform_point(pick.point.as_vec3());
    // it has fallen for some ticks
    assert!((point - Vec3::new(0.055, point.y, -0.01)).length() < 1e-6 && (0.01..0.02).contains(&point.y), "{point}");
    let beside = Ray3d { origin: Vec3::new(1.0, 1.0, 0.0), direction: Dir3::NEG_Y };
    assert_eq!(simulation_mut(&mut app, scene).pick_from(beside, &place).unwrap(), None);

    let hand = app.world_mut().spawn(SoftGrab::new(scene, pick, point + 0.01 * Vec3::Y)).id();
    update(&mut app, 10);
    let force = app.world().get::<SoftGrab>(hand).unwrap().force;
    let height = |app: &App, scene| app.world().get::<SoftProbes>(scene).unwrap().0["tip"][2];
    assert!(height(&app, scene) > height(&app, other) + 1e-3);
    assert!(force.y > 1e-4 && force.y > force.x.abs(), "{force}");
    let lifted = height(&app, scene);
    app.world_mut().get_mut::<SoftGrab>(hand).unwrap().target = point - 0.01 * Vec3::Y;
    update(&mut app, 10);
    assert!(height(&app, scene) < lifted - 1e-3);
    assert_eq!(simulation(&app, scene).grabs().count(), 1);
    app.world_mut().despawn(hand);
    assert_eq!(simulation(&app, scene).grabs().count(), 0);
}

#[test]
fn what_cannot_be_grabbed_is_refused() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    app.world_mut().get_mut::<SoftOptions>(scene).unwrap().options.grabs = false;
    update(&mut app, 3);
    let ray = Ray3d { origin: Vec3::new(0.05, 0.01, 1.0), direction: Dir3::NEG_Z };
    let pick = simulation_mut(&mut app, scene).pick_from(ray, &GlobalTransform::IDENTITY).unwrap().unwrap();
    let hand = app.world_mut().spawn(SoftGrab::new(scene, pick, Vec3::ZERO)).id();
    update(&mut app, 2);
    let refused = messages::<Refused>(&mut app);
    assert!(refused.len() == 1 && refused[0].error.contains("grabs: true"), "{refused:?}");
    assert!(app.world().get_entity(hand).is_err());
}

/// The numbers of grabs begin again with each simulation: a hand of the one before must not steer that of another.
#[test]
fn where_a_scene_starts_anew_hands_of_before_are_gone_and_others_stay() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 3);
    let ray = Ray3d { origin: Vec3::new(0.05, 0.01, 1.0), direction: Dir3::NEG_Z };
    let pick = simulation_mut(&mut app, scene).pick_from(ray, &GlobalTransform::IDENTITY).unwrap().unwrap();
    let place = pick.point.as_vec3();
    let grabs =
        |app: &mut App, by: f32| app.world_mut().spawn(SoftGrab::new(scene, pick.clone(), place + by * Vec3::Z)).id();
    let mut before = grabs(&mut app, 0.001);
    update(&mut app, 2);
    let anew: [fn(&mut App, Entity); 2] = [
        |app: &mut App, scene: Entity| {
            app.world_mut().get_mut::<SoftOptions>(scene).unwrap().sets = vec!["duration=5".into()];
        },
        |app: &mut App, scene: Entity| simulation_mut(app, scene).restart().unwrap(),
    ];
    for (by, start) in [0.002, 0.003].into_iter().zip(anew) {
        let hand = grabs(&mut app, by);
        app.world_mut().get_mut::<SoftGrab>(before).unwrap().target = place + 0.1 * Vec3::Z;
        start(&mut app, scene);
        update(&mut app, 2);
        let refused = messages::<Refused>(&mut app);
        assert!(refused.len() == 1 && refused[0].error.contains("started anew"), "{refused:?}");
        assert!(app.world().get_entity(before).is_err() && app.world().get_entity(hand).is_ok());
        let held: Vec<Vec3> = simulation(&app, scene).grabs().map(|(_, grab)| grab.target.as_vec3()).collect();
        assert!(held.len() == 1 && held[0].distance(place + by * Vec3::Z) < 1e-6, "{held:?}");
        before = hand;
    }
}

/// A bar that runs, and a hand that pulls at a place of it to another.
fn held(app: &mut App, target: Vec3) -> (Entity, Entity) {
    let scene = spawn(app, BAR);
    update(app, 3);
    let pick = picked(app, scene, 0.05);
    let hand = app.world_mut().spawn(SoftGrab::new(scene, pick, target)).id();
    update(app, 1);
    (scene, hand)
}

fn picked(app: &mut App, scene: Entity, x: f32) -> sinew::Pick {
    let ray = Ray3d { origin: Vec3::new(x, 0.01, 1.0), direction: Dir3::NEG_Z };
    simulation_mut(app, scene).pick_from(ray, &GlobalTransform::IDENTITY).unwrap().unwrap()
}

fn grabs(app: &App, scene: Entity) -> Vec<sinew::Grab> {
    simulation(app, scene).grabs().map(|(_, grab)| grab.clone()).collect()
}

#[test]
fn a_hand_that_stands_still_pulls_where_it_is_also_when_its_scene_is_moved() {
    let mut app = app();
    let target = Vec3::new(0.05, 0.01, 0.03);
    let (scene, _) = held(&mut app, target);
    let moved = Vec3::new(0.0, 0.0, 0.02);
    app.world_mut().entity_mut(scene).insert(bevy_transform::components::Transform::from_translation(moved));
    // it is led into the world at the end of a frame
    update(&mut app, 2);
    let held = grabs(&app, scene);
    assert!(held.len() == 1 && held[0].target.as_vec3().distance(target - moved) < 1e-6, "{held:?}");
}

#[test]
fn who_is_no_hand_any_more_lets_go_and_one_that_is_put_in_anew_grabs_anew() {
    let mut app = app();
    let target = Vec3::new(0.05, 0.01, 0.03);
    let (scene, hand) = held(&mut app, target);
    let before = grabs(&app, scene);
    let other = picked(&mut app, scene, 0.015);
    app.world_mut().entity_mut(hand).insert(SoftGrab::new(scene, other.clone(), target));
    update(&mut app, 1);
    let held = grabs(&app, scene);
    assert!(before.len() == 1 && held.len() == 1, "{held:?}");
    // two ticks have passed since it was picked
    assert!(held[0].from.distance(other.point) < 2e-3 && before[0].from.distance(other.point) > 0.02, "{held:?}");
    app.world_mut().entity_mut(hand).remove::<SoftGrab>();
    update(&mut app, 1);
    assert!(grabs(&app, scene).is_empty() && app.world().get_entity(hand).is_ok());
    assert!(messages::<Refused>(&mut app).is_empty());
}
