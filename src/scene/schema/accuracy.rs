//! What `sinew accuracy` measures a scene against.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What `sinew accuracy` measures a scene against, and by what.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Accuracy {
    /// What errors are measured against.
    pub reference: AccuracyReference,
    /// How far `Values` and tables of `Files` may themselves be off, by quantity (in its SI unit); 0 for those left
    /// out.
    pub uncertainty: BTreeMap<String, f64>,
    /// The quantity that configurations are judged by; left out: the displacement field, or the first that has a
    /// reference.
    pub judged_by: Option<String>,
    /// The error that is good enough, relative; 0.01 when left out.
    pub target: Option<f64>,
}

/// What errors are measured against.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum AccuracyReference {
    /// A solution made for it: the best element, three meshes, f64, a quarter of the step, extrapolated.
    #[default]
    SelfMade,
    /// Exact values of quantities, by name (SI units).
    Values(BTreeMap<String, f64>),
    /// Tables of an earlier run, relative to the scene file: `probe_NAME.csv`, `nodes.csv`, or the folder of all of
    /// them.
    Files(Vec<String>),
}
