//! Who is held in an explicit step, for whoever asks before `grasp` runs: contact between bodies.

use super::HELD;
use crate::backend::cpu::Foreseen;
use crate::components::*;
use crate::math::{Scalar, vector_at};
use glam::DVec3;

/// Nodes of a body that tools may hold, in the run's precision. `shaders/surface_contact_hold.wgsl` is its twin.
pub(in crate::systems) struct Grip<'a, T> {
    pub grasps: &'a Grasps,
    pub numbers: &'a [T],
}

impl<T: Scalar> Grip<'_, T> {
    /// Where a tool takes a node in this step (m), at a place among [`Grasps::rows`], that is so far from the grasps'
    /// reference (m) and would go as foreseen; `None` where no tool holds it. In the step in which a tool closes nobody
    /// is held yet for whom asks; whom a tool is too weak to hold goes without it from the next step on.
    pub fn step_of(&self, signals: &[[f64; 4]], node: usize, place: DVec3, foreseen: &Foreseen) -> Option<DVec3> {
        let (count, mask) = (self.grasps.numbers_a_grasp(), self.grasps.masks[node]);
        let held = |number: usize| {
            let (grasp, at) = (&self.grasps.grasps[number], self.grasps.numbers() * node + count * number);
            if mask >> number & 1 == 0 || self.numbers[at + 3].to_f64() != HELD || signals[grasp.closed][1] <= 0.0 {
                return None;
            }
            let pose = Pose::of_slots(&signals[grasp.tool.signal..]);
            let gap = foreseen.free * (pose.place(vector_at(self.numbers, at + 6)) - place - foreseen.step);
            Some(foreseen.step + gap)
        };
        // the last one has it
        (0..self.grasps.grasps.len()).rev().find_map(held)
    }
}
