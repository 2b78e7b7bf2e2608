//! Shapes of tools as scenes say them.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The shape of a rigid tool in its own frame. Long shapes have their tip at the origin and reach along z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// All that is below z = 0.
    Plane {},
    /// A ball about the origin.
    Sphere {
        /// Radius (m).
        radius: f64,
    },
    /// A box about the origin, its edges along x, y and z.
    Box {
        /// Lengths of its edges (m).
        size: DVec3,
    },
    /// A cylinder with ends that are half balls, from z = 0 to z = length, these included.
    Capsule {
        /// Length over all (m), at least twice the radius.
        length: f64,
        /// Radius (m).
        radius: f64,
    },
    /// A cylinder from z = 0 to z = length.
    Cylinder {
        /// Length (m).
        length: f64,
        /// Radius (m).
        radius: f64,
    },
    /// A cone or a frustum from z = 0 to z = length.
    Cone {
        /// Length (m).
        length: f64,
        /// Radius at z = 0 (m); 0 is a point.
        tip: f64,
        /// Radius at z = length (m); 0 is a point.
        base: f64,
    },
    /// A tube from z = 0 to z = length.
    Tube {
        /// Length (m).
        length: f64,
        /// Radius of the bore (m).
        inner: f64,
        /// Radius of the outside (m).
        outer: f64,
        /// Angle by which the cut at the tip is off a square one (degrees, 0 to 80). The foremost point of a bevelled
        /// tip is at x = outer, z = 0, the hindmost at x = -outer.
        #[serde(default)]
        bevel: f64,
    },
}

impl Shape {
    /// The same shape so many times as large.
    pub fn scaled(&self, by: f64) -> Self {
        match *self {
            Self::Plane {} => Self::Plane {},
            Self::Sphere { radius } => Self::Sphere { radius: by * radius },
            Self::Box { size } => Self::Box { size: by * size },
            Self::Capsule { length, radius } => Self::Capsule { length: by * length, radius: by * radius },
            Self::Cylinder { length, radius } => Self::Cylinder { length: by * length, radius: by * radius },
            Self::Cone { length, tip, base } => Self::Cone { length: by * length, tip: by * tip, base: by * base },
            Self::Tube { length, inner, outer, bevel } => {
                Self::Tube { length: by * length, inner: by * inner, outer: by * outer, bevel }
            }
        }
    }
}
