//! Grabbing: an entity that holds a point of a body.

use crate::simulation::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;
use sinew::glam::DVec3;
use sinew::{Error, GrabId, Grip, Pick};

/// Why a hand holds nothing any more.
const ANEW: &str = "the scene has started anew since this was grabbed: pick and grab again";

/// A hand: spawn it to grab a point, change its target to pull, despawn it or remove this to let go; put in anew, it
/// lets go and grabs what was picked then. Where its scene starts anew it holds nothing any more, and is despawned with
/// a [`Refused`].
///
/// ```ignore
/// if let Some(pick) = simulation.pick_from(ray, place)? {
///     let target = place.transform_point(pick.point.as_vec3());
///     commands.spawn(SoftGrab::new(scene, pick, target));
/// }
/// ```
#[derive(Component, Clone, Debug)]
pub struct SoftGrab {
    /// The scene's entity.
    pub scene: Entity,
    /// What was picked ([`SoftSimulation::pick_from`]).
    pub pick: Pick,
    /// Where it is pulled to, in the world.
    pub target: Vec3,
    /// How it is held.
    pub grip: Grip,
    /// The force with which it pulled at the end of the last tick (N), along the axes of the world.
    pub force: Vec3,
}

impl SoftGrab {
    /// Holds a point as stiffly as no step has to follow.
    pub fn new(scene: Entity, pick: Pick, target: Vec3) -> Self {
        Self { scene, pick, target, grip: Grip::default(), force: Vec3::ZERO }
    }
}

/// What the engine knows of a hand.
#[derive(Component)]
pub(crate) struct Held {
    id: GrabId,
    /// The run that has it: in another one the number may be that of another hand.
    run: (u64, u64),
    scene: Entity,
    /// Where it is pulled to, in the scene (m): also other than before where the scene is moved and the hand is not.
    target: DVec3,
}

/// Grabs what is to be held, and moves what is held.
pub(crate) fn hold(
    mut commands: Commands,
    mut hands: Query<(Entity, &SoftGrab, Option<&mut Held>)>,
    mut scenes: Query<(&mut SoftSimulation, &GlobalTransform)>,
    mut refused: MessageWriter<Refused>,
) {
    for (hand, grab, held) in &mut hands {
        let Ok((mut simulation, place)) = scenes.get_mut(grab.scene) else { continue };
        let target = in_scene(place, grab.target);
        let moved = match held {
            Some(held) if held.run != simulation.run => Err(Error::Options(ANEW.into())),
            Some(held) if held.target == target => Ok(()),
            Some(mut held) => {
                held.target = target;
                simulation.move_grab(held.id, target)
            }
            None => simulation.grab(&grab.pick, &grab.grip).and_then(|id| {
                commands.entity(hand).insert(Held { id, run: simulation.run, scene: grab.scene, target });
                simulation.move_grab(id, target)
            }),
        };
        if let Err(error) = moved {
            // what cannot be held, or was let go by going back, is no hand any more
            refused.write(Refused { scene: grab.scene, error: error.to_string() });
            commands.entity(hand).despawn();
        }
    }
}

/// Tells hands what they pull with.
pub(crate) fn feel(
    mut hands: Query<(&mut SoftGrab, &Held)>,
    mut scenes: Query<(&mut SoftSimulation, &GlobalTransform)>,
) {
    for (mut grab, held) in &mut hands {
        let Ok((mut simulation, place)) = scenes.get_mut(held.scene) else { continue };
        if held.run == simulation.run
            && let Ok(force) = simulation.grab_force(held.id)
        {
            grab.bypass_change_detection().force = place.rotation() * force.as_vec3();
        }
    }
}

/// A hand that is no hand any more, or another one, holds nothing.
pub(crate) fn open(gone: On<Discard<SoftGrab>>, mut commands: Commands) {
    commands.entity(gone.entity).try_remove::<Held>();
}

/// Lets go when a hand goes.
pub(crate) fn let_go(gone: On<Remove<Held>>, hands: Query<&Held>, mut scenes: Query<&mut SoftSimulation>) {
    let Ok(held) = hands.get(gone.entity) else { return };
    if let Ok(mut simulation) = scenes.get_mut(held.scene)
        && held.run == simulation.run
    {
        // what went back to before it was grabbed does not hold it any more
        let _ = simulation.release(held.id);
    }
}
