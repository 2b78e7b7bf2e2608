//! What is sought: motion, or equilibrium.

use serde::{Deserialize, Serialize};

/// What is sought.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Analysis {
    /// Motion over time.
    #[default]
    Transient,
    /// Equilibrium under loads and motions as their curves stand at `duration`, or at another time.
    Static(EquilibriumSearch),
}

/// How bodies stand when the motion begins.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum InitialState {
    /// As each body's own `start` says: undeformed where it says nothing.
    #[default]
    Undeformed,
    /// At rest under loads and motions as their curves stand at t = 0, found by a static analysis before the first
    /// step.
    Equilibrium(EquilibriumSearch),
}

/// How an equilibrium is sought.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct EquilibriumSearch {
    /// By what.
    pub method: SearchMethod,
    /// The residual that is small enough, as a share of loads and reactions; left out: 1e-6 in f64 and 1e-5 in f32, and
    /// of Newton's iterations 1e-10 in f64.
    pub tolerance: Option<f64>,
    /// Pseudo-steps after which the search is given up.
    pub max_steps: u64,
    /// Pseudo-steps over which loads and motions grow; found from the mesh when left out.
    pub load_steps: Option<u64>,
    /// The time whose loads and motions act (s); `duration` when left out, and 0 at the start of a motion.
    pub at: Option<f64>,
    /// Newton's iterations go along the path of equilibria that leads there, through limit points.
    pub arc: Option<ArcLength>,
}

impl Default for EquilibriumSearch {
    fn default() -> Self {
        Self {
            method: SearchMethod::default(),
            tolerance: None,
            max_steps: 200_000,
            load_steps: None,
            at: None,
            arc: None,
        }
    }
}

/// How a path of equilibria is followed from no load to all of it, by arc length.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct ArcLength {
    /// The share of all loads that the first step is to reach.
    pub first: f64,
    /// How far nodes may go in a step (m), root mean square; as far as iterations lead when left out.
    pub longest: Option<f64>,
    /// Points of the path at most, wherever it has led by then.
    pub points: u32,
}

impl Default for ArcLength {
    fn default() -> Self {
        Self { first: 0.1, longest: None, points: 200 }
    }
}

/// What leads to equilibrium.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum SearchMethod {
    /// Damped pseudo-steps.
    #[default]
    Relaxation,
    /// Newton's iterations, and where they do not arrive pseudo-steps that they begin again from.
    Newton,
}
