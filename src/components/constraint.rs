//! Constraints and removal, with the rows they act on.

use super::ConstrainedAxes;
use bevy_ecs::prelude::*;
use glam::DVec3;

impl ConstrainedAxes {
    /// Whether a node does not move freely along any axis.
    pub(crate) fn hold(&self, row: usize) -> bool {
        self[row] == 0b111
    }
}

/// Nodes that do not move along some axes. The axes are bits of [`ConstrainedAxes`](super::ConstrainedAxes).
#[derive(Component, Clone, Debug)]
pub struct Fixed {
    /// Rows of the body's node columns.
    pub rows: Vec<u32>,
    /// Bits 0, 1, 2: x, y, z.
    pub axes: u32,
}

/// Nodes that move as told along some axes: u = A·(X − center) + b with A and b from the signal.
#[derive(Component, Clone, Debug, serde::Serialize)]
pub struct Prescribed {
    /// Rows of the body's node columns.
    #[serde(skip)]
    pub rows: Vec<u32>,
    /// Bits 0, 1, 2: x, y, z.
    pub axes: u32,
    /// X − center of each row (m).
    #[serde(skip)]
    pub arms: Vec<DVec3>,
    /// First of three slots in [`Signals`](super::Signals).
    pub signal: usize,
}

/// Removes elements of a block as soon as they pass a limit.
#[derive(Component, Clone, Debug)]
pub struct RemovalCriterion {
    /// The block.
    pub block: Entity,
    /// Rows of the block that may go; empty: all.
    pub rows: Vec<u32>,
    /// What is compared.
    pub measure: Measure,
    /// The limit.
    pub limit: f64,
}

/// What a removal criterion compares with its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The largest principal stretch, from above.
    Stretch,
    /// The volume ratio J, from above.
    VolumeRatio,
    /// Minus the volume ratio J: from below.
    NegativeVolumeRatio,
    /// Strain energy per rest volume (J/m³), from above.
    EnergyDensity,
}
