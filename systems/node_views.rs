//! What node systems see of a body beside the rows that they work on: before a step, at rest, in the middle of a step.

use crate::backend::cpu::{Declared, NodeShare};
use crate::components::*;
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A body before a pass begins, and the step that it is in.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The clock, at the beginning of the step.
    pub clock: &'a Clock,
    /// Values of loads and motions in this step.
    pub signals: &'a Signals,
    /// Where nodes are at rest (m).
    pub rest: &'a RestPosition,
    /// Displacements at the beginning of the step (m).
    pub displacement: &'a Displacement,
    /// Masses (kg); 0: inactive.
    pub mass: &'a Mass,
    pub(super) chosen: &'a [u32],
    pub(super) bit: u32,
    pub(super) declared: Declared,
}

impl<'a> Before<'a> {
    /// Rows of the nodes that the system has chosen, ascending; all where it has not.
    pub fn chosen(&self) -> impl Iterator<Item = usize> + use<'a> {
        rows_of(self.chosen, self.bit, self.mass.len())
    }
}

fn rows_of(chosen: &[u32], bit: u32, rows: usize) -> impl Iterator<Item = usize> {
    (0..rows).filter(move |&row| bit == 0 || chosen[row] & bit != 0)
}

/// The nodes of a body, for what forces on them do to the stable step.
#[derive(Clone, Copy, Debug)]
pub struct NodesAtRest<'a> {
    /// Where they are at rest (m).
    pub rest: &'a RestPosition,
    /// Their masses (kg); 0: inactive.
    pub mass: &'a Mass,
    /// Which axes are held, as bits.
    pub axes: Option<&'a ConstrainedAxes>,
    /// Inputs that programs set, where the scene has any.
    pub signals: Option<&'a Signals>,
    /// What the scene lasts (s).
    pub duration: f64,
}

impl<'a> NodesAtRest<'a> {
    pub(super) fn of(world: &'a World, body: Entity, duration: f64) -> Option<Self> {
        Some(Self {
            rest: world.get::<RestPosition>(body)?,
            mass: world.get::<Mass>(body)?,
            axes: world.get::<ConstrainedAxes>(body),
            signals: world.get_resource::<Signals>(),
            duration,
        })
    }

    /// Whether the node of a row can be pushed anywhere.
    pub fn moves(&self, row: usize) -> bool {
        self.mass.get(row) > 0.0 && self.axes.is_none_or(|axes| axes[row] & 7 != 7)
    }
}

/// Norms of −∂f/∂u and −∂f/∂v of forces on nodes, over the nodes' masses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceSlopes {
    /// κ (1/s²).
    pub stiffness: f64,
    /// γ (1/s).
    pub damping: f64,
}

impl ForceSlopes {
    /// Of forces that are the same wherever nodes are and however they move.
    pub const NONE: Self = Self { stiffness: 0.0, damping: 0.0 };

    /// Those of springs that push and let go, as a plate does that a body meets, in place of springs that always hold.
    /// A node comes to be in it by d ≤ v Δt within a step and has ½ k d² there that nobody gave, at most κ Δt² of ½ m
    /// v² and on the average a third of that. Where the nodes that touch have an eighth of the body, 1 % of the whole
    /// energy are gained at κ Δt² = 0.24: at 0.245 of the step at which such a spring by itself is stable, of which a
    /// `safety` of 0.9 takes (0.9/0.245)² = 13.5.
    pub fn letting_go(self) -> Self {
        Self { stiffness: 13.5 * self.stiffness, ..self }
    }

    /// The larger of both, each by itself.
    pub fn larger(self, other: Self) -> Self {
        Self { stiffness: self.stiffness.max(other.stiffness), damping: self.damping.max(other.damping) }
    }

    /// Those of forces that act together.
    pub fn and(self, other: Self) -> Self {
        Self { stiffness: self.stiffness + other.stiffness, damping: self.damping + other.damping }
    }
}

/// The nodes of a body in the middle of the last step, where energies are taken.
#[derive(Clone, Copy, Debug)]
pub struct MiddleOfStep<'a> {
    /// The clock, at the end of the step.
    pub clock: &'a Clock,
    /// Values of loads and motions in the last step.
    pub signals: &'a Signals,
    /// Where nodes are at rest (m).
    pub rest: &'a RestPosition,
    /// Masses (kg); 0: inactive.
    pub mass: &'a Mass,
    displacement: &'a Displacement,
    increment: &'a DisplacementIncrement,
    /// What of the last step leads back to its middle.
    back: f64,
    chosen: &'a [u32],
    own: Option<&'a OwnNumbers>,
    share: NodeShare,
}

impl<'a> MiddleOfStep<'a> {
    pub(super) fn of(world: &'a World, body: Entity, share: NodeShare) -> Option<Self> {
        let clock = world.get_resource::<Clock>()?;
        Some(Self {
            clock,
            signals: world.get_resource::<Signals>()?,
            rest: world.get::<RestPosition>(body)?,
            mass: world.get::<Mass>(body)?,
            displacement: world.get::<Displacement>(body)?,
            increment: world.get::<DisplacementIncrement>(body)?,
            back: clock.back_to_middle(),
            chosen: world.get::<ChosenBy>(body).map_or(&[], |chosen| chosen),
            own: world.get::<OwnNumbers>(body),
            share,
        })
    }

    /// Displacement of the node of a row (m).
    pub fn displacement(&self, row: usize) -> DVec3 {
        self.displacement.vector(row) - self.back * self.increment.vector(row)
    }

    /// Where the node of a row is (m).
    pub fn place(&self, row: usize) -> DVec3 {
        self.rest.0[row] + self.displacement(row)
    }

    /// Rows of the nodes that the system has chosen, ascending; all where it has not.
    pub fn chosen(&self) -> impl Iterator<Item = usize> + use<'a> {
        rows_of(self.chosen, self.share.bit, self.mass.len())
    }

    /// One of the numbers that the system keeps of the node of a row, at the end of the step; 0 where it has none.
    pub fn own(&self, row: usize, i: usize) -> f64 {
        let NodeShare { first, numbers, .. } = self.share;
        let stride = |own: &OwnNumbers| own.len() / self.mass.len().max(1);
        self.own.filter(|_| i < numbers).map_or(0.0, |own| own.get(stride(own) * row + first + i))
    }
}
