//! Threads between points of bodies.

use super::Reals;
use super::column::columns;
use bevy_ecs::prelude::*;
use glam::DVec3;

columns! {
    /// What each suture is to the body that its first point is in, [`SUTURE_NUMBERS`] a suture: 0 while it holds, 1
    /// where its tension was too large for it, 2 where the tissue that it was in has gone; when that was (s); its
    /// tension (N), its length (m) and what it stores (J) at the beginning of the last step: the length and what it
    /// stored stay when it is gone.
    SutureState(Reals) = "suture_state", State of Touch, Other;
    /// Force of sutures on each of [`Sutured::rows`] in this step (N), a vector a node.
    SutureForce(Reals) = "suture_force", Scratch of Touch, Other;
}

/// Numbers a suture in [`SutureState`].
pub const SUTURE_NUMBERS: usize = 5;

/// A point of a body: weights of its element's nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor {
    /// The body.
    pub body: Entity,
    /// Rows of nodes, with weights that are 1 together.
    pub nodes: Vec<(u32, f64)>,
    /// Its element: the block, and the row there.
    pub element: (Entity, u32),
}

/// A thread between two points: a spring that pulls and does not push.
#[derive(Clone, Debug)]
pub struct Suture {
    /// Its place among the attachments of the scene.
    pub number: usize,
    /// Its ends.
    pub ends: [Anchor; 2],
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Length without tension (m); `None` until it is known how far the points are apart at the start.
    pub length: Option<f64>,
    /// By how much knots shorten it (m).
    pub tighten: f64,
    /// Slot of their course in time: see [`Signal::Factor`](super::Signal::Factor).
    pub signal: usize,
    /// The tension at which it tears (N), infinite where there is none.
    pub strength: f64,
    /// Its place in [`SutureState`] of the body of its first end.
    pub place: usize,
}

impl Suture {
    /// Its length without tension (m), with a factor of what knots shorten; of one that is not known yet infinite.
    pub fn slack(&self, factor: f64) -> f64 {
        (self.length.unwrap_or(f64::INFINITY) - self.tighten * factor).max(0.0)
    }

    /// Its tension (N) at a length (m), with a factor of what knots shorten.
    pub fn tension(&self, length: f64, factor: f64) -> f64 {
        let rest = (self.length.unwrap_or(length) - self.tighten * factor).max(0.0);
        self.stiffness * (length - rest).max(0.0)
    }
}

/// All sutures of a scene.
#[derive(Resource, Clone, Debug, Default)]
pub struct Sutures {
    /// In the order of the scene.
    pub all: Vec<Suture>,
    /// A point near the bodies (m), from which places are counted: so they keep their digits far from the origin.
    pub reference: DVec3,
}

/// The nodes of a body that sutures pull. On the body.
#[derive(Component, Clone, Debug)]
pub struct Sutured {
    /// Their rows, ascending.
    pub rows: Vec<u32>,
    /// Stiffness of the springs at each of them (N/m): twice the sum of stiffness times weight. With these on the
    /// diagonal a matrix is never less than that of the springs, by Cauchy and Schwarz.
    pub stiffness: Vec<f64>,
    /// Its mass at the start (kg): a node that weighs less by now makes its sutures softer, so that the stable step
    /// stays.
    pub masses: Vec<f64>,
    /// Forces on them in this step (N).
    pub forces: Vec<DVec3>,
}

impl Sutured {
    /// The place of a row.
    pub fn place(&self, row: u32) -> Option<usize> {
        self.rows.binary_search(&row).ok()
    }
}
