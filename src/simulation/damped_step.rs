//! What damping proportional to stiffness makes of the stable step.
//!
//! The damping stress is that of the step before the present displacements: with C = βK the recursion u⁺ − 2u + u⁻ =
//! −Δt² M⁻¹ K (u + (β/Δt)(u − u⁻)) has the characteristic polynomial z² − (2 − Ω² − bΩ²) z + 1 − bΩ², Ω = ωΔt, b =
//! β/Δt. It is stable while Ω² (1 + 2b) ≤ 4: Δt ≤ √(β² + 4/ω²) − β = (2/ω)(√(1 + ξ²) − ξ), ξ = βω/2 (the other
//! condition, bΩ² ≤ 2, is weaker).
//!
//! Of several materials xᵀ(Δt² K + 2Δt Σ β_e K_e) x ≤ 4 xᵀMx is wanted: the largest β of all is safe with a bound of
//! all of K, and elements' own bounds may take their own β, for K_e ≤ ω_e² M_e.

use super::frequency::Largest;
use crate::assembly::{damped, damping_times};
use crate::components::Block;
use bevy_ecs::prelude::*;

/// The least and the largest β of all elements (s).
fn ends_of_damping_times(world: &mut World) -> (f64, f64) {
    let blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    let times = blocks.iter().flat_map(|&block| damping_times(world, block));
    times.fold((f64::INFINITY, 0.0), |(least, most), time| (least.min(time), most.max(time)))
}

/// ω² (1/s²) that without damping would allow the step that ω² allows with it, in the most damped material.
pub(super) fn square_with_damping(square: f64, world: &mut World) -> f64 {
    damped(square, ends_of_damping_times(world).1)
}

/// The same of the largest ω² of all as far as it is known: at most by the most, at least by the least damped material.
pub(super) fn with_damping(found: Largest, world: &mut World) -> Largest {
    let (least, most) = ends_of_damping_times(world);
    Largest { at_least: damped(found.at_least, least), at_most: damped(found.at_most, most), ..found }
}

/// By how much ω² with damping may have grown when that without it has grown so many times: it grows faster, by no more
/// than the square.
pub(super) fn ratio_with_damping(ratio: f64, is_damped: bool) -> f64 {
    if is_damped { ratio.max(ratio * ratio) } else { ratio }
}

/// Whether any block is damped so.
pub(super) fn is_damped(world: &mut World) -> bool {
    ends_of_damping_times(world).1 > 0.0
}
