//! What can go wrong, in words for the person who can change it.

use crate::backend::gpu::{GpuError, NoGpu};
use crate::output::OutputError;
use crate::scene::Diagnostics;
use crate::simulation::Equilibrium;
use crate::snapshot::SnapshotError;
use std::path::{Path, PathBuf};

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
    /// The GPU failed in the middle of a run. Outputs up to the last observation are kept.
    #[error("{0}")]
    GpuFailed(Box<GpuFailure>),
    /// Outputs could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// What was simulated is no longer physical. Outputs up to the last observation are kept.
    #[error("{0}")]
    Unstable(Box<Instability>),
    /// A static analysis found no equilibrium. Outputs up to the last observation are kept.
    #[error("{0}")]
    NotConverged(Box<NotConverged>),
    /// No unloaded shape was found.
    #[error(transparent)]
    NotUnloaded(Box<NotUnloaded>),
    /// A snapshot that cannot be taken, read, or gone on from.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// Options that do not go together.
    #[error("{0}")]
    Options(String),
    /// Something that the engine itself has put in place is not there, so that the step it is in is wrong.
    #[error("a mistake of sinew's own: {0} is missing in the middle of a run; please report it with the scene")]
    Broken(&'static str),
}

/// How far a run came whose GPU failed.
#[derive(Clone, Debug, thiserror::Error)]
#[error(
    "the GPU failed after t = {good_until} s, before t = {time} s (step {step}): {reason}. Outputs up to t = {good_until} s are \
     kept. The CPU takes every scene: --backend cpu{}", from_snapshot(.snapshot)
)]
pub struct GpuFailure {
    /// What the GPU says.
    pub reason: GpuError,
    /// When it was noticed (s).
    pub time: f64,
    /// The same in steps.
    pub step: u64,
    /// The last observation before (s).
    pub good_until: f64,
    /// The snapshot that was written of the last state kept in memory, where files are written.
    pub snapshot: Option<PathBuf>,
}

fn from_snapshot(snapshot: &Option<PathBuf>) -> String {
    let tip = |file: &PathBuf| format!(", and goes on from there with --resume {}", shell_word(file));
    snapshot.as_ref().map(tip).unwrap_or_default()
}

/// Where and how a simulation broke down.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Instability {
    /// When it was noticed: it happened in one of the steps since the last check (s).
    pub time: f64,
    /// The same in steps.
    pub step: u64,
    /// The body; empty where it is none of them alone.
    pub body: String,
    /// The first thing that went wrong, with the author's number of the element or node.
    pub what: String,
    /// What usually leads there, and what to change.
    pub cause: String,
    /// The last observation before (s).
    pub good_until: f64,
    /// What ended the run, for programs.
    pub criterion: Criterion,
    /// The last state that passed all guards, where states were kept in files.
    pub last_good: Option<LastGood>,
}

/// What ended a run, for programs.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Criterion {
    /// `not_finite`, `inverted`, `energy`, `step` for a stable step that has gone to nothing, `speed` for a free tool
    /// that goes or turns too far in a step, `implicit_step` for one that was not found, with its length (s), or
    /// `result` for a result that is not finite.
    pub name: &'static str,
    /// What was found, where it is a number.
    pub value: Option<f64>,
    /// What is allowed.
    pub limit: Option<f64>,
    /// The author's number of the node.
    pub node: Option<u64>,
    /// The author's number of the element.
    pub element: Option<u64>,
}

impl Criterion {
    /// A criterion by its name.
    pub fn of(name: &'static str) -> Self {
        Self { name, ..Self::default() }
    }
}

/// The last state that passed all guards.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LastGood {
    /// When it was (s).
    pub time: f64,
    /// The same in steps.
    pub step: u64,
    /// Its snapshot in the output folder.
    pub snapshot: String,
    /// The series of the last states in the output folder.
    pub series: String,
    /// The output folder.
    pub folder: PathBuf,
}

/// A path as it can be pasted into a shell.
pub fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |letter: char| letter.is_alphanumeric() || "/._-+,:=@%".contains(letter);
    // a path that begins with a hyphen would be taken for an option
    let text = if text.starts_with('-') { format!("./{text}") } else { text };
    if !text.is_empty() && text.chars().all(plain) { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

impl std::fmt::Display for Instability {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { time, step, body, what, cause, good_until, .. } = self;
        let place = if body.is_empty() { String::new() } else { format!(" in body {body}") };
        write!(
            f,
            "the simulation broke down before t = {time} s (step {step}){place}: {what}. Likely causes: {cause}. \
             Outputs up to t = {good_until} s are kept"
        )?;
        match &self.last_good {
            None => Ok(()),
            Some(LastGood { time, snapshot, series, folder, .. }) => write!(
                f,
                "; {series} shows the last states, and the last good one, of t = {time} s, can be gone on from: --resume {}",
                shell_word(&folder.join(snapshot))
            ),
        }
    }
}

impl std::error::Error for Instability {}

/// How far a static analysis came that found no equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct NotConverged {
    /// Steps taken.
    pub steps: u64,
    /// The step since which the residual has not fallen, if that is why it was given up.
    pub stalled_at: Option<u64>,
    /// The residual and where it is largest.
    pub equilibrium: Equilibrium,
    /// Whether it is the one from which a motion was to begin (`start: Equilibrium()`).
    pub at_start: bool,
}

impl std::fmt::Display for NotConverged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Equilibrium { residual, tolerance, scale, remaining_motion, worst, setbacks, .. } = &self.equilibrium;
        let (body, node, force) = worst;
        if !self.equilibrium.not_held.is_empty() {
            return write!(
                f,
                "Newton's iterations lead to no equilibrium: loads do not balance along what nothing holds: {}. Hold it \
                 under `constraints`, or let its loads balance; `method: Relaxation` swings what can turn to where they do",
                self.equilibrium.not_held.join(", ")
            );
        }
        let (of, before) = if self.at_start { ("`start`", "the motion cannot begin: ") } else { ("the analysis", "") };
        if let Some(flies) = &self.equilibrium.flies_away {
            return write!(
                f,
                "{before}no equilibrium after {} steps: {flies}, and nothing holds it. Hold it under `constraints` or \
                 `attachments`, or by `friction`",
                self.steps
            );
        }
        write!(
            f,
            "{before}no equilibrium after {} steps: the residual is {residual:.2e} of loads and reactions ({scale:.3e} N) where \
             {tolerance:.0e} is allowed, and nodes have about {remaining_motion:.1e} of their displacements still to go. \
             The largest force that nothing balances is {force:.3e} N, at node {node} of body {body}",
            self.steps
        )?;
        if *setbacks > 0 {
            write!(f, "; steps were taken back {setbacks} times (a larger `load_steps` lets loads grow more slowly)")?;
        }
        match self.stalled_at {
            Some(step) => write!(
                f,
                ". It has not fallen since step {step}: run in f64, raise the `tolerance` of {of}, or see whether \
                 the body is held and can bear its loads"
            ),
            None => write!(f, ". Allow more `max_steps`, or raise the `tolerance` of {of}"),
        }
    }
}

impl std::error::Error for NotConverged {}

/// How near the search for an unloaded shape came, and why it ended.
#[derive(Debug, thiserror::Error)]
#[error(
    "no unloaded shape was found: after {iterations} iterations loaded nodes are {largest:.3e} m from where they should be at most, \
     where {allowed:.3e} m are allowed; {why}"
)]
pub struct NotUnloaded {
    /// Static analyses that came to an end.
    pub iterations: usize,
    /// The least that the largest distance has been (m).
    pub largest: f64,
    /// What is allowed (m).
    pub allowed: f64,
    /// Why it ended.
    pub why: String,
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::Scene(Box::new(diagnostics))
    }
}

/// Something that the engine itself has put in place is not there.
pub(crate) fn missing(what: &'static str) -> Error {
    Error::Broken(what)
}
