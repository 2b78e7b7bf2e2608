//! Tools in a step.

use crate::backend::cpu::IntegrationCoefficients;
use crate::components::*;
use glam::{DMat3, DVec3};

/// What a step needs.
pub struct ContactStep {
    pub(super) coefficients: IntegrationCoefficients<f64>,
    /// How far a node that is inside a tool comes out in this step (m).
    pub(super) out: f64,
    /// Whether work is counted: not on the way to rest.
    pub(super) counts_work: bool,
    /// Δt (s), and how springs press in it where it is implicit.
    pub(super) time: f64,
    pub(super) springs: Option<SolvedSprings>,
    /// As many as there are, and then anything.
    pub(super) tools: [ToolInStep; ToolContacts::MOST],
    count: usize,
}

/// A tool in a step.
#[derive(Clone, Copy)]
pub(super) struct ToolInStep {
    /// Where it is at the end.
    pub pose: Pose,
    /// Where it was at the beginning.
    pub earlier: Pose,
    /// How these differ.
    pub change: Pose,
    /// What all that it may touch lies within.
    bound: Bound,
    /// Whether it is a plane that does not turn: the same normal and the same step everywhere.
    pub is_even: bool,
}

/// What all that a tool may touch lies within.
#[derive(Clone, Copy)]
pub(super) enum Bound {
    /// A ball: its middle (m), and its radius squared (m²).
    Ball(DVec3, f64),
    /// What is below a height (m) along a unit vector.
    Below(DVec3, f64),
}

impl Bound {
    #[inline(always)]
    fn holds(&self, place: DVec3) -> bool {
        match *self {
            Self::Ball(center, radius_squared) => center.distance_squared(place) <= radius_squared,
            Self::Below(normal, height) => normal.dot(place) <= height,
        }
    }

    /// Whether it may hold a place within a box, from the least to the largest coordinates (m): it does if it holds
    /// the one that is nearest to it, for rounding keeps order.
    fn meets(&self, [low, high]: [DVec3; 2]) -> bool {
        self.holds(match *self {
            Self::Ball(center, _) => center.max(low).min(high),
            Self::Below(normal, _) => DVec3::select(normal.cmpge(DVec3::ZERO), low, high),
        })
    }
}

impl ContactStep {
    /// Whether any tool may touch nodes within a box (m, from the reference).
    pub(super) fn meets(&self, within: [DVec3; 2]) -> bool {
        self.tools[..self.count].iter().any(|tool| tool.bound.meets(within))
    }

    /// Which of some tools may touch a node at a place (m, from the reference); both as bits.
    #[inline(always)]
    pub(super) fn near(&self, tools: u32, place: DVec3) -> u32 {
        let (mut left, mut near) = (tools, 0);
        while left != 0 {
            let tool = left.trailing_zeros();
            left &= left - 1;
            near |= u32::from(self.tools[tool as usize].bound.holds(place)) << tool;
        }
        near
    }
}

impl ToolContacts {
    /// What a step that begins at the clock's needs.
    pub(super) fn in_step(&self, clock: &Clock, signals: &Signals) -> ContactStep {
        let values = signals.values();
        let nowhere = Pose { rotation: DMat3::ZERO, at: DVec3::ZERO };
        let bound = Bound::Ball(DVec3::ZERO, 0.0);
        let none = ToolInStep { pose: nowhere, earlier: nowhere, change: nowhere, bound, is_even: false };
        let mut tools = [none; ToolContacts::MOST];
        for (tool, contact) in tools.iter_mut().zip(&self.tools) {
            let [pose, change] = [0, 3].map(|slot| Pose::of_slots(&values[contact.signal + slot..]));
            let earlier = pose.less(&change);
            // of one whose way is looked at, the bound goes along
            let reach = |center| self.edge + if contact.swept > 0.0 { change.place(center).length() } else { 0.0 };
            let bound = match contact.geometry.bounding_sphere() {
                Some((center, radius)) => Bound::Ball(pose.place(center), (radius + reach(center)).powi(2)),
                None => Bound::Below(pose.rotation.z_axis, pose.rotation.z_axis.dot(pose.at) + reach(DVec3::ZERO)),
            };
            let is_even = matches!(bound, Bound::Below(..)) && change.rotation == DMat3::ZERO;
            *tool = ToolInStep { pose, earlier, change, bound, is_even };
        }
        ContactStep {
            coefficients: IntegrationCoefficients::of(clock),
            out: self.out(clock),
            counts_work: clock.relaxation.is_none(),
            time: clock.time_step,
            springs: clock.springs,
            tools,
            count: self.tools.len(),
        }
    }

    /// The bits of all tools.
    pub(super) fn all(&self) -> u32 {
        u32::MAX >> (u32::BITS - self.tools.len().max(1) as u32)
    }

    /// How far a node that is inside a tool comes out in a step (m).
    fn out(&self, clock: &Clock) -> f64 {
        match clock.relaxation {
            Some(_) => 0.1 * self.edge,
            None => self.settling * clock.time_step,
        }
    }
}

#[cfg(test)]
mod tests;
