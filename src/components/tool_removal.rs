//! Tools that take elements away.

use super::column::columns;
use super::{Measure, Pose, Reals, Signals};
use crate::tools::Solid;
use bevy_ecs::prelude::*;
use glam::DVec3;

columns! {
    /// For each of a body's [`ToolRemovals`] two numbers: the volume (m³) that the tool has taken in and that is no
    /// element's yet, and 1 if something was in its reach when it was last looked, else 0. Exists with
    /// [`ToolRemovals`].
    ToolIntake(Reals) = "tool_intake", State of Account, Other;
    /// What a device needs to choose elements: how many are in reach, three words each (key, number, bits of the
    /// volume), from [`ToolRemovals::chosen`] on how many are chosen, and their numbers. Exists with [`ToolRemovals`].
    ToolReach(Vec<u32>) = "tool_reach", Scratch of Removal, Other;
}

/// How many steps there are from one look at what tools take and suck to the next.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToolLooks(pub u64);

/// Where a tool takes elements away: in its frame all that is no farther than `reach` from this.
#[derive(Clone, Debug, PartialEq)]
pub enum Mouth {
    /// A disc about the tool's origin, across its axis, of this radius (m).
    Disc(f64),
    /// The whole tool.
    Tool(Solid),
}

impl Mouth {
    /// How far a place in the tool's frame is (m); below 0 inside a tool.
    pub fn distance(&self, y: DVec3) -> f64 {
        match self {
            Self::Disc(radius) => (y.truncate().length() - radius).max(0.0).hypot(y.z),
            Self::Tool(solid) => solid.distance(y).0,
        }
    }
}

/// A tool that takes elements of a body away.
#[derive(Clone, Debug)]
pub struct ToolRemoval {
    /// The tool's name.
    pub tool: String,
    /// Where it takes them.
    pub mouth: Mouth,
    /// How far from there (m).
    pub reach: f64,
    /// The first of six slots of [`Signals`]: see [`Signal::Pose`](super::Signal::Pose), from
    /// [`ToolRemovals::reference`].
    pub pose: usize,
    /// Slot of the volume that it takes in a second (m³/s); with a threshold of a factor above 0 while it takes.
    pub rate: usize,
    /// The largest rate of these (m³/s) within the scene's duration, as far as the scene tells; 0 with a threshold.
    pub fastest: f64,
    /// In place of a rate, what of the elements in reach has to exceed what.
    pub threshold: Option<(Measure, f64)>,
    /// The volume (m³) below which islands in reach go at once.
    pub crumb: f64,
    /// Elements that it takes at most when it looks.
    pub burst: u32,
    /// The volume (m³) of the largest element that it may take: no more stays taken in, but what the steps from one
    /// look to the next take, where nothing is left in its reach.
    pub largest: f64,
    /// For each of the body's blocks and each of its elements the author's place of it; `u32::MAX`: it stays.
    pub numbers: Vec<Vec<u32>>,
}

impl ToolRemoval {
    /// Where the tool is at the end of the step, seen from the reference.
    pub fn pose_in(&self, signals: &Signals) -> Pose {
        Pose::of_slots(&signals.values()[self.pose..])
    }
}

/// The tools that take elements of a body away. On the body.
#[derive(Component, Clone, Debug)]
pub struct ToolRemovals {
    /// They.
    pub all: Vec<ToolRemoval>,
    /// A point near the body (m), from which places are counted.
    pub reference: DVec3,
}

/// What is cut off of a body that tools take elements of: found anew where elements have gone, and nothing that is
/// carried on. On the body, where a tool takes crumbs.
#[derive(Component, Clone, Debug)]
pub struct Islands {
    /// How many nodes the author has.
    pub points: usize,
    /// Of each of the author's elements the piece that it belongs to at the start.
    pub at_start: Vec<u32>,
    /// Which of them were there when islands were last found.
    pub there: Vec<bool>,
    /// Those of the islands then.
    pub all: Vec<Island>,
}

/// Elements that hang together, and not with the rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Island {
    /// Their volume at rest (m³).
    pub volume: f64,
    /// The author's places of them, ascending.
    pub elements: Vec<u32>,
}

/// Numbers of a tool in [`ToolIntake`].
pub const INTAKE_NUMBERS: usize = 2;

impl ToolRemovals {
    /// Where the chosen elements of so many begin in [`ToolReach`].
    pub fn chosen(elements: usize) -> usize {
        1 + 3 * elements
    }

    /// Words of [`ToolReach`] for so many elements.
    pub fn words(&self, elements: usize) -> usize {
        let burst = self.all.iter().map(|removal| removal.burst).max().unwrap_or(0);
        Self::chosen(elements) + 1 + burst as usize
    }
}
