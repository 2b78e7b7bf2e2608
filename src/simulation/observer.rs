//! What observes a run and guards it, as its scene says.

use crate::components::*;
use crate::observation::{GuardSettings, Observer, Track};
use crate::scene::SceneFile;
use crate::scene::schema::{ContactLaw, EnergyGuard, Guard, Solver};
use bevy_ecs::prelude::*;

/// How much more of the balance of energy implicit steps are allowed than explicit ones.
const LONG_STEPS: f64 = 10.0;
/// About how many passes an implicit step takes: checks of the guards come as many times as often.
const PASSES_A_STEP: u64 = 16;

/// Of a scene, whose run takes so many steps.
pub(super) fn observer(scene: &SceneFile, clock: &Clock, steps: u64, world: &mut World) -> Observer {
    let every = |time: f64| Cadence::new(time, clock.time_step);
    let mut observer = Observer::default();
    observer.fields = every(scene.scene.fields_every());
    observer.energy = scene.scene.output.energies_every.map(|time| Track::new(every(time)));
    observer.touches = scene.scene.touches();
    observer.snapshots = scene.scene.output.snapshots_every.filter(|_| !scene.scene.is_static()).map(every);
    let mut limits = scene.scene.guards.clone();
    let without_energy = scene.scene.materials.values().any(|material| material.by_frame().is_some());
    if without_energy {
        limits.off.push(Guard::Energy);
    }
    if scene.scene.is_implicit() {
        // work is that of the mean of the forces at both ends, which long steps make less of a measure
        limits.energy = EnergyGuard { warn: LONG_STEPS * limits.energy.warn, stop: LONG_STEPS * limits.energy.stop };
        limits.every = limits.every.div_ceil(PASSES_A_STEP);
    }
    observer.guard_settings = GuardSettings {
        limits,
        beyond: scene.scene.integration.beyond_stable_step && clock.relaxation.is_none(),
        foreign: false,
        removal: world.query::<&Alive>().iter(world).next().is_some(),
        implicit: scene.scene.is_implicit(),
        solved: matches!(scene.scene.solver, Solver::Implicit { newton: 2.., budget: None, .. }),
        contacts: !scene.scene.contacts.is_empty() && clock.relaxation.is_none(),
        springs: scene.scene.contacts.iter().any(|contact| contact.law() != ContactLaw::Kinematic)
            && clock.relaxation.is_none(),
    };
    observer.to_rest = clock.relaxation.is_some();
    observer.follows_path = scene.scene.follows_path();
    observer.last_step = if clock.relaxation.is_some() { u64::MAX } else { steps };
    observer.track_probes(world);
    observer
}
