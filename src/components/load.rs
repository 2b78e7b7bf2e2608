//! What loads act on. What calls for the system of each kind is in its own file in `systems`.

use super::{Precision, Reals};
use bevy_ecs::prelude::*;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};

/// A load of the scene on a body: beside what calls for its system, for all that asks for loads of any kind.
#[derive(Component, Clone, Debug)]
pub struct SceneLoad {
    /// What it is called in words.
    pub name: &'static str,
    /// Slot in [`Signals`](super::Signals).
    pub signal: usize,
    /// What it acts on, together with the system.
    pub on: LoadedRows,
}

/// What a load acts on.
#[derive(Clone, Debug)]
pub enum LoadedRows {
    /// All of the body, and what the load is multiplied with at each row along each axis; empty: 1 at all.
    All(Arc<Vec<[f64; 3]>>),
    /// Some nodes.
    Nodes(Arc<LoadedNodes>),
    /// Faces of the surface.
    Faces(Arc<FaceCorners>),
}

impl LoadedRows {
    /// The nodes, if it acts on some.
    pub fn nodes(&self) -> Option<&Arc<LoadedNodes>> {
        if let Self::Nodes(nodes) = self { Some(nodes) } else { None }
    }

    /// Factors at all rows of the body, if it acts on all.
    pub fn all(&self) -> Option<&Arc<Vec<[f64; 3]>>> {
        if let Self::All(factors) = self { Some(factors) } else { None }
    }

    /// The faces, if it acts on some.
    pub fn faces(&self) -> Option<&Arc<FaceCorners>> {
        if let Self::Faces(faces) = self { Some(faces) } else { None }
    }
}

/// Nodes that a load acts on.
#[derive(Clone, Debug, Default)]
pub struct LoadedNodes {
    /// Rows of the body's node columns, ascending.
    pub rows: Vec<u32>,
    /// What the load is multiplied with at each row along each axis; empty: 1 at all.
    pub factors: Vec<[f64; 3]>,
}

/// Which of a load's faces are there: 1 while the element behind a face is, else 0.
#[derive(Debug, Default)]
pub struct FaceMarks(RwLock<Vec<u32>>);

impl FaceMarks {
    /// As they are.
    pub fn read(&self) -> RwLockReadGuard<'_, Vec<u32>> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Has a task change them.
    pub fn change(&self, task: impl FnOnce(&mut Vec<u32>)) {
        task(&mut self.0.write().unwrap_or_else(PoisonError::into_inner));
    }
}

/// A copy goes its own way.
impl Clone for FaceMarks {
    fn clone(&self) -> Self {
        Self(RwLock::new(self.read().clone()))
    }
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
    /// What a load along axes is multiplied with at each row along each of them; empty: 1 at all.
    pub factors: Vec<[f64; 3]>,
    /// Rest area of each face that falls to each of its corners (m²), times its weight.
    pub areas: Vec<[f64; 4]>,
    /// Which of them are there.
    pub alive: FaceMarks,
    /// Of the present step.
    pub deformed: DeformedAreas,
}

impl FaceCorners {
    /// Marks which faces are there, by the elements behind them: the place of a block in the body's list, and a row
    /// there. `None` leaves a face as it is.
    pub fn mark(&self, alive: impl Fn((u32, u32)) -> Option<u32>) {
        self.alive.change(|marks| {
            for (mark, &element) in marks.iter_mut().zip(&self.elements) {
                *mark = alive(element).unwrap_or(*mark);
            }
        });
    }
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
