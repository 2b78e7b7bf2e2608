//! Who is held in an explicit step, for whoever asks before `grasp` runs: contact between bodies, and glue.

use crate::backend::cpu::{Foreseen, IntegrationCoefficients};
use crate::components::*;
use crate::math::{Scalar, vector_at};
use crate::systems::node_slices::NodeSlices;
use glam::DVec3;

/// Nodes of a body that tools may hold, in the run's precision. `shaders/surface_contact_hold.wgsl` is its twin.
pub(in crate::systems) struct Grip<'a, T> {
    grasps: &'a Grasps,
    numbers: &'a [T],
}

impl<'a, T: Scalar> Grip<'a, T> {
    /// Of columns in that precision.
    pub fn of((grasps, hold): (&'a Grasps, &'a ToolHold)) -> Self {
        Self { grasps, numbers: hold.slice() }
    }

    /// Tells where tools take the nodes that they hold (m): it yields to nothing, whatever pushes. Asked for are the
    /// nodes that `place_of` has a place for, by their rows; the others are left out.
    pub fn each_held(
        &self,
        nodes: &NodeSlices<'_, T>,
        (coefficients, signals): (&IntegrationCoefficients<f64>, &Signals),
        place_of: impl Fn(u32) -> Option<usize>,
        mut held: impl FnMut(usize, DVec3),
    ) {
        for (node, &row) in self.grasps.rows.iter().enumerate() {
            let Some(place) = place_of(row) else { continue };
            let row = row as usize;
            let at = nodes.rest[row] - self.grasps.reference + nodes.displacement(row);
            if let Some(step) = self.step_of(signals.values(), node, at, &nodes.foresee(row, coefficients)) {
                held(place, step);
            }
        }
    }

    /// Where a tool takes a node in this step (m), at a place among [`Grasps::rows`], that is so far from the grasps'
    /// reference (m) and would go as foreseen; `None` where no tool holds it. In the step in which a tool closes nobody
    /// is held yet for whom asks; whom a tool is too weak to hold goes without it from the next step on.
    fn step_of(&self, signals: &[[f64; 4]], node: usize, place: DVec3, foreseen: &Foreseen) -> Option<DVec3> {
        let (count, mask) = (self.grasps.numbers_a_grasp(), self.grasps.masks[node]);
        let held = |number: usize| {
            let (grasp, at) = (&self.grasps.grasps[number], self.grasps.numbers() * node + count * number);
            let holds = mask >> number & 1 == 1 && self.numbers[at + 3].to_f64() == ToolHold::HELD;
            if !holds || signals[grasp.closed][1] <= 0.0 {
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
