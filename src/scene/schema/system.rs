//! Systems of the scene's own.

use super::{Curve, Select};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A load of your own: a WGSL file with a function that gives the force on a node, and the parameters it needs.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OwnSystem {
    /// The file (.wgsl), its path relative to the scene file.
    pub file: String,
    /// A number for each member of the struct of `var<uniform> parameters`, by name.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
    /// The body; left out: all.
    #[serde(default)]
    pub body: Option<String>,
    /// Which nodes; left out: all.
    #[serde(default = "all")]
    pub on: Select,
    /// Course in time, which the function finds as `node.curve`.
    #[serde(default)]
    pub curve: Curve,
}

fn all() -> Select {
    Select::All
}
