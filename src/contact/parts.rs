//! The nodes that a contact acts on.

use glam::{DVec3, DVec4};

/// Nodes of a contact: at most four of the point's and four of the face's.
const MOST: usize = 8;

/// Nodes of a contact with signed weights: positive of the point's, negative of the face's.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parts {
    /// Places in [`ContactSet::steps`](super::ContactSet::steps).
    nodes: [u32; MOST],
    weights: [f64; MOST],
    count: usize,
}

impl Parts {
    /// Adds a node, eight at most.
    #[inline]
    pub fn add(&mut self, node: u32, weight: f64) {
        if weight != 0.0 && self.count < MOST {
            (self.nodes[self.count], self.weights[self.count]) = (node, weight);
            self.count += 1;
        }
    }

    /// The nodes and their weights.
    #[inline(always)]
    pub(super) fn slices(&self) -> (&[u32], &[f64]) {
        let count = self.count.min(MOST);
        (&self.nodes[..count], &self.weights[..count])
    }

    /// The nodes with their weights.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (nodes, weights) = self.slices();
        nodes.iter().zip(weights).map(|(&node, &weight)| (node as usize, weight))
    }

    /// The point's step against the face (m).
    #[inline(always)] // with the instructions of whoever asks
    pub fn step(&self, steps: &[DVec4]) -> DVec3 {
        let (nodes, weights) = self.slices();
        let mut step = DVec4::ZERO;
        for (&node, &weight) in nodes.iter().zip(weights) {
            step += steps[node as usize] * weight;
        }
        step.truncate()
    }

    /// Adds to the forces on nodes (N) what a force on the point is to them.
    #[inline(always)] // likewise
    pub(super) fn share(&self, force: DVec3, forces: &mut [DVec4]) {
        let ((nodes, weights), force) = (self.slices(), force.extend(0.0));
        for (&node, &weight) in nodes.iter().zip(weights) {
            forces[node as usize] += force * weight;
        }
    }

    /// Adds to the nodes' steps what a force on the point (N) does to them.
    #[inline(always)] // likewise
    pub(super) fn push(&self, force: DVec3, responses: &[DVec4], steps: &mut [DVec4]) {
        if force == DVec3::ZERO {
            return;
        }
        let ((nodes, weights), force) = (self.slices(), force.extend(0.0));
        for (&node, &weight) in nodes.iter().zip(weights) {
            steps[node as usize] += responses[node as usize] * (force * weight);
        }
    }
}
