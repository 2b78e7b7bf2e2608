//! How far held axes still have to go in a step: a list of those that do, for mostly few are moved as told.

use super::vectors::{clear, resize};
use crate::components::{Precision, Reals};

/// Axes, and how far each still has to go (m).
pub(super) struct ToGo {
    axes: Vec<u32>,
    left: Reals,
}

impl ToGo {
    /// None, in the numbers of a run.
    pub fn nowhere(precision: Precision) -> Self {
        Self { axes: Vec::new(), left: Reals::zeros(precision, 0) }
    }

    /// None any more.
    pub fn clear(&mut self) {
        self.axes.clear();
        resize(&mut self.left, 0);
    }

    /// One more that is not in it yet.
    pub fn push(&mut self, axis: usize, left: f64) {
        let place = self.axes.len();
        self.axes.push(axis as u32);
        resize(&mut self.left, place + 1);
        self.left.set(place, left);
    }

    /// Each axis, and what is left (m).
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.axes.iter().enumerate().map(|(place, &axis)| (axis as usize, self.left.get(place)))
    }

    /// Whether one has not arrived.
    pub fn moves(&self) -> bool {
        self.iter().any(|(_, left)| left != 0.0)
    }

    /// That a share of the way is gone.
    pub fn go(&mut self, share: f64) {
        (0..self.left.len()).for_each(|place| self.left.set(place, self.left.get(place) * (1.0 - share)));
    }

    /// A share of what is left, added to a vector over all axes.
    pub fn add(&self, share: f64, vector: &mut Reals) {
        self.iter().for_each(|(axis, left)| vector.set(axis, vector.get(axis) + share * left));
    }

    /// A vector over all axes of it, 0 elsewhere.
    pub fn put(&self, vector: &mut Reals) {
        clear(vector);
        self.iter().for_each(|(axis, left)| vector.set(axis, left));
    }

    /// Bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.axes) + self.left.bytes().len()
    }
}
