//! Loads: what there are, and what the rest of the program knows of each kind.

use super::{Curve, Select};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What pushes and pulls.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Load {
    /// Gravity on one body, or on all.
    Gravity {
        /// The body; left out: all.
        #[serde(default)]
        body: Option<String>,
        /// Acceleration (m/s²).
        acceleration: DVec3,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
    /// A force on nodes.
    NodalForce {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes.
        on: Select,
        /// Force (N).
        force: DVec3,
        /// Whether each node gets the force, or all together.
        #[serde(default)]
        share: Share,
        /// What the force is multiplied with on the first and on the last of the body's copies; on those between
        /// evenly.
        #[serde(default)]
        per_copy: Option<(f64, f64)>,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
    /// A pressure that follows the surface and pushes inwards.
    Pressure {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which faces of the surface.
        on: Select,
        /// Pressure (Pa), positive inwards.
        pressure: f64,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
    /// A dead load: force per rest area in a fixed direction.
    Traction {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which faces of the surface.
        on: Select,
        /// Force per rest area (Pa).
        traction: DVec3,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
}

/// What all loads have, whatever their kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadParts<'a> {
    /// What it is called in words.
    pub name: &'static str,
    /// The body; none: the only one, or all if it acts on all.
    pub body: Option<&'a String>,
    /// What it acts on; none: the whole body, or all bodies where it names none.
    pub on: Option<&'a Select>,
    /// The field with what the course multiplies, and its unit.
    pub field: (&'static str, &'static str),
    /// What the course multiplies, in that unit; of a number the first of three.
    pub amplitude: DVec3,
    /// Its course in time.
    pub curve: &'a Curve,
}

impl Load {
    /// What it has in common with other kinds.
    pub fn parts(&self) -> LoadParts<'_> {
        let parts = |name, body, on, field, amplitude, curve| LoadParts { name, body, on, field, amplitude, curve };
        match self {
            Load::Gravity { body, acceleration, curve } => {
                parts("gravity", body.as_ref(), None, ("acceleration", "m/s²"), *acceleration, curve)
            }
            Load::NodalForce { body, on, force, curve, .. } => {
                parts("nodal force", body.as_ref(), Some(on), ("force", "N"), *force, curve)
            }
            Load::Pressure { body, on, pressure, curve } => {
                parts("pressure", body.as_ref(), Some(on), ("pressure", "Pa"), DVec3::X * *pressure, curve)
            }
            Load::Traction { body, on, traction, curve } => {
                parts("traction", body.as_ref(), Some(on), ("traction", "Pa"), *traction, curve)
            }
        }
    }

    /// Sets what the course multiplies.
    pub fn set_amplitude(&mut self, amplitude: DVec3) {
        match self {
            Load::Gravity { acceleration: vector, .. }
            | Load::NodalForce { force: vector, .. }
            | Load::Traction { traction: vector, .. } => *vector = amplitude,
            Load::Pressure { pressure, .. } => *pressure = amplitude.x,
        }
    }

    /// Its course in time.
    pub fn curve(&self) -> &Curve {
        self.parts().curve
    }

    /// What the course multiplies: an acceleration (m/s²), a force (N), a pressure (Pa, in the first number), a
    /// traction (Pa).
    pub fn amplitude(&self) -> DVec3 {
        self.parts().amplitude
    }
}

/// How a force is shared among nodes.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Share {
    /// Each node gets it.
    #[default]
    Each,
    /// All nodes together get it, in equal parts.
    Total,
}
