//! What holds bodies and takes from them: constraints, courses in time, removal.

use super::{PerCopy, Select};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What holds or moves nodes.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Constraint {
    /// Nodes that do not move along the given axes.
    Fixed {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes.
        on: Select,
        /// Along which axes.
        #[serde(default = "all_axes")]
        axes: Vec<Axis>,
    },
    /// Nodes that move as told along the given axes:
    /// displacement + gradient·(X − center) + (R(rotation) − 1)(X − center), all three multiplied by the curve
    /// (of the rotation its angle).
    Prescribed {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes.
        on: Select,
        /// Along which axes.
        #[serde(default = "all_axes")]
        axes: Vec<Axis>,
        /// A common displacement (m).
        #[serde(default)]
        displacement: DVec3,
        /// Rows of a displacement gradient.
        #[serde(default)]
        gradient: [DVec3; 3],
        /// A rotation about `center`: axis times angle (degrees).
        #[serde(default)]
        rotation: DVec3,
        /// The fixed point of gradient and rotation (m).
        #[serde(default)]
        center: DVec3,
        /// What the motion is multiplied with on each of the body's copies, along each axis; not with a rotation.
        #[serde(default)]
        per_copy: Option<Box<PerCopy>>,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
}

impl Constraint {
    /// Its course in time; what is fixed has none.
    pub fn curve(&self) -> Option<&Curve> {
        match self {
            Constraint::Fixed { .. } => None,
            Constraint::Prescribed { curve, .. } => Some(curve),
        }
    }
}

/// A factor over time; what it multiplies is said where it is used.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Curve {
    /// 1 from `start` until `end`, else 0 (s).
    Step {
        /// First instant (s).
        #[serde(default)]
        start: f64,
        /// From then on 0 again (s).
        #[serde(default)]
        end: Option<f64>,
    },
    /// A straight line from 0 at `start` to 1 at `end`, held after (s).
    Ramp {
        /// 0 until then (s).
        #[serde(default)]
        start: f64,
        /// 1 from then on (s).
        end: f64,
    },
    /// As `Ramp`, by the 3-4-5 polynomial 10s³ − 15s⁴ + 6s⁵: no jump of velocity or acceleration.
    Smooth {
        /// 0 until then (s).
        #[serde(default)]
        start: f64,
        /// 1 from then on (s).
        end: f64,
    },
    /// Straight lines through (time (s), factor), held before the first and after the last.
    Table(Vec<(f64, f64)>),
    /// What a program sets while it runs. The same name in several places is one input.
    Input {
        /// What the program calls it.
        name: String,
        /// The factor until the program sets another.
        #[serde(default)]
        initial: f64,
        /// By how much the factor changes in a second at most (1/s); left out: at once.
        #[serde(default)]
        rate: Option<f64>,
    },
}

impl Default for Curve {
    fn default() -> Self {
        Curve::Step { start: 0.0, end: None }
    }
}

/// Elements to be removed.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Removal {
    /// The body; may be left out when there is one only.
    #[serde(default)]
    pub body: Option<String>,
    /// Which elements may go.
    #[serde(default = "everything")]
    pub on: Select,
    /// When they go.
    pub when: When,
}

/// When elements are removed.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum When {
    /// All at one time (s).
    At(f64),
    /// One after the other between two times (s), those nearest to the selection's centroid first.
    During {
        /// The first goes (s).
        start: f64,
        /// The last has gone (s).
        end: f64,
    },
    /// Each as soon as its largest principal stretch exceeds this.
    StretchAbove(f64),
    /// Each as soon as its volume ratio J falls below this.
    VolumeRatioBelow(f64),
    /// Each as soon as its volume ratio J exceeds this.
    VolumeRatioAbove(f64),
    /// Each as soon as its strain energy per rest volume exceeds this (J/m³).
    EnergyDensityAbove(f64),
    /// As a tool takes them: by a `rate`, one after the other, or what passes a `threshold`.
    InTool {
        /// The tool.
        tool: String,
        /// How far from its mouth an element's centroid may be (m).
        reach: f64,
        /// The volume that the tool takes in a second (m³/s), by rest volume, while there is something in its reach,
        /// the nearest first.
        #[serde(default)]
        rate: Option<f64>,
        /// In place of a rate: what elements in reach pass that go.
        #[serde(default)]
        threshold: Option<Threshold>,
        /// Radius of the mouth (m), a disc about the tool's origin; a tube's `inner` when left out, and all round tools
        /// of other shapes.
        #[serde(default)]
        bore: Option<f64>,
        /// Elements that go at most at a time.
        #[serde(default = "sixty_four")]
        burst: u32,
        /// Course of the rate in time; what passes a threshold goes while it is above 0.
        #[serde(default)]
        curve: Curve,
        /// The volume at rest (m³) below which an island that is cut off and in reach goes at once; 4 mean elements of
        /// the body when left out, 0: none.
        #[serde(default)]
        crumb: Option<f64>,
    },
}

/// What elements in a tool's reach pass that go.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Threshold {
    /// Their largest principal stretch exceeds this.
    StretchAbove(f64),
    /// Their strain energy per rest volume exceeds this (J/m³).
    EnergyDensityAbove(f64),
}

fn sixty_four() -> u32 {
    64
}

impl When {
    /// The tool that takes the elements, if one does.
    pub fn tool(&self) -> Option<&String> {
        match self {
            Self::InTool { tool, .. } => Some(tool),
            _ => None,
        }
    }
}

fn all_axes() -> Vec<Axis> {
    vec![Axis::X, Axis::Y, Axis::Z]
}

fn everything() -> Select {
    Select::All
}
