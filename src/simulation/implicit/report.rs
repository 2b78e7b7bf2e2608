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
    /// How long the longest step took (s).
    pub longest_step: f64,
    /// How long 99 of 100 steps took at most (s), to 4 %.
    pub step_percentile_99: f64,
}

impl ImplicitSteps {
    /// Notes the length of a step (s).
    pub(super) fn note_length(&mut self, length: f64) {
        self.smallest_step = if self.largest_step > 0.0 { self.smallest_step.min(length) } else { length };
        self.largest_step = self.largest_step.max(length);
    }
}

/// Parts of an octave, and the shortest time that is told from others (s).
const OF_AN_OCTAVE: f64 = 16.0;
const SHORTEST: f64 = 1e-6;
/// Octaves, up to an hour.
const OCTAVES: usize = 32;

/// How often steps took how long, by parts of octaves.
pub(super) struct Durations([u32; OCTAVES * OF_AN_OCTAVE as usize]);

impl Default for Durations {
    fn default() -> Self {
        Self([0; OCTAVES * OF_AN_OCTAVE as usize])
    }
}

impl Durations {
    /// Counts a step of so many seconds.
    pub fn count(&mut self, seconds: f64) {
        let place = (OF_AN_OCTAVE * (seconds / SHORTEST).log2()).max(0.0) as usize;
        self.0[place.min(self.0.len() - 1)] += 1;
    }

    /// What 99 of 100 took at most (s).
    pub fn of_most(&self) -> f64 {
        let all: u64 = self.0.iter().map(|&count| u64::from(count)).sum();
        let mut longer = all;
        let place = self.0.iter().position(|&count| {
            longer -= u64::from(count);
            100 * longer <= all
        });
        SHORTEST * ((place.unwrap_or(0) + 1) as f64 / OF_AN_OCTAVE).exp2()
    }
}

#[cfg(test)]
mod tests;
