//! Selections by place, name or number, and probes on them.

use super::{Attachment, Constraint, Contact, Scene};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Which nodes, faces or elements of a body at rest, by place, name or number. Faces count when all their nodes do,
/// elements when their centroid does.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Select {
    /// Everything.
    All,
    /// A named set of the mesh (a physical group).
    Set(String),
    /// The plane of all points with normal·X = at.
    Plane {
        /// The plane's normal; its length does not matter.
        normal: DVec3,
        /// Distance from the origin along the normal (m).
        at: f64,
        /// How far off the plane a point may lie (m); 1e-6 of the body's size when left out.
        #[serde(default)]
        tolerance: Option<f64>,
    },
    /// A box, its walls included.
    Box {
        /// Lower corner (m).
        min: DVec3,
        /// Upper corner (m).
        max: DVec3,
        /// How the box is turned about its middle: about the axes x, then y, then z (degrees).
        #[serde(default)]
        rotate: DVec3,
    },
    /// A ball, its surface included.
    Sphere {
        /// Centre (m).
        center: DVec3,
        /// Radius (m).
        radius: f64,
    },
    /// A cylinder between two points, its surface included.
    Cylinder {
        /// One end of the axis (m).
        from: DVec3,
        /// The other (m).
        to: DVec3,
        /// Radius (m).
        radius: f64,
    },
    /// An ellipsoid, its surface included.
    Ellipsoid {
        /// Centre (m).
        center: DVec3,
        /// Half-axes along x, y and z (m).
        radii: DVec3,
        /// How it is turned about its centre: about the axes x, then y, then z (degrees).
        #[serde(default)]
        rotate: DVec3,
    },
    /// Faces of the surface whose outward normal at rest lies within an angle of a direction, and their nodes.
    Surface {
        /// The direction; left out: the whole surface.
        #[serde(default)]
        normal: Option<DVec3>,
        /// The largest angle (degrees).
        #[serde(default = "thirty")]
        within: f64,
    },
    /// Nodes by the author's numbers.
    Nodes(Vec<u64>),
    /// Elements by the author's numbers.
    Elements(Vec<u64>),
    /// What is in all of these.
    And(Vec<Select>),
    /// What is in any of these.
    Or(Vec<Select>),
    /// What is not in this.
    Not(Box<Select>),
}

/// One thing to observe: what, where, how often (s; every output of fields when left out).
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// The body; may be left out when there is one only.
    #[serde(default)]
    pub body: Option<String>,
    /// What to observe.
    pub what: Quantity,
    /// On which nodes or elements; left out of what tools feel, and of a whole body's
    /// removed volume.
    #[serde(default)]
    pub on: Option<Select>,
    /// Time between observations (s).
    #[serde(default)]
    pub every: Option<f64>,
    /// Hold of each number the value of the largest size so far, of all observations.
    #[serde(default)]
    pub peak: bool,
}

/// What a probe observes.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Quantity {
    /// Mean displacement of the nodes (m).
    Displacement,
    /// Mean position of the nodes (m).
    Position,
    /// Mean velocity of the nodes (m/s), in the middle of the step that led there.
    Velocity,
    /// What holds the nodes: the sum of internal less external forces (N) along axes that are fixed or moved as told.
    Reaction,
    /// The part of the reaction along a direction (N).
    Force {
        /// The direction; its length does not matter.
        direction: DVec3,
    },
    /// The moment of the reactions about a point (N m).
    Moment {
        /// The point (m).
        center: DVec3,
    },
    /// The part of that moment about an axis (N m), positive by the right hand.
    Torque {
        /// A point on the axis (m).
        #[serde(default)]
        center: DVec3,
        /// The direction of the axis; its length does not matter.
        axis: DVec3,
    },
    /// Volume mean of the Cauchy stress of the elements: xx, yy, zz, xy, yz, xz (Pa).
    Stress,
    /// Volume mean of the volume ratio J of the elements that are there; 1 where none is.
    VolumeRatio,
    /// Volume at rest of the elements that have been removed (m³).
    RemovedVolume,
    /// The sum of what tools, other bodies and the body itself do to the nodes where they touch them (N).
    ContactForce,
    /// The force into the surface at the nodes, over the area that is touched (Pa).
    ContactPressure,
    /// The area at the nodes that is touched (m²).
    ContactArea,
    /// The least gap of the nodes (m).
    ContactGap,
    /// The mean of the lengths that the nodes have slid since the start (m).
    ContactSlip,
    /// The force of a suture, a tie or glue on the body of its first point (N).
    AttachmentForce {
        /// Its name.
        attachment: String,
    },
    /// How long a suture is (m).
    SutureLength {
        /// Its name.
        attachment: String,
    },
    /// The force that a tool feels: minus that on the nodes that it touches (N).
    ToolForce {
        /// The tool.
        tool: String,
    },
    /// The moment of these forces about the tool's origin (N m).
    ToolTorque {
        /// The tool.
        tool: String,
    },
    /// Where the tool's origin is (m).
    ToolPlace {
        /// The tool.
        tool: String,
    },
    /// Where the tool's origin is (m), and how it is turned: axis times angle (degrees).
    ToolPose {
        /// The tool.
        tool: String,
    },
    /// Velocity of the tool's origin (m/s) and how fast it turns (rad/s), in the middle of the last step.
    ToolVelocity {
        /// The tool.
        tool: String,
    },
}

impl Quantity {
    /// Whether it is made of the forces that hold nodes.
    pub fn is_of_reactions(&self) -> bool {
        matches!(self, Self::Reaction | Self::Force { .. } | Self::Moment { .. } | Self::Torque { .. })
    }

    /// Whether it is of what nodes touch.
    pub fn is_of_contact(&self) -> bool {
        use Quantity::*;
        matches!(self, ContactForce | ContactPressure | ContactArea | ContactGap | ContactSlip)
    }

    /// Whether it is made of forces, or as long as what pulls: explicit steps show these as they were at their
    /// beginning.
    pub fn is_of_forces(&self) -> bool {
        use Quantity::*;
        let of_contact = matches!(self, ContactForce | ContactPressure | ContactArea);
        let of_others = matches!(self, ToolForce { .. } | ToolTorque { .. });
        self.is_of_reactions() || of_contact || of_others || self.attachment().is_some()
    }

    /// Whether it is of elements, not of nodes.
    pub fn is_of_elements(&self) -> bool {
        matches!(self, Self::Stress | Self::VolumeRatio | Self::RemovedVolume)
    }

    /// The attachment that it is of, if it is of one.
    pub fn attachment(&self) -> Option<&String> {
        match self {
            Self::AttachmentForce { attachment } | Self::SutureLength { attachment } => Some(attachment),
            _ => None,
        }
    }

    /// Whether it needs nothing of a body: what tools and attachments feel.
    pub fn is_of_no_body(&self) -> bool {
        self.tool().is_some() || self.attachment().is_some()
    }

    /// The tool that it is of, if it is of one.
    pub fn tool(&self) -> Option<&String> {
        match self {
            Self::ToolForce { tool }
            | Self::ToolTorque { tool }
            | Self::ToolPlace { tool }
            | Self::ToolPose { tool }
            | Self::ToolVelocity { tool } => Some(tool),
            _ => None,
        }
    }
}

impl Select {
    /// The lists of nodes in a selection and its parts.
    pub(crate) fn lists_of_nodes(&self) -> Vec<&[u64]> {
        match self {
            Select::Nodes(numbers) => vec![numbers],
            Select::And(parts) | Select::Or(parts) => parts.iter().flat_map(Select::lists_of_nodes).collect(),
            Select::Not(part) => part.lists_of_nodes(),
            _ => Vec::new(),
        }
    }
}

impl Scene {
    /// All selections that are written in the scene.
    pub fn selections(&self) -> impl Iterator<Item = &Select> {
        let regions = self.bodies.values().flat_map(|body| body.regions.iter().map(|region| &region.on));
        let constraints = self.constraints.iter().map(|constraint| match constraint {
            Constraint::Fixed { on, .. } | Constraint::Prescribed { on, .. } => on,
        });
        let loads = self.loads.iter().filter_map(|load| load.parts().on.select());
        let removal = self.removal.iter().map(|removal| &removal.on);
        let systems = self.systems.values().map(|system| &system.on);
        let probes = self.probes.values().filter_map(|probe| probe.on.as_ref());
        let contacts = self.contacts.iter().filter_map(|contact| match contact {
            Contact::Tool { on, .. } => Some(on),
            Contact::Between { .. } | Contact::Itself { .. } => None,
        });
        let attachments = self.attachments.iter().flat_map(Attachment::selections).map(|(_, on)| on);
        let all = regions.chain(constraints).chain(loads).chain(systems).chain(contacts).chain(attachments);
        all.chain(removal).chain(probes)
    }
}

fn thirty() -> f64 {
    30.0
}
