//! Tools that take nodes along.

use super::Reals;
use super::column::columns;
use super::tool::{FELT_NUMBERS, ToolContact};
use bevy_ecs::prelude::*;
use glam::DVec3;

columns! {
    /// What tools do to the nodes that they may hold: for each of [`Grasps::rows`] and each of its grasps
    /// [`HOLD_NUMBERS`] numbers: the force on the node in the last step (N); 0 while the tool is open, 1 where it holds
    /// the node, 2 where it closed without it, 3 where the node slipped out (a force beside it is that of the step at
    /// whose end it did), and 4 while it is open since; since the start the work that the tool has done and what of
    /// that was lost when it caught the node (J); the place in the tool's frame where the node was when it closed (m).
    /// Where a hand moves one of the tools, [`FELT_NUMBERS`] more: the sum of the forces since its batch of steps began
    /// (N). Exists where a tool may hold nodes of the body.
    ToolHold(Reals) = "tool_hold", State of Grip, Other;
}

impl ToolHold {
    /// A closed tool holds the node.
    pub(crate) const HELD: f64 = 1.0;
    /// It closed without it.
    pub(crate) const WITHOUT: f64 = 2.0;
    /// The node slipped out of it.
    pub(crate) const SLIPPED: f64 = 3.0;
    /// It is open, and the node slipped out before.
    pub(crate) const LET_GO: f64 = 4.0;

    /// Whether a tool is open.
    pub(crate) fn is_open(holds: f64) -> bool {
        holds == 0.0 || holds == Self::LET_GO
    }

    /// What a tool is to a node when it opens.
    pub(crate) fn opened(holds: f64) -> f64 {
        if holds == Self::SLIPPED { Self::LET_GO } else { 0.0 }
    }

    /// Whether the node slipped out when the tool was closed last.
    pub(crate) fn has_slipped(holds: f64) -> bool {
        holds == Self::SLIPPED || holds == Self::LET_GO
    }
}

/// Numbers of a node and a grasp in [`ToolHold`].
pub const HOLD_NUMBERS: usize = 9;

/// A tool that may hold nodes of a body.
#[derive(Clone, Debug)]
pub struct Grasp {
    /// Its place among the attachments of the scene.
    pub number: usize,
    /// The tool, without friction.
    pub tool: ToolContact,
    /// The slot of [`Signals`](super::Signals) that says whether it is closed: see
    /// [`Signal::Factor`](super::Signal::Factor).
    pub closed: usize,
    /// How far from it a node may be when it closes (m); `None`: however far.
    pub reach: Option<f64>,
    /// The force above which a node slips out in motion (N), infinite where there is none.
    pub strength: f64,
}

/// What may hold a body's nodes. On the body.
#[derive(Component, Clone, Debug)]
pub struct Grasps {
    /// All of them, the later ones having the last word where several hold a node.
    pub grasps: Vec<Grasp>,
    /// A point near the body (m), from which places are counted.
    pub reference: DVec3,
    /// The nodes that may be held, ascending.
    pub rows: Vec<u32>,
    /// Of each of them, by which: bit i is grasp i.
    pub masks: Vec<u32>,
    /// Whether a hand moves one of the tools, which wants the mean of what it feels.
    pub felt: bool,
}

impl Grasps {
    /// Grasps of one body: bits of a mask.
    pub const MOST: usize = crate::scene::limits::TOOLS_OF_A_BODY;

    /// Numbers a node in [`ToolHold`].
    pub fn numbers(&self) -> usize {
        self.numbers_a_grasp() * self.grasps.len()
    }

    /// Numbers a node and a grasp.
    pub fn numbers_a_grasp(&self) -> usize {
        HOLD_NUMBERS + if self.felt { FELT_NUMBERS } else { 0 }
    }
}
