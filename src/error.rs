//! What can go wrong, in words for the person who can change it.

use crate::backend::gpu::{GpuError, NoGpu};
use crate::output::OutputError;
use crate::scene::Diagnostics;

/// Why a simulation does not start or go on.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene is wrong; all that was found.
    #[error("{}", .0.render(false))]
    Scene(Box<Diagnostics>),
    /// A GPU was asked for and there is none.
    #[error(transparent)]
    NoGpu(#[from] NoGpu),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Outputs could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// What was simulated is no longer physical. Outputs up to the last observation are kept.
    #[error("{0}")]
    Unstable(Box<Instability>),
    /// Options that do not go together.
    #[error("{0}")]
    Options(String),
}

/// Where and how a simulation broke down.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the simulation broke down before t = {time} s (step {step}) in body {body}: {what}. \
     Likely causes: {cause}. Outputs up to t = {good_until} s are kept"
)]
pub struct Instability {
    /// When it was noticed: it happened in one of the steps since the last check (s).
    pub time: f64,
    /// The same in steps.
    pub step: u64,
    /// The body.
    pub body: String,
    /// The first thing that went wrong, with the author's number of the element or node.
    pub what: String,
    /// What usually leads there, and what to change.
    pub cause: String,
    /// The last observation before (s).
    pub good_until: f64,
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::Scene(Box::new(diagnostics))
    }
}
