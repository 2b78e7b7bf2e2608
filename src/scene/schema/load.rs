//! Loads: the list of those there are, and what the rest of the program knows of each kind.

use super::{Curve, PerCopy, Select};
use crate::scene::load_parts::{Amplitude, LoadParts, LoadPartsMut, On, Usual};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// All loads of scenes, in the order in which a step adds them. One line here makes a load known: to scenes, as its
/// word, to what checks, prunes, changes and documents them, and to the step, by the file of its system in `systems`,
/// which has a WGSL twin of the same stem.
///
/// `file: Word("name", what it acts on, field: type, "unit", "meaning of the field.")`, at the end what it usually is.
/// The field is what its course multiplies: a vector in space or a number.
macro_rules! each_load {
    ($then:ident) => {
        $then! {
            /// Gravity on one body, or on all.
            gravity: Gravity("gravity", Bodies, acceleration: DVec3, "m/s²", "Acceleration (m/s²).", &EARTH);
            /// A force on nodes.
            nodal_force: NodalForce("nodal force", Nodes(on "Which nodes.", share), force: DVec3, "N", "Force (N).");
            /// A pressure that follows the surface and pushes inwards.
            pressure: Pressure("pressure", Faces(on "Which faces."), pressure: f64, "Pa", "Pressure (Pa), inwards.");
            /// A dead load: force per rest area in a fixed direction.
            traction: Traction("traction", Faces(on "Which faces."), traction: DVec3, "Pa", "Force per area (Pa).");
        }
    };
}
pub(crate) use each_load;

/// From the moon's to a crash.
static EARTH: Usual = Usual { range: 0.1..=3000.0, hint: "gravity on Earth is 9.81 m/s²; 9810 would be in mm/s²" };

macro_rules! loads {
    ($($(#[$about:meta])* $file:ident: $word:ident($name:literal, $target:ident $(($on:ident $which:literal
        $(, $share:ident)?))?, $field:ident: $type:ty, $unit:literal, $means:literal $(, $usual:expr)?);)*) => {
        /// What pushes and pulls.
        #[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
        #[serde(deny_unknown_fields)]
        pub enum Load {
            $($(#[$about])* $word {
                /// The body. Left out: the only one there is; of what acts on bodies, all.
                #[serde(default)]
                body: Option<String>,
                $(#[doc = $which]
                $on: Select,)?
                #[doc = $means]
                $field: $type,
                $($(/// Whether each node gets it, or all together.
                #[serde(default)]
                $share: Share,)?)?
                /// What it is multiplied with on each of the body's copies, a vector along each axis; what acts on
                /// bodies names the body then.
                #[serde(default)]
                per_copy: Option<PerCopy>,
                /// Course in time.
                #[serde(default)]
                curve: Curve,
            },)*
        }

        /// Of each load the stem of its system's file, its word in scenes, and the fields that it must have, with what
        /// they mean.
        pub const LOADS: &[(&str, &str, &[(&str, &str)])] = &[$((
            stringify!($file),
            stringify!($word),
            &[$((stringify!($on), $which),)? (stringify!($field), $means)],
        )),*];

        impl Load {
            /// What it has in common with other kinds.
            pub fn parts(&self) -> LoadParts<'_> {
                match self {
                    $(Load::$word { body, $($on, $($share,)?)? $field, per_copy, curve } => LoadParts {
                        word: stringify!($word),
                        name: $name,
                        body: body.as_ref(),
                        on: On::$target($($on, $(*$share,)?)? per_copy.as_ref()),
                        field: (stringify!($field), $unit),
                        amplitude: $field.vector(),
                        is_vector: $field.is_vector(),
                        usual: None$(.or(Some($usual)))?,
                        curve,
                    },)*
                }
            }

            /// What of it may be written anew.
            pub fn parts_mut(&mut self) -> LoadPartsMut<'_> {
                match self {
                    $(Load::$word { body, $($on,)? $field, curve, .. } => {
                        LoadPartsMut { body, on: None$(.or(Some($on)))?, amplitude: $field, curve }
                    })*
                }
            }
        }
    };
}
each_load!(loads);

impl Load {
    /// Sets what the course multiplies.
    pub fn set_amplitude(&mut self, amplitude: DVec3) {
        self.parts_mut().amplitude.set(amplitude);
    }

    /// Whether what the course multiplies has a direction.
    pub fn is_vector(&self) -> bool {
        self.parts().is_vector
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
