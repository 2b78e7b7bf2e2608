//! `nodal_force`: forces on chosen nodes. `shaders/nodal_force.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// Adds a force to each of the load's nodes that has mass: a parked node bears nothing.
pub fn system() -> System {
    System::built_in(
        "nodal_force",
        Phase::Loads,
        "adds forces on chosen nodes to the external forces",
        "`NodalForce(...)` under `loads`",
        |world| super::registry::count::<NodalForce>(world, "nodal force"),
        nodal_force,
    )
}

fn nodal_force(
    signals: Res<Signals>,
    loads: Query<(&NodalForce, &OfBody)>,
    mut bodies: Query<(&Mass, &mut ExternalForce)>,
) {
    for (load, body) in &loads {
        let Ok((mass, mut external)) = bodies.get_mut(body.0) else { continue };
        let force = signals.values()[load.signal];
        match &mut external.0 {
            Reals::F32(external) => push(&load.rows, force, mass.slice(), external),
            Reals::F64(external) => push(&load.rows, force, mass.slice(), external),
        }
    }
}

fn push<T: Scalar>(rows: &[u32], force: [f64; 4], mass: &[T], external: &mut [T]) {
    for row in rows.iter().map(|&row| row as usize).filter(|&row| mass[row] > T::default()) {
        for i in 0..3 {
            external[3 * row + i] += T::from_f64(force[i]);
        }
    }
}
