//! What is attached to what.

use super::{Curve, Select};
use serde::{Deserialize, Serialize};

/// Something that holds nodes.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Attachment {
    /// A tool that takes nodes along while it is closed.
    Grasp {
        /// The tool's name.
        tool: String,
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes; all that are within `reach` when left out.
        #[serde(default)]
        on: Option<Select>,
        /// Of these, only those that are no farther from the tool's surface when it closes, or inside it (m); when left
        /// out 0, and with `on` however far.
        #[serde(default)]
        reach: Option<f64>,
        /// When it is closed: while this is ½ or more.
        closed: Curve,
        /// The force above which a node slips out (N); none when left out.
        #[serde(default)]
        strength: Option<f64>,
    },
}
