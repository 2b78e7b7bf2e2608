//! Conjugate gradients for the linear system of a Newton iteration (Hestenes & Stiefel 1952), preconditioned.

use super::preconditioner::Preconditioner;
use super::sums::Sums;
use super::vectors::{clear, combine, copy};
use crate::components::Reals;
use crate::error::Error;

/// Vectors over all axes; between solves nobody needs what is in them.
pub(super) struct Vectors {
    pub direction: Reals,
    /// A times that, and then the preconditioned residual.
    pub image: Reals,
}

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// The residual is small enough.
    Converged,
    /// So many products were allowed.
    Exhausted,
    /// The operator is not positive along a direction.
    NegativeCurvature,
    /// Forces that are no numbers.
    NotFinite,
}

/// How a solve went.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved {
    pub iterations: u64,
    pub ended: Ended,
    /// x·b.
    pub along: f64,
}

/// When a solve ends.
#[derive(Clone, Copy)]
pub(super) struct Stop {
    /// ‖b − A x‖ over ‖b‖.
    pub tolerance: f64,
    /// Products with A.
    pub most: u64,
}

/// x ≈ A⁻¹ b from x = 0; b becomes what is left, b − A x. Along a direction that A does not resist, the last x is kept;
/// where that is the first, x is the preconditioned b, which leads downhill.
pub(super) fn solve(
    sums: &Sums,
    b: &mut Reals,
    x: &mut Reals,
    Vectors { direction, image }: &mut Vectors,
    preconditioner: &mut dyn Preconditioner,
    stop: Stop,
    mut times: impl FnMut(&Reals, &mut Reals) -> Result<(), Error>,
) -> Result<Solved, Error> {
    let residual = b;
    clear(x);
    let enough = stop.tolerance * sums.norm(residual);
    preconditioner.apply(sums.cpu(), residual, direction);
    // of each direction d·b is r·z
    let (mut product, mut along) = (sums.dot(residual, direction), 0.0);
    let ended = |iterations, ended, along| Ok(Solved { iterations, ended, along });
    for iteration in 1..=stop.most {
        times(direction, image)?;
        let curvature = sums.dot(direction, image);
        if !curvature.is_finite() {
            return ended(iteration, Ended::NotFinite, along);
        }
        if curvature <= 0.0 {
            if iteration == 1 {
                copy(x, direction);
                along = product;
            }
            return ended(iteration, Ended::NegativeCurvature, along);
        }
        let length = product / curvature;
        along += length * product;
        combine(x, direction, |x, direction| x + length * direction);
        combine(residual, image, |residual, image| residual - length * image);
        let left = sums.norm(residual);
        if !left.is_finite() {
            return ended(iteration, Ended::NotFinite, along);
        }
        if left <= enough {
            return ended(iteration, Ended::Converged, along);
        }
        preconditioner.apply(sums.cpu(), residual, image);
        let next = sums.dot(residual, image);
        let turn = next / product;
        product = next;
        combine(direction, image, |direction, z| z + turn * direction);
    }
    ended(stop.most, Ended::Exhausted, along)
}
