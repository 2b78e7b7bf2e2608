//! What is attached to what.

use super::{Curve, Select};
use crate::tools::Shape;
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
        /// Which nodes; all that are in the jaws when left out.
        #[serde(default)]
        on: Option<Select>,
        /// What is between the jaws, in the tool's frame; the tool's own shape when left out.
        #[serde(default)]
        jaws: Option<Shape>,
        /// How far from the jaws a node may be when they close (m); when left out 0, and with `on` alone however far.
        #[serde(default)]
        reach: Option<f64>,
        /// When it is closed: while this is ½ or more.
        closed: Curve,
        /// The force above which a node slips out (N); none when left out.
        #[serde(default)]
        strength: Option<f64>,
    },
}

impl Attachment {
    /// The tool that holds, if one does.
    pub fn tool(&self) -> Option<&String> {
        let Self::Grasp { tool, .. } = self;
        Some(tool)
    }

    /// The nodes that may be held, where they are selected.
    pub fn on(&self) -> Option<&Select> {
        let Self::Grasp { on, .. } = self;
        on.as_ref()
    }

    /// Its course in time, and the word for it.
    pub fn curve(&self) -> Option<(&'static str, &Curve)> {
        let Self::Grasp { closed, .. } = self;
        Some(("closed", closed))
    }

    /// Whether it may hold a body.
    pub fn holds(&self, name: &str) -> bool {
        let Self::Grasp { body, .. } = self;
        body.as_ref().is_none_or(|body| body == name)
    }
}
