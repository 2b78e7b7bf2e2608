//! `traction`: dead loads on the surface. `shaders/traction.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// Adds the force per rest area, in a direction that does not follow the surface. A face of a removed element bears none.
pub fn system() -> System {
    System::built_in(
        "traction",
        Phase::Loads,
        "adds dead loads on the surface to the external forces",
        "`Traction(...)` under `loads`",
        |world| super::registry::count::<Traction>(world, "traction"),
        traction,
    )
}

fn traction(signals: Res<Signals>, loads: Query<(&Traction, &OfBody)>, mut bodies: Query<&mut ExternalForce>) {
    for (load, body) in &loads {
        let Ok(mut external) = bodies.get_mut(body.0) else { continue };
        let traction = signals.values()[load.signal];
        match &mut external.0 {
            Reals::F32(external) => pull(&load.faces, traction, external),
            Reals::F64(external) => pull(&load.faces, traction, external),
        }
    }
}

fn pull<T: Scalar>(faces: &FaceCorners, traction: [f64; 4], external: &mut [T]) {
    let traction = [0, 1, 2].map(|i| T::from_f64(traction[i]));
    for (i, &row) in faces.rows.iter().enumerate() {
        let mut area = T::default();
        for &corner in &faces.corners[faces.starts[i] as usize..faces.starts[i + 1] as usize] {
            let (face, corner) = (corner as usize / 4, corner as usize % 4);
            if faces.alive[face] == 1 {
                area += T::from_f64(faces.areas[face][corner]);
            }
        }
        for i in 0..3 {
            external[3 * row as usize + i] += traction[i] * area;
        }
    }
}
