//! Loads: what there are, and what the rest of the program knows of each kind.

use super::{Curve, PerCopy, Select};
use crate::scene::load_parts::{Amplitude, LoadParts, LoadPartsMut, On, Usual};
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
        /// What the acceleration is multiplied with in each copy of the body, which is named then.
        #[serde(default)]
        per_copy: Option<PerCopy>,
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
        /// What the force is multiplied with on each of the body's copies, along each axis.
        #[serde(default)]
        per_copy: Option<PerCopy>,
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
        /// What the pressure is multiplied with on each of the body's copies.
        #[serde(default)]
        per_copy: Option<PerCopy>,
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
        /// What the traction is multiplied with on each of the body's copies, along each axis.
        #[serde(default)]
        per_copy: Option<PerCopy>,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
}

/// From the moon's to a crash.
static GRAVITY: Usual = Usual { range: 0.1..=3000.0, hint: "gravity on Earth is 9.81 m/s²; 9810 would be in mm/s²" };

impl Load {
    /// What it has in common with other kinds.
    pub fn parts(&self) -> LoadParts<'_> {
        match self {
            Load::Gravity { body, acceleration, per_copy, curve } => LoadParts {
                word: "Gravity",
                name: "gravity",
                body: body.as_ref(),
                on: On::Bodies(per_copy.as_ref()),
                field: ("acceleration", "m/s²"),
                amplitude: *acceleration,
                usual: Some(&GRAVITY),
                curve,
            },
            Load::NodalForce { body, on, force, share, per_copy, curve } => LoadParts {
                word: "NodalForce",
                name: "nodal force",
                body: body.as_ref(),
                on: On::Nodes(on, *share, per_copy.as_ref()),
                field: ("force", "N"),
                amplitude: *force,
                usual: None,
                curve,
            },
            Load::Pressure { body, on, pressure, per_copy, curve } => LoadParts {
                word: "Pressure",
                name: "pressure",
                body: body.as_ref(),
                on: On::Faces(on, per_copy.as_ref()),
                field: ("pressure", "Pa"),
                amplitude: DVec3::X * *pressure,
                usual: None,
                curve,
            },
            Load::Traction { body, on, traction, per_copy, curve } => LoadParts {
                word: "Traction",
                name: "traction",
                body: body.as_ref(),
                on: On::Faces(on, per_copy.as_ref()),
                field: ("traction", "Pa"),
                amplitude: *traction,
                usual: None,
                curve,
            },
        }
    }

    /// What of it may be written anew.
    pub fn parts_mut(&mut self) -> LoadPartsMut<'_> {
        let (on, amplitude, curve) = match self {
            Load::Gravity { acceleration, curve, .. } => (None, Amplitude::Vector(acceleration), curve),
            Load::NodalForce { body, on, force, curve, .. } => (Some((body, on)), Amplitude::Vector(force), curve),
            Load::Pressure { body, on, pressure, curve, .. } => (Some((body, on)), Amplitude::Number(pressure), curve),
            Load::Traction { body, on, traction, curve, .. } => (Some((body, on)), Amplitude::Vector(traction), curve),
        };
        LoadPartsMut { on, amplitude, curve }
    }

    /// Sets what the course multiplies.
    pub fn set_amplitude(&mut self, amplitude: DVec3) {
        match self.parts_mut().amplitude {
            Amplitude::Vector(vector) => *vector = amplitude,
            Amplitude::Number(number) => *number = amplitude.x,
        }
    }

    /// Whether what the course multiplies has a direction.
    pub fn is_vector(&self) -> bool {
        !matches!(self, Load::Pressure { .. })
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
