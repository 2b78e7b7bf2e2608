//! Loads that a scene has in WGSL alone, with the rows they act on.

use crate::materials::program::Program;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::sync::Arc;

/// A load that somebody wrote as one WGSL function, its parameters put in: the GPU runs the text as it stands, the CPU
/// runs it as a [`Program`].
#[derive(Clone, Debug)]
pub struct LoadText {
    /// The function, and the system.
    pub name: String,
    /// The file, as messages name it.
    pub path: String,
    /// Its text.
    pub text: String,
    /// The bytes of `var<uniform> parameters`; empty for a load without parameters.
    pub uniform: Vec<u8>,
    /// The force (N) on a node, from the numbers of `Node` in the order of `shaders/node_state.wgsl`.
    pub program: Program,
}

impl LoadText {
    /// Numbers of `Node`: position at rest, displacement, velocity, mass, curve, time, step.
    pub const NUMBERS: usize = 13;
    /// The place of the mass among them.
    pub const MASS: usize = 9;
    /// The place of the curve.
    pub const CURVE: usize = 10;

    /// The force (N) on a node with these numbers.
    pub fn force(&self, numbers: &[f64; Self::NUMBERS]) -> [f64; 3] {
        self.program.run(*numbers)
    }

    /// How fast the force on a node at rest grows as the node is displaced (N/m), by at most the `length` (m), and as
    /// it moves (N s/m), by at most a length a second: Frobenius norms of both derivatives.
    pub fn slopes(&self, node: &NodeAtRest, length: f64) -> [f64; 2] {
        let at_rest = node.numbers();
        [3, 6].map(|first| {
            let mut squares = 0.0;
            for axis in first..first + 3 {
                let (mut ahead, mut behind) = (at_rest, at_rest);
                ahead[axis] += length;
                behind[axis] -= length;
                let (ahead, behind) = (self.force(&ahead), self.force(&behind));
                squares += (0..3).map(|i| ((ahead[i] - behind[i]) / (2.0 * length)).powi(2)).sum::<f64>();
            }
            squares.sqrt()
        })
    }
}

/// A node before anything moves.
#[derive(Clone, Copy, Debug)]
pub struct NodeAtRest {
    /// Where it is (m).
    pub rest_position: DVec3,
    /// Its mass (kg).
    pub mass: f64,
    /// What the curve is.
    pub curve: f64,
    /// When (s).
    pub time: f64,
}

impl NodeAtRest {
    /// The numbers of `Node` with steps of a millisecond.
    pub fn numbers(&self) -> [f64; LoadText::NUMBERS] {
        let mut numbers = [0.0; LoadText::NUMBERS];
        numbers[..3].copy_from_slice(&self.rest_position.to_array());
        numbers[LoadText::MASS..].copy_from_slice(&[self.mass, self.curve, self.time, 1e-3]);
        numbers
    }
}

/// A load of the scene's own on a body; with [`OfSystem`].
#[derive(Component, Clone, Debug)]
pub struct OwnLoad {
    /// What it is.
    pub text: Arc<LoadText>,
    /// Rows of the body's node columns that it acts on, ascending; none: all.
    pub rows: Option<Vec<u32>>,
    /// Slot in [`Signals`](super::Signals): the curve, in the first place.
    pub signal: usize,
}

/// Which of the systems that a scene has of its own something is for, by its place among their names.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct OfSystem(pub usize);
