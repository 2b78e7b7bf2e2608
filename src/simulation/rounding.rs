//! Far from where a body began, displacements in f32 have too few digits left for strains.

use super::stiffness::StiffnessTracker;
use crate::components::*;
use bevy_ecs::prelude::*;

/// What rounding may make of strains before it is warned of.
const MOST_NOISE: f64 = 1e-4;
/// Half of the last digit of a number in f32, relative to it.
const HALF_DIGIT: f64 = 1.0 / (1 << 24) as f64;

/// Warns of each body, once, where displacements u in f32 are so large that rounding makes strains of u·2⁻²⁴/h, h being
/// the shortest edge. Displacements on the host must be up to date.
pub(super) fn warn_of_rounding(trackers: &[StiffnessTracker], world: &mut World) {
    for block in trackers {
        let Some((body, largest)) = largest_rounded(block, world) else { continue };
        let noise = largest * HALF_DIGIT / block.shortest_edge;
        if noise > MOST_NOISE {
            warn(body, largest, noise, world);
        }
    }
}

/// The body, and the largest component of its displacements (m); `None` in f64.
fn largest_rounded(block: &StiffnessTracker, world: &World) -> Option<(Entity, f64)> {
    let body = world.get::<Block>(block.entity)?.body;
    match &world.get::<Displacement>(body)?.0 {
        Reals::F32(u) => Some((body, f64::from(u.iter().fold(0.0_f32, |largest, u| largest.max(u.abs()))))),
        Reals::F64(_) => None,
    }
}

fn warn(body: Entity, largest: f64, noise: f64, world: &mut World) {
    let part = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
    let (time, step) = (world.resource::<Clock>().time(), world.resource::<Clock>().step);
    let mut memory = world.get_resource_or_init::<GuardMemory>();
    if memory.warnings.iter().any(|notice| notice.criterion == "rounding" && notice.part == part) {
        return;
    }
    let message = format!(
        "{part} has moved by {largest:.3e} m, where f32 rounds so coarsely that it makes strains of {noise:.1e} \
         ({MOST_NOISE:.0e} are a warning): what it feels is that uncertain; use --precision f64, or a mesh that begins near where \
         it goes"
    );
    let criterion = "rounding".to_string();
    memory.warnings.push(Notice { criterion, part, time, step, value: noise, limit: MOST_NOISE, message });
}
