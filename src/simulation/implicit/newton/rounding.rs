//! What rounding makes of the residual: less of it is not to be had.

use super::super::super::rounding::digit_of_places;
use super::super::conjugate_gradients::Vectors;
use super::super::differences::difference;
use super::super::place::Place;
use super::{Newton, Workspace, fill_with_signs};
use crate::error::Error;

impl Newton<'_, '_> {
    /// Whether a residual of such a norm at w is no more than what rounding makes.
    pub(super) fn is_rounding(&mut self, size: f64) -> Result<bool, Error> {
        self.forces_at_w()?;
        Ok(size <= self.rounding()?)
    }

    /// About what rounding makes of the residual (N): of a displacement the last digit, and of where nodes are that may
    /// touch, times the norm of its row of K, which a product with signs shows, and its inertia. The forces at w must
    /// be known.
    pub(super) fn rounding(&mut self) -> Result<f64, Error> {
        let Self { trial, settings, h, motion, space, .. } = self;
        let Workspace { correction, net, vectors: Vectors { direction, image }, .. } = &mut **space;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        fill_with_signs(direction, &motion.free);
        difference(trial, &place, net, direction, image)?;
        let digit = if self.is_f64() { f64::EPSILON } else { f64::from(f32::EPSILON) };
        let (place, rows) = (self.place(), &self.space.vectors.image);
        let inertia = self.motion.inertia(&self.settings.formula, self.h);
        let size = |axis: usize| place.displacement(axis).abs().max(place.correction(axis).abs());
        let mut square = 0.0;
        for (body, range) in self.trial.axes.each() {
            let of_places = digit_of_places(body, self.trial.world);
            for axis in range.filter(|&axis| self.motion.free[axis]) {
                let row = rows.get(axis).abs();
                square += ((row + inertia.of(axis / 3)) * digit * size(axis) + row * of_places).powi(2);
            }
        }
        Ok(square.sqrt())
    }
}
