//! `boundary`: where constrained nodes go in this step. `shaders/boundary.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// Prescribed nodes: u(t + Δt) = A·(X − center) + b. The step that leads there is written to [`DisplacementStep`] on the
/// constrained axes, and `integrate` adds it as it adds all others. Fixed axes have a step of 0 from the start and need no
/// work.
pub fn system() -> System {
    System::built_in(
        "boundary",
        Phase::Boundary,
        "says where fixed and prescribed nodes go",
        "`Fixed(...)` or `Prescribed(...)` under `constraints`",
        |world| {
            let fixed = super::registry::count::<Fixed>(world, "fixed set");
            let prescribed = super::registry::count::<Prescribed>(world, "prescribed set");
            match (fixed, prescribed) {
                (Some(f), Some(p)) => Some(format!("{f}, {p}")),
                (some, None) | (None, some) => some,
            }
        },
        boundary,
    )
}

fn boundary(
    signals: Res<Signals>,
    constraints: Query<(&Prescribed, &OfBody)>,
    mut bodies: Query<(&Displacement, Option<&DisplacementCompensation>, &mut DisplacementStep)>,
) {
    for (prescribed, body) in &constraints {
        let Ok((displacement, compensation, mut step)) = bodies.get_mut(body.0) else { continue };
        let rows = &signals.values()[prescribed.signal..prescribed.signal + 3];
        match &mut step.0 {
            Reals::F32(step) => {
                move_rows(prescribed, rows, displacement.slice(), compensation.map(|c| c.slice()), step)
            }
            Reals::F64(step) => {
                move_rows(prescribed, rows, displacement.slice(), compensation.map(|c| c.slice()), step)
            }
        }
    }
}

fn move_rows<T: Scalar>(
    prescribed: &Prescribed,
    motion: &[[f64; 4]],
    displacement: &[T],
    compensation: Option<&[T]>,
    step: &mut [T],
) {
    for (&row, arm) in prescribed.rows.iter().zip(&prescribed.arms) {
        for axis in (0..3).filter(|axis| prescribed.axes >> axis & 1 == 1) {
            let [x, y, z, shift] = motion[axis];
            let place = 3 * row as usize + axis;
            let target = T::from_f64(x * arm.x + y * arm.y + z * arm.z + shift);
            let lost = compensation.map_or(T::default(), |c| c[place]);
            step[place] = (target - displacement[place]) + lost;
        }
    }
}
