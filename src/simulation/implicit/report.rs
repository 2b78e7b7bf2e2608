//! What implicit steps took.

use serde::{Deserialize, Serialize};

/// What implicit steps have taken since the simulation was made or went on from a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImplicitSteps {
    /// Steps; in a static analysis attempts to find equilibrium.
    pub steps: u64,
    /// Steps that were taken back for a shorter one, since their error was too large or they were not found.
    pub steps_rejected: u64,
    /// The shortest step (s); 0 in a static analysis.
    pub smallest_step: f64,
    /// The longest step (s); 0 in a static analysis.
    pub largest_step: f64,
    /// Passes over all forces: for residuals, for products and for what steps keep.
    pub passes: u64,
    /// Newton iterations: linear systems that were solved.
    pub newton_iterations: u64,
    /// Iterations of conjugate gradients.
    pub linear_iterations: u64,
    /// How often a step of Newton's was halved.
    pub halvings: u64,
    /// Linear solves that met a direction along which the bodies do not resist.
    pub negative_curvatures: u64,
    /// Passes of the costliest step.
    pub most_passes: u64,
    /// Steps that ended above the tolerance.
    pub unsolved: u64,
    /// The largest residual that a step above the tolerance left, as a share of the one that it began with.
    pub largest_residual_left: f64,
    /// Bytes of what conjugate gradients are preconditioned with, coarse matrices with it.
    pub preconditioner_bytes: u64,
}

impl ImplicitSteps {
    /// Notes the length of a step (s).
    pub(super) fn note_length(&mut self, length: f64) {
        self.smallest_step = if self.largest_step > 0.0 { self.smallest_step.min(length) } else { length };
        self.largest_step = self.largest_step.max(length);
    }
}
