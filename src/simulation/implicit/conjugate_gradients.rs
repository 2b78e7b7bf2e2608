//! Conjugate gradients for the linear system of a Newton iteration (Hestenes & Stiefel 1952), preconditioned.

use super::preconditioner::Preconditioner;
use super::sums::Sums;
use crate::error::Error;

/// Vectors over all axes.
#[derive(Default)]
pub(super) struct Vectors {
    residual: Vec<f64>,
    preconditioned: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
}

impl Vectors {
    /// Of so many axes.
    pub fn resize(&mut self, length: usize) {
        let Self { residual, preconditioned, direction, image } = self;
        for vector in [residual, preconditioned, direction, image] {
            vector.resize(length, 0.0);
        }
    }

    /// Their bytes.
    pub fn bytes(&self) -> usize {
        let Self { residual, preconditioned, direction, image } = self;
        [residual, preconditioned, direction, image].into_iter().map(|vector| size_of_val(&vector[..])).sum()
    }
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
}

/// When a solve ends.
#[derive(Clone, Copy)]
pub(super) struct Stop {
    /// ‖b − A x‖ over ‖b‖.
    pub tolerance: f64,
    /// Products with A.
    pub most: u64,
}

/// x ≈ A⁻¹ b from x = 0. Along a direction that A does not resist, the last x is kept; where that is the first, x is
/// the preconditioned b, which leads downhill.
pub(super) fn solve(
    sums: &Sums,
    b: &[f64],
    x: &mut [f64],
    vectors: &mut Vectors,
    preconditioner: &mut dyn Preconditioner,
    stop: Stop,
    mut times: impl FnMut(&[f64], &mut [f64]) -> Result<(), Error>,
) -> Result<Solved, Error> {
    vectors.resize(b.len());
    let Vectors { residual, preconditioned, direction, image } = vectors;
    x.fill(0.0);
    residual.copy_from_slice(b);
    let enough = stop.tolerance * sums.norm(b);
    preconditioner.apply(sums.cpu(), residual, preconditioned);
    direction.copy_from_slice(preconditioned);
    let mut product = sums.dot(residual, preconditioned);
    let ended = |iterations, ended| Ok(Solved { iterations, ended });
    for iteration in 0..stop.most {
        times(direction, image)?;
        let curvature = sums.dot(direction, image);
        if !curvature.is_finite() {
            return ended(iteration + 1, Ended::NotFinite);
        }
        if curvature <= 0.0 {
            if iteration == 0 {
                x.copy_from_slice(preconditioned);
            }
            return ended(iteration + 1, Ended::NegativeCurvature);
        }
        let length = product / curvature;
        x.iter_mut().zip(&*direction).for_each(|(x, direction)| *x += length * direction);
        residual.iter_mut().zip(&*image).for_each(|(residual, image)| *residual -= length * image);
        let left = sums.norm(residual);
        if !left.is_finite() {
            return ended(iteration + 1, Ended::NotFinite);
        }
        if left <= enough {
            return ended(iteration + 1, Ended::Converged);
        }
        preconditioner.apply(sums.cpu(), residual, preconditioned);
        let next = sums.dot(residual, preconditioned);
        let turn = next / product;
        product = next;
        for (direction, z) in direction.iter_mut().zip(preconditioned.iter()) {
            *direction = z + turn * *direction;
        }
    }
    ended(stop.most, Ended::Exhausted)
}
