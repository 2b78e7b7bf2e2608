//! What is attached to what.

use super::{Curve, Select};
use crate::tools::Shape;
use glam::DVec3;
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
    /// A thread between two points: a spring that pulls and does not push.
    Suture {
        /// Its name in probes and reports; its place in the list, counted from 0, when left out.
        #[serde(default)]
        name: Option<String>,
        /// One end.
        from: Point,
        /// The other.
        to: Point,
        /// Stiffness (N/m).
        stiffness: f64,
        /// Its length without tension (m); how far the points are apart at the start when left out.
        #[serde(default)]
        length: Option<f64>,
        /// By how much knots shorten that (m), times the curve.
        #[serde(default)]
        tighten: f64,
        /// Course of the knots in time.
        #[serde(default)]
        curve: Curve,
        /// The tension at which it tears (N); none when left out.
        #[serde(default)]
        strength: Option<f64>,
    },
    /// A point that stays where it is on a face.
    Tie {
        /// Its name in probes and reports; its place in the list, counted from 0, when left out.
        #[serde(default)]
        name: Option<String>,
        /// The point.
        from: Point,
        /// Where on the surface of a body.
        to: Point,
        /// The force at which it breaks (N); none when left out.
        #[serde(default)]
        strength: Option<f64>,
    },
    /// A surface that sticks to another where it is near that at the start.
    Glue {
        /// Its name in probes and reports; its place in the list, counted from 0, when left out.
        #[serde(default)]
        name: Option<String>,
        /// The body whose nodes stick, and that to whose faces.
        bodies: (String, String),
        /// Faces of the first body; its whole surface when left out.
        #[serde(default = "surface")]
        on: Select,
        /// Faces of the second; its whole surface when left out.
        #[serde(default = "surface")]
        onto: Select,
        /// How far apart they may be at the start (m); a tenth of an edge when left out.
        #[serde(default)]
        reach: Option<f64>,
        /// The stress at which it is pulled off (Pa); none when left out.
        #[serde(default)]
        normal: Option<f64>,
        /// The stress at which it is sheared off (Pa); none when left out.
        #[serde(default)]
        shear: Option<f64>,
        /// How often forces are corrected in a step.
        #[serde(default = "four_sweeps")]
        sweeps: u32,
    },
}

/// A point of a body.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// The body; may be left out when there is one only.
    #[serde(default)]
    pub body: Option<String>,
    /// Where it is (m) in the shape of the body's `mesh`, whatever its `rest_shape`: in the body, or no farther from
    /// its surface than an edge of a face.
    pub at: DVec3,
}

fn surface() -> Select {
    Select::Surface { normal: None, within: 30.0 }
}

fn four_sweeps() -> u32 {
    4
}

impl Attachment {
    /// The tool that holds, if one does.
    pub fn tool(&self) -> Option<&String> {
        if let Self::Grasp { tool, .. } = self { Some(tool) } else { None }
    }

    /// Its name, given the place in the list; grasps are the tool's.
    pub fn name(&self, number: usize) -> Option<String> {
        match self {
            Self::Grasp { .. } => None,
            Self::Suture { name, .. } | Self::Tie { name, .. } | Self::Glue { name, .. } => {
                Some(name.clone().unwrap_or_else(|| number.to_string()))
            }
        }
    }

    /// What is selected, and the word for it.
    pub fn selections(&self) -> Vec<(&'static str, &Select)> {
        match self {
            Self::Grasp { on, .. } => on.iter().map(|on| ("on", on)).collect(),
            Self::Glue { on, onto, .. } => vec![("on", on), ("onto", onto)],
            Self::Suture { .. } | Self::Tie { .. } => Vec::new(),
        }
    }

    /// Its course in time, and the word for it.
    pub fn curve(&self) -> Option<(&'static str, &Curve)> {
        match self {
            Self::Grasp { closed, .. } => Some(("closed", closed)),
            Self::Suture { curve, .. } => Some(("curve", curve)),
            Self::Tie { .. } | Self::Glue { .. } => None,
        }
    }

    /// Whether it may hold a body.
    pub fn holds(&self, name: &str) -> bool {
        let is = |body: &Option<String>| body.as_ref().is_none_or(|body| body == name);
        match self {
            Self::Grasp { body, .. } => is(body),
            Self::Suture { from, to, .. } | Self::Tie { from, to, .. } => is(&from.body) || is(&to.body),
            Self::Glue { bodies: (a, b), .. } => a == name || b == name,
        }
    }
}
