//! Rigid tools that move freely, and what they touch.

use super::tool::Pose;
use crate::tools::{Geometry, Inertia, RigidMotion};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// A tool that moves freely.
#[derive(Clone, Debug)]
pub struct FreeTool {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub geometry: Geometry,
    /// What resists its motion, in its own frame.
    pub inertia: Inertia,
    /// Damping of its motion (1/s).
    pub damping: f64,
    /// Slots of [`Signals`](super::Signals) with the accelerations of gravity (m/s²).
    pub gravity: Vec<usize>,
    /// Where its centre of mass is at the start (m, from [`FreeTools::reference`]).
    pub start: DVec3,
    /// The bodies that it may touch.
    pub meets: Vec<MetBody>,
}

/// A body that a free tool may touch.
#[derive(Clone, Debug)]
pub struct MetBody {
    /// The body.
    pub body: Entity,
    /// Its name.
    pub name: String,
    /// The nodes that it may touch, ascending.
    pub rows: Vec<u32>,
    /// Coefficients of friction: while it sticks, and while it slides.
    pub friction: [f64; 2],
    /// Length of an edge of the surface (m).
    pub edge: f64,
    /// How fast nodes that are inside the tool at the start are pushed out (m/s).
    pub settling: f64,
    /// How far a node must go in a step against the tool (m) for its way to be looked at, and not only where it ends.
    pub swept: f64,
}

/// All free tools of a scene. What changes of them is in [`FreeMotions`].
#[derive(Resource, Clone, Debug, Default)]
pub struct FreeTools {
    /// By their names, ascending.
    pub all: Vec<FreeTool>,
    /// A point near the bodies (m), from which places are counted: so they keep their digits far from the origin.
    pub reference: DVec3,
}

impl FreeTools {
    /// Whether one of them may touch a body.
    pub fn meet(&self, body: Entity) -> bool {
        self.all.iter().flat_map(|tool| &tool.meets).any(|met| met.body == body)
    }

    /// The place of the tool of a name.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.all.iter().position(|tool| tool.name == name)
    }
}

/// How free tools move, in f64 whatever the precision of the run, each at its tool's place in [`FreeTools::all`]: what
/// snapshots keep.
#[derive(Resource, Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeMotions {
    /// Of each.
    pub all: Vec<FreeMotion>,
}

/// How a free tool moves.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeMotion {
    /// Where it is (m, from [`FreeTools::reference`]), and how it moves.
    pub motion: RigidMotion,
    /// What touched it in the last step.
    pub touches: Vec<FreeTouch>,
    /// For how long their forces acted (s).
    #[serde(default)]
    pub acted: f64,
    /// How far nodes have slipped along its surface since the start (m), each by the place of its body in
    /// [`FreeTool::meets`] and its row, ascending.
    #[serde(default)]
    pub slid: Vec<((u32, u32), f64)>,
    /// Since the start: work of gravity on it (J).
    pub gravity_work: f64,
    /// Of nodes on it (J).
    pub contact_work: f64,
    /// What impact and friction with nodes have taken (J), but for the second half of the last step.
    pub contact_loss: f64,
    /// What damping has taken (J).
    pub damping_loss: f64,
}

/// A node that touches a free tool.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeTouch {
    /// The place of its body in [`FreeTool::meets`], and its row.
    pub node: (u32, u32),
    /// The force on it (N).
    pub force: DVec3,
    /// Where that acts, from the tool's centre of mass (m).
    pub arm: DVec3,
    /// Whether it stuck to the tool.
    pub sticks: bool,
    /// How far it slipped along the tool's surface (m).
    #[serde(default)]
    pub slip: f64,
    /// How far from the surface it was to end (m): 0, and less of a node that was inside before. Others may have taken
    /// it farther in.
    #[serde(default)]
    pub target: f64,
}

impl FreeMotion {
    /// At the start.
    pub fn at(motion: RigidMotion) -> Self {
        Self {
            motion,
            touches: Vec::new(),
            acted: 0.0,
            slid: Vec::new(),
            gravity_work: 0.0,
            contact_work: 0.0,
            contact_loss: 0.0,
            damping_loss: 0.0,
        }
    }

    /// Notes how far each node slips that it touches.
    pub(crate) fn note_slips(&mut self) {
        for touch in &self.touches {
            match self.slid.binary_search_by_key(&touch.node, |(node, _)| *node) {
                Ok(place) => self.slid[place].1 += touch.slip,
                Err(place) => self.slid.insert(place, (touch.node, touch.slip)),
            }
        }
    }

    /// Half of what the forces on nodes of the last step do in a step of these (J), by body and row (m), where steps
    /// are so long (s).
    pub(crate) fn work_of_half(&self, tool: &FreeTool, time_step: f64, step: impl Fn(Entity, usize) -> DVec3) -> f64 {
        let of =
            |touch: &FreeTouch| touch.force.dot(step(tool.meets[touch.node.0 as usize].body, touch.node.1 as usize));
        0.5 * self.acted / time_step * self.touches.iter().map(of).sum::<f64>()
    }

    /// The force on it (N), and its moment about the centre of mass (N m).
    pub fn felt(&self) -> (DVec3, DVec3) {
        let force = self.touches.iter().map(|touch| -touch.force).sum();
        (force, self.touches.iter().map(|touch| touch.arm.cross(-touch.force)).sum())
    }
}

impl FreeTool {
    /// Where its own frame is, in a motion (m, from [`FreeTools::reference`]).
    pub fn pose(&self, motion: &RigidMotion) -> Pose {
        let rotation = DMat3::from_quat(motion.turn);
        Pose { rotation, at: motion.place - rotation * self.inertia.center }
    }

    /// How far from its centre of mass it reaches (m).
    pub fn reach(&self) -> f64 {
        self.geometry.bounding_sphere().map_or(0.0, |(center, radius)| center.distance(self.inertia.center) + radius)
    }
}
