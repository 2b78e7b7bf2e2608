//! Loads, with the rows they act on.

use super::{Precision, Reals};
use bevy_ecs::prelude::*;
use std::sync::{PoisonError, RwLock, RwLockReadGuard};

/// Gravity on the body: the acceleration (m/s²) is a signal.
#[derive(Component, Clone, Debug)]
pub struct Gravity {
    /// Slot in [`Signals`](super::Signals).
    pub signal: usize,
}

/// A force (N), a signal, on each of some nodes.
#[derive(Component, Clone, Debug)]
pub struct NodalForce {
    /// Rows of the body's node columns, ascending.
    pub rows: Vec<u32>,
    /// What the force is multiplied with at each row; empty: 1 at all.
    pub factors: Vec<f64>,
    /// Slot in [`Signals`](super::Signals).
    pub signal: usize,
}

/// A pressure (Pa), a signal, that follows faces of the surface and pushes inwards.
#[derive(Component, Clone, Debug)]
pub struct Pressure {
    /// The faces, by the nodes they load.
    pub faces: FaceCorners,
    /// Slot in [`Signals`](super::Signals).
    pub signal: usize,
}

/// A force per rest area (Pa), a signal, on faces of the surface.
#[derive(Component, Clone, Debug)]
pub struct Traction {
    /// The faces, by the nodes they load.
    pub faces: FaceCorners,
    /// Slot in [`Signals`](super::Signals).
    pub signal: usize,
}

/// Faces of the surface by the nodes that they load, so that each node sums its own faces in a fixed order.
#[derive(Clone, Debug, Default)]
pub struct FaceCorners {
    /// Rows of the loaded nodes in the body's node columns, ascending.
    pub rows: Vec<u32>,
    /// The faces of `rows[i]` are `corners[starts[i]..starts[i + 1]]`.
    pub starts: Vec<u32>,
    /// Place of a face in `faces`, times four, plus which of its corners the node is.
    pub corners: Vec<u32>,
    /// Nodes of each face, outward normal by the right hand; a triangle repeats its last node.
    pub faces: Vec<[u32; 4]>,
    /// How much each face counts: a curved one is the weighted sum of flat ones.
    pub weights: Vec<f64>,
    /// The element behind each face: place of its block in the body's list, and its row there. A removed element's
    /// faces bear no load.
    pub elements: Vec<(u32, u32)>,
    /// Rest area of each face that falls to each of its corners (m²), times its weight.
    pub areas: Vec<[f64; 4]>,
    /// 1 while the face's element is there, else 0.
    pub alive: Vec<u32>,
    /// Of the present step.
    pub deformed: DeformedAreas,
}

/// Area vectors of faces' corners (m²), found anew in every step: in memory that is there from step to step.
#[derive(Debug)]
pub struct DeformedAreas(RwLock<Reals>);

impl Default for DeformedAreas {
    fn default() -> Self {
        Self(RwLock::new(Reals::zeros(Precision::F32, 0)))
    }
}

impl DeformedAreas {
    /// Has a task fill them in, in a precision; it finds those of the last step.
    pub fn renew(&self, precision: Precision, fill: impl FnOnce(&mut Reals)) {
        let mut areas = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if areas.precision() != precision {
            *areas = Reals::zeros(precision, 0);
        }
        fill(&mut areas);
    }

    /// Those of the step.
    pub fn read(&self) -> RwLockReadGuard<'_, Reals> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A copy finds its own.
impl Clone for DeformedAreas {
    fn clone(&self) -> Self {
        Self::default()
    }
}
