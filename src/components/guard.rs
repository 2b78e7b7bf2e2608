//! What the guards remember of a run.

use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// There where nodes are inside tools or other bodies at the start: pushing them out does work on what they are in.
#[derive(Resource, Clone, Copy, Debug)]
pub struct BeginsInside;

/// What the guards, and probes that hold peaks, have seen so far; part of the state, so that what goes on from a
/// snapshot stops where it would have.
#[derive(Resource, Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GuardMemory {
    /// Checks so far.
    pub checks: u64,
    /// The step of the last of them: what looks at that state again, as who observes it and who goes on from it does,
    /// is no other check.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) checked_at: Option<u64>,
    /// Energy that rounding may have made or lost so far (J).
    pub rounding: f64,
    /// What elements held at the start (J), where bodies start deformed.
    pub at_start: f64,
    /// The first of the checks, without a sound one since, that found energy from nothing which the last half step may
    /// explain: its step. What is there [`GuardMemory::DOUBT`] steps later is an imbalance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_doubt: Option<u64>,
    /// The largest energy so far (J): what imbalances are shares of.
    pub scale: f64,
    /// The largest imbalance so far, as a share of the scale then; positive where energy was made.
    pub imbalance: f64,
    /// What the formula of implicit steps has taken so far (J); negative where it has made energy.
    #[serde(default)]
    pub(crate) scheme_loss: f64,
    /// The least that this has been (J): what a formula makes it may take again.
    #[serde(default)]
    pub(crate) least_scheme_loss: f64,
    /// What implicit steps have turned over so far (J): of each step the work of loads on free axes, that on elements
    /// there, and what damping took, whichever way they went.
    #[serde(default)]
    pub(crate) turned_over: f64,
    /// The longest step of all checks (s).
    #[serde(default)]
    pub longest_step: f64,
    /// The largest elastic energy (J) of each part so far.
    pub peaks: BTreeMap<String, f64>,
    /// The largest share of hourglass energy of each part so far.
    pub hourglass: BTreeMap<String, f64>,
    /// Of each probe that holds peaks, by name, the values of the largest size so far.
    pub probe_peaks: BTreeMap<String, Vec<f64>>,
    /// What these are of: [`Probe::of`](super::Probe::of). Those of older versions lack it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub probe_peaks_of: BTreeMap<String, String>,
    /// The smallest J of all checks.
    pub least_volume_ratio: Option<Extreme>,
    /// The fastest node of all checks (m/s).
    pub fastest_node: Option<Extreme>,
    /// What has been warned of, each once.
    pub warnings: Vec<Notice>,
}

impl GuardMemory {
    /// Steps that an imbalance must last which the last half step may explain. What is moved on at the speed that it
    /// got in one step has spent (2n − 1)² times the strain energy of half a step after n of them: of 16 that is a
    /// thousandth.
    pub const DOUBT: u64 = 16;

    /// The step of the check that an imbalance in doubt is due for.
    pub fn checks_again(&self) -> Option<u64> {
        self.in_doubt.map(|step| step + Self::DOUBT)
    }
}

/// Something that was seen, and where and when.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The body.
    pub body: String,
    /// The author's number of the node or the element.
    pub id: u64,
    /// When (s).
    pub time: f64,
}

/// What has been warned of.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Notice {
    /// The guard: `energy` or `hourglass`, `contact` for springs that make energy; `overlap` for bodies that are where
    /// others are; `contact_stiffness` for springs that have become stiffer with a shorter step; `implicit_step` for a
    /// residual that an implicit step left; `scheme_loss` for energy that their formula made.
    pub criterion: String,
    /// The part that it is about, or the two bodies; all bodies when empty.
    pub part: String,
    /// When it was seen first (s).
    pub time: f64,
    /// The same in steps.
    pub step: u64,
    /// What was seen, as a share; 1 for bodies that overlap.
    pub value: f64,
    /// The limit.
    pub limit: f64,
    /// All of it in words, and what to change.
    pub message: String,
}
