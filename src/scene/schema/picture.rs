//! How a scene is drawn.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How a scene is drawn.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Picture {
    /// The field that gives the colour.
    pub field: Field,
    /// The values that the colours span, in the field's SI unit; those of the whole series when left out.
    pub range: Option<(f64, f64)>,
    /// How values of elements are shown.
    pub colours: Colours,
    /// Whether the elements' edges are drawn.
    pub edges: bool,
    /// Where the eye stands, seen from what it looks at.
    pub from: DVec3,
    /// What points up in the picture; along the line of sight y or x do instead.
    pub up: DVec3,
    /// The point (m) in the middle of the picture; the middle of all that is seen when left out.
    pub look_at: Option<DVec3>,
    /// Magnification; at 1 all that is seen in the series fits.
    pub zoom: f64,
    /// A plane that cuts the deformed bodies open.
    pub cut: Option<Cut>,
    /// Draw the shape at rest, too, faintly.
    pub ghost: bool,
    /// What can be seen through; of several that fit the last one counts.
    pub opacity: Vec<Opacity>,
    /// Whether the tools of the scene are drawn.
    pub tools: bool,
    /// Soft shadows.
    pub shadow: bool,
    /// Width and height (pixels).
    pub size: (u32, u32),
}

impl Default for Picture {
    fn default() -> Self {
        Self {
            field: Field::Displacement,
            range: None,
            colours: Colours::Smooth,
            edges: true,
            from: DVec3::new(1.0, -2.0, 0.8),
            up: DVec3::Z,
            look_at: None,
            zoom: 1.0,
            cut: None,
            ghost: false,
            opacity: Vec::new(),
            tools: true,
            shadow: true,
            size: (960, 720),
        }
    }
}

/// A field to colour by.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum Field {
    /// Length of the displacement (m).
    Displacement,
    /// Length of the velocity (m/s).
    Speed,
    /// von Mises stress (Pa).
    VonMises,
    /// Pressure, the negative mean stress (Pa).
    Pressure,
    /// Volume ratio J.
    VolumeRatio,
}

impl Field {
    /// The array's name in VTU files, or what `sinew render --field` calls it.
    pub fn array(self) -> &'static str {
        match self {
            Field::Displacement => "displacement",
            Field::Speed => "speed",
            Field::VonMises => "von_mises",
            Field::Pressure => "pressure",
            Field::VolumeRatio => "volume_ratio",
        }
    }
}

/// How values of elements are shown. Those of nodes always change linearly between them.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Colours {
    /// Averaged at nodes over the elements of one material around them, weighted by volume.
    #[default]
    Smooth,
    /// One colour an element: the values as they are.
    Elements,
}

/// A plane; what lies on the side that the normal points to is taken away, and cells that it cuts are closed.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Cut {
    /// A point on the plane (m).
    pub point: DVec3,
    /// Its normal, of any length.
    pub normal: DVec3,
}

/// How much of what lies behind a part hides.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Opacity {
    /// The body that is meant; all of them when left out.
    #[serde(default)]
    pub body: Option<String>,
    /// The material that is meant; all of them when left out.
    #[serde(default)]
    pub material: Option<String>,
    /// 0 lets everything through, 1 nothing.
    pub opacity: f64,
}
