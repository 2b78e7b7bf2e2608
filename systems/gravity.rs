//! `gravity`: mass times acceleration on every node. `shaders/gravity.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// Adds m g to the external forces.
pub fn system() -> System {
    System::built_in(
        "gravity",
        Phase::Loads,
        "adds mass times acceleration to the external forces",
        "`Gravity(...)` under `loads`",
        |world| super::registry::count::<Gravity>(world, "gravity load"),
        gravity,
    )
}

fn gravity(signals: Res<Signals>, loads: Query<(&Gravity, &OfBody)>, mut bodies: Query<(&Mass, &mut ExternalForce)>) {
    for (load, body) in &loads {
        let Ok((mass, mut external)) = bodies.get_mut(body.0) else { continue };
        let acceleration = signals.values()[load.signal];
        match &mut external.0 {
            Reals::F32(external) => pull(mass.slice(), acceleration, external),
            Reals::F64(external) => pull(mass.slice(), acceleration, external),
        }
    }
}

fn pull<T: Scalar>(mass: &[T], acceleration: [f64; 4], external: &mut [T]) {
    let acceleration = [0, 1, 2].map(|i| T::from_f64(acceleration[i]));
    for (force, &mass) in external.chunks_exact_mut(3).zip(mass) {
        for i in 0..3 {
            force[i] += mass * acceleration[i];
        }
    }
}
