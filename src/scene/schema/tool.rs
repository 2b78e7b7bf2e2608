//! Rigid tools, and what they touch.

use super::{Curve, Select};
use crate::scene::limits::MOST_TURNS;
use crate::tools::Shape;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A rigid tool: its shape, where it is, how it moves.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Its shape, in its own frame; left out where it has a `mesh`.
    #[serde(default)]
    pub shape: Option<Shape>,
    /// A closed surface of triangles, in its own frame; left out where it has a `shape`.
    #[serde(default)]
    pub mesh: Option<ToolMesh>,
    /// Radius (m) by which its edges are rounded off.
    #[serde(default)]
    pub rounding: f64,
    /// Where its origin is (m): the tip of what is long, the middle of a ball and of a box. Not with a `path`.
    #[serde(default)]
    pub at: Option<DVec3>,
    /// How it is turned: axis times angle (degrees). Not with a `path`.
    #[serde(default)]
    pub rotation: Option<DVec3>,
    /// Places on its way, in the order of time; straight and evenly turned between them, at rest before the first and
    /// after the last. About the axis of two of them it turns as far as they say, else by the shorter way round.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<ToolPlace>,
    /// What is added to that, each by a curve of its own.
    #[serde(default)]
    pub moves: Vec<ToolMove>,
    /// A point (m) that its axis z goes through wherever it is, as a shaft goes through a trocar: it turns about that
    /// point. Not with a `port`.
    #[serde(default)]
    pub pivot: Option<DVec3>,
    /// The device of a hand that moves it from where it is at first. Not with a `path` or `moves`.
    #[serde(default)]
    pub port: Option<Port>,
    /// That it moves freely as a rigid body, pushed by what it touches and drawn by gravity, from where `at` and
    /// `rotation` put it. Not with a `path`, `moves`, `pivot` or `port`.
    #[serde(default)]
    pub free: Option<Free>,
}

/// How a tool moves that nobody guides.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Free {
    /// Its mass (kg); left out where it has a `density`.
    #[serde(default)]
    pub mass: Option<f64>,
    /// The density (kg/m³) of what fills it; left out where it has a `mass`.
    #[serde(default)]
    pub density: Option<f64>,
    /// Moments of inertia (kg m²) about its centre of mass, along its own axes; those of an evenly filled shape when
    /// left out.
    #[serde(default)]
    pub inertia: Option<DVec3>,
    /// Velocity of its centre of mass at the start (m/s).
    #[serde(default)]
    pub velocity: DVec3,
    /// How it turns at the start: axis times speed (degrees a second).
    #[serde(default)]
    pub spin: DVec3,
    /// Damping of its motion (1/s), as that of a material.
    #[serde(default)]
    pub damping: f64,
}

/// The port of a device that a hand holds, and how the tool follows it.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Port {
    /// Its name, by which a program opens it.
    pub name: String,
    /// How fast the tool goes at most (m/s).
    pub speed: f64,
    /// How fast it turns at most (degrees a second).
    #[serde(default = "a_turn")]
    pub spin: f64,
    /// Time between two readings of the device (s): a batch of steps.
    #[serde(default = "a_millisecond")]
    pub every: f64,
    /// Where the tool goes.
    #[serde(default)]
    pub follow: Follow,
}

fn a_turn() -> f64 {
    360.0
}

fn a_millisecond() -> f64 {
    1e-3
}

/// How a tool follows a device.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Follow {
    /// It goes where the device is.
    #[default]
    Position,
    /// It is drawn there by a spring, without a mass, and yields to what it touches; it is turned as the device is.
    Proxy {
        /// Stiffness of the spring (N/m).
        stiffness: f64,
        /// Damping of its own motion (N s/m).
        #[serde(default)]
        damping: f64,
    },
}

/// A closed surface of triangles as a tool.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ToolMesh {
    /// The file (STL, OBJ or PLY), its path relative to the scene file.
    pub path: String,
    /// What its coordinates are multiplied with: 0.001 where they are in mm.
    #[serde(default = "one")]
    pub scale: f64,
    /// Distance between the places at which its distance is known (m); when left out what 64³ places allow, at most a
    /// 59th of its longest side.
    #[serde(default)]
    pub spacing: Option<f64>,
}

fn one() -> f64 {
    1.0
}

/// A place on a tool's way.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ToolPlace {
    /// When (s).
    pub t: f64,
    /// Where its origin is (m).
    pub at: DVec3,
    /// How it is turned: axis times angle (degrees).
    #[serde(default)]
    pub rotation: DVec3,
}

/// A motion of a tool: by displacement and rotation, both multiplied by the curve.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ToolMove {
    /// By how much it goes (m).
    #[serde(default)]
    pub displacement: DVec3,
    /// By how much it turns about its origin: axis times angle (degrees), the axis along the scene's axes.
    #[serde(default)]
    pub rotation: DVec3,
    /// Course in time.
    #[serde(default)]
    pub curve: Curve,
}

/// What touches what.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Contact {
    /// A tool and nodes of a body: these stay outside the tool.
    Tool {
        /// The tool's name.
        tool: String,
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes; those of the whole surface when left out.
        #[serde(default = "surface")]
        on: Select,
        /// The coefficient of friction.
        #[serde(default)]
        friction: f64,
        /// The coefficient while nodes stick to the tool, or come to touch it without slipping; that of `friction` when
        /// left out.
        #[serde(default)]
        static_friction: Option<f64>,
        /// That the tool is thinner than the faces that it meets, and may slip between nodes: then it is not warned of.
        #[serde(default)]
        thin: bool,
        /// What keeps nodes out.
        #[serde(default)]
        law: ContactLaw,
    },
    /// The surfaces of two bodies: each stays outside the other.
    Between {
        /// Their names.
        bodies: (String, String),
        /// The coefficient of friction.
        #[serde(default)]
        friction: f64,
        /// The coefficient while points stick; that of `friction` when left out.
        #[serde(default)]
        static_friction: Option<f64>,
        /// How far the surfaces stay apart (m).
        #[serde(default)]
        thickness: f64,
        /// How often forces are corrected in a step.
        #[serde(default = "one_sweep")]
        sweeps: u32,
        /// Which points of each surface stay outside the other.
        #[serde(default)]
        points: Points,
        /// That edges which cross stay outside of each other, too.
        #[serde(default)]
        edges: bool,
        /// What keeps points out.
        #[serde(default)]
        law: ContactLaw,
    },
    /// The surface of a body and itself: folds and copies stay outside of each other.
    Itself {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// The coefficient of friction.
        #[serde(default)]
        friction: f64,
        /// The coefficient while points stick; that of `friction` when left out.
        #[serde(default)]
        static_friction: Option<f64>,
        /// How far the surface stays apart from itself (m).
        #[serde(default)]
        thickness: f64,
        /// How often forces are corrected in a step.
        #[serde(default = "one_sweep")]
        sweeps: u32,
        /// Which points of the surface stay outside.
        #[serde(default)]
        points: Points,
        /// That edges which cross stay outside of each other, too.
        #[serde(default)]
        edges: bool,
        /// What keeps points out.
        #[serde(default)]
        law: ContactLaw,
    },
}

/// What keeps points out of what they touch.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ContactLaw {
    /// The correction of the predicted step: they end on the surface, and what they touch it with is gone.
    #[default]
    Kinematic,
    /// A spring where they are inside: they sink in, and come back.
    Penalty {
        /// The stiffness as a share of mass over the square of the step; at most 4 (1 − s²) at the share s of the
        /// stable step, .76 at .9.
        share: f64,
        /// The damping ratio of the spring.
        #[serde(default)]
        damping: f64,
    },
}

/// Which points of a surface stay outside of others.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Points {
    /// Its nodes.
    #[default]
    Nodes,
    /// Points of its faces, three of a triangle and four of a quadrilateral: pressures are more even where meshes do
    /// not match.
    Faces,
}

fn one_sweep() -> u32 {
    1
}

impl Contact {
    /// The coefficients of friction: while something sticks, and while it slides.
    pub fn friction(&self) -> [f64; 2] {
        let (Contact::Tool { friction, static_friction, .. }
        | Contact::Between { friction, static_friction, .. }
        | Contact::Itself { friction, static_friction, .. }) = self;
        [static_friction.unwrap_or(*friction), *friction]
    }

    /// What keeps points out.
    pub fn law(&self) -> ContactLaw {
        let (Contact::Tool { law, .. } | Contact::Between { law, .. } | Contact::Itself { law, .. }) = self;
        *law
    }
}

/// A tool that sucks: exposed faces in its mouth are drawn into it.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Suction {
    /// The tool's name.
    pub tool: String,
    /// The body; may be left out when there is one only.
    #[serde(default)]
    pub body: Option<String>,
    /// The pressure (Pa) by which it sucks when its mouth is closed; of what is closed to a share χ, χ² of it.
    pub pressure: f64,
    /// Radius of the mouth (m), a disc about the tool's origin, across its axis; a tube's `inner` when left out.
    #[serde(default)]
    pub bore: Option<f64>,
    /// How far before and behind the mouth faces are sucked (m).
    pub reach: f64,
    /// The time (s) in which the pressure follows what closes the mouth, and its course.
    #[serde(default)]
    pub delay: f64,
    /// Course of the pressure in time.
    #[serde(default)]
    pub curve: Curve,
}

fn surface() -> Select {
    Select::Surface { normal: None, within: 30.0 }
}

impl Tool {
    /// Its places, in the order of time: that of `at` where it has no path. Between them it turns by the shorter way
    /// round: where it is to turn about one axis by more than a quarter, there are some more.
    pub fn places(&self) -> Vec<ToolPlace> {
        let Some(first) = self.path.first() else {
            let (at, rotation) = (self.at.unwrap_or_default(), self.rotation.unwrap_or_default());
            return vec![ToolPlace { t: 0.0, at, rotation }];
        };
        let legs = self.path.windows(2).flat_map(|pair| pair[1].since(pair[0]));
        std::iter::once(*first).chain(legs).collect()
    }
}

impl ToolPlace {
    /// The places after another, to this one, a quarter of a turn at most from each other about the axis of both; this
    /// one alone where they have none in common.
    fn since(self, before: Self) -> impl Iterator<Item = Self> {
        let [from, to] = [before.rotation, self.rotation];
        let is_one_axis = from.cross(to).length() <= 1e-9 * from.length() * to.length();
        let quarters = if is_one_axis { (from.distance(to) / 90.0).ceil() } else { 1.0 };
        let parts = quarters.clamp(1.0, 4.0 * MOST_TURNS) as u32;
        (1..=parts).map(move |part| {
            let share = f64::from(part) / f64::from(parts);
            let t = before.t + share * (self.t - before.t);
            let between = Self { t, at: before.at.lerp(self.at, share), rotation: from.lerp(to, share) };
            if part == parts { self } else { between }
        })
    }
}
