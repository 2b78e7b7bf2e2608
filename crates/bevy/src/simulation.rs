//! What stands on entities: a scene, its simulation, its bodies, what goes in and what comes out.

use crate::scene::SceneText;
use bevy_asset::Handle;
use bevy_camera::visibility::Visibility;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_shape::Ray3d;
use bevy_transform::components::{GlobalTransform, Transform};
use sinew::glam::DVec3;
use sinew::{Error, Options, Pick, Simulation};
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::time::Duration;

/// A scene that runs here: where its [`SceneText`] is loaded, [`SoftSimulation`] appears beside it, and a child of
/// [`SoftBody`] for each body.
///
/// The entity's [`Transform`] leads from the scene's metres and axes into the world: [`z_up`] for scenes whose z points
/// up.
#[derive(Component, Clone, Debug)]
#[require(Transform, Visibility, SoftOptions)]
pub struct SoftScene(pub Handle<SceneText>);

/// How a scene is run. Where it changes, the scene starts anew.
#[derive(Component, Clone, Debug)]
pub struct SoftOptions {
    /// Backend, precision, threads.
    pub options: Options,
    /// Values put in, as by `--set`: `"duration=2"`.
    pub sets: Vec<String>,
}

impl Default for SoftOptions {
    /// On the best backend, with bodies that can be grabbed.
    fn default() -> Self {
        Self { options: Options { grabs: true, ..Options::default() }, sets: Vec::new() }
    }
}

/// A simulation at work, on the entity of its scene. Between two ticks it can be looked at and changed as any
/// [`Simulation`], which it dereferences to.
#[derive(Component)]
pub struct SoftSimulation {
    simulation: Simulation,
    /// By how much the clock is beyond the time that was asked for last (s): less than a step.
    pub(crate) ahead: f64,
    /// Whether inputs have not been set yet.
    pub(crate) fresh: bool,
    pub(crate) broken: bool,
    /// Which run it is: how many simulations the app had made by then, and how often this one has begun anew since.
    pub(crate) run: (u64, u64),
    /// How often it had been restored when it was looked at last: what is drawn and told is of that.
    seen: Option<u64>,
}

impl SoftSimulation {
    /// The simulation that an app has made as its first, second ...
    pub(crate) fn new(simulation: Simulation, number: u64) -> Self {
        Self { simulation, ahead: 0.0, fresh: true, broken: false, run: (number, 0), seen: None }
    }

    /// Whether it is in another state than by steps from where it was looked at last; it is looked at now.
    pub(crate) fn has_gone_over(&mut self) -> bool {
        let now = Some(self.simulation.times_restored());
        std::mem::replace(&mut self.seen, now) != now
    }

    /// Whether it broke down: it stands still until [`restart`](Self::restart).
    pub fn is_broken(&self) -> bool {
        self.broken
    }

    /// Goes back to the state before the first step, and on from there. Hands let go.
    ///
    /// # Errors
    /// As [`Simulation::reset`].
    pub fn restart(&mut self) -> Result<(), Error> {
        self.simulation.reset()?;
        (self.ahead, self.fresh, self.broken) = (0.0, true, false);
        self.run.1 += 1;
        Ok(())
    }

    /// Where a ray of the world (a camera's `viewport_to_world`) first meets a body. `place` is the [`GlobalTransform`]
    /// of the scene's entity, and leads the pick's point into the world.
    ///
    /// # Errors
    /// As [`Simulation::pick`].
    pub fn pick_from(&mut self, ray: Ray3d, place: &GlobalTransform) -> Result<Option<Pick>, Error> {
        let to_scene = place.affine().inverse();
        let origin = to_scene.transform_point3(ray.origin);
        let direction = to_scene.transform_vector3(*ray.direction);
        self.simulation.pick(origin.as_dvec3(), direction.as_dvec3())
    }
}

impl Deref for SoftSimulation {
    type Target = Simulation;

    fn deref(&self) -> &Simulation {
        &self.simulation
    }
}

impl DerefMut for SoftSimulation {
    fn deref_mut(&mut self) -> &mut Simulation {
        &mut self.simulation
    }
}

/// A body of a scene, on a child of the scene's entity, beside its `Mesh3d`: its skin, with texture coordinates if the
/// skin's file has some, or its surface. Give it a material when it appears:
/// `Query<Entity, Added<SoftBody>>`.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub struct SoftBody {
    /// Its name in the scene.
    pub name: String,
}

/// Inputs of the scene (`curve: Input(name: ...)`), by name: what is set here is taken up in the next tick.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct SoftInputs(pub BTreeMap<String, f64>);

/// What the probes of the scene see, by name, after each tick: put it beside [`SoftScene`] to have it.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct SoftProbes(pub BTreeMap<String, Vec<f64>>);

/// Time of all scenes.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct SinewClock {
    /// Nothing moves.
    pub paused: bool,
    /// Simulated seconds a second of `Time<Fixed>`.
    pub speed: f64,
    /// What a tick may take on the clock on the wall, shared alike by the scenes that move. What does not fit is left
    /// out and not caught up: see [`FellBehind`].
    pub budget: Duration,
}

impl Default for SinewClock {
    /// As fast as life, in 10 ms of the 15.6 ms between two ticks.
    fn default() -> Self {
        Self { paused: false, speed: 1.0, budget: Duration::from_millis(10) }
    }
}

/// A simulation broke down or the GPU failed. It stands still until [`SoftSimulation::restart`].
#[derive(Message, Clone, Debug)]
pub struct BrokeDown {
    /// The scene's entity.
    pub scene: Entity,
    /// What happened, where, and likely causes.
    pub error: String,
}

/// A scene, an input or a grab was refused: what was before goes on.
#[derive(Message, Clone, Debug)]
pub struct Refused {
    /// The scene's entity.
    pub scene: Entity,
    /// Why; of a scene all mistakes with their places.
    pub error: String,
}

/// Elements of a body have been removed, or have come back.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub struct ElementsRemoved {
    /// The scene's entity.
    pub scene: Entity,
    /// The body's name.
    pub body: String,
    /// How many are left.
    pub left: usize,
}

/// A tick did not fit into its budget.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct FellBehind {
    /// The scene's entity.
    pub scene: Entity,
    /// Which share of the tick's time was simulated: from 0 to 1.
    pub factor: f64,
}

/// The transform of a scene whose z points up, in a world whose y does.
pub fn z_up() -> Transform {
    Transform::from_rotation(bevy_math::Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2))
}

/// A place of the world in a scene (m).
pub(crate) fn in_scene(place: &GlobalTransform, point: Vec3) -> DVec3 {
    place.affine().inverse().transform_point3(point).as_dvec3()
}
