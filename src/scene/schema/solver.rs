//! How steps in time are taken.

use serde::{Deserialize, Serialize};

/// How the motion is found from step to step.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Solver {
    /// Central differences: many cheap steps, no longer than the stable one.
    #[default]
    Explicit,
    /// Each step solves for where forces balance at its end: few steps, of any length.
    Implicit {
        /// The formula of a step.
        #[serde(default)]
        scheme: ImplicitScheme,
        /// The step (s); with `adaptive` the longest one.
        #[serde(default = "a_frame")]
        step: f64,
        /// Shorter steps where the error of one would be too large; all are alike when left out.
        #[serde(default)]
        adaptive: Option<ErrorControl>,
        /// Newton iterations of a step at most; 1 is the linearised step.
        #[serde(default = "most_iterations")]
        newton: u32,
        /// The residual at which a step is solved, as a share of the forces in it; of the linearised step that of its
        /// linear system.
        #[serde(default = "step_tolerance")]
        tolerance: f64,
        /// What conjugate gradients are preconditioned with.
        #[serde(default)]
        preconditioner: Preconditioner,
        /// Passes over all forces that a step may take; as many as it needs when left out.
        #[serde(default)]
        budget: Option<u64>,
    },
}

/// How steps are chosen by an estimate of their error.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ErrorControl {
    /// The error that the steps within one `step` of time add up to, as a share of `displacement`.
    #[serde(default = "step_tolerance")]
    pub tolerance: f64,
    /// The displacement (m) that errors are a share of, root mean square over all mass; the largest so far when left
    /// out, a hundredth of the bodies' extent at least.
    #[serde(default)]
    pub displacement: Option<f64>,
    /// The shortest step (s), which is taken whatever its error; `step`/10⁴ when left out.
    #[serde(default)]
    pub smallest: Option<f64>,
}

/// The formula of an implicit step.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ImplicitScheme {
    /// First order; damps what is faster than the step.
    #[default]
    Euler,
    /// Second order (Chung & Hulbert 1993).
    GeneralizedAlpha {
        /// What is left in a step of the amplitude of frequencies far above 1/step, from 0 to 1.
        #[serde(default = "usual_share")]
        high_frequencies: f64,
    },
}

/// An approximate inverse that makes conjugate gradients need fewer iterations.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Preconditioner {
    /// The 3×3 block of each node, and rigid motions of groups of neighbouring nodes.
    #[default]
    TwoLevel,
    /// The 3×3 block of each node.
    BlockJacobi,
    /// Masses and their damping: momentum is kept whatever the tolerance.
    Mass,
    /// None.
    Identity,
}

fn a_frame() -> f64 {
    0.01
}

fn most_iterations() -> u32 {
    20
}

fn step_tolerance() -> f64 {
    1e-3
}

fn usual_share() -> f64 {
    0.8
}
