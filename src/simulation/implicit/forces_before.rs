//! Forces at the beginning of a step.

use super::axes::Axes;
use super::vectors::{copy_to, none, resize, with_numbers};
use crate::components::*;
use bevy_ecs::prelude::*;

/// F and R (N) of all axes.
pub(super) struct ForcesBefore {
    pub internal: Reals,
    pub external: Reals,
}

impl ForcesBefore {
    /// Not known yet.
    pub fn new(precision: Precision) -> Self {
        Self { internal: none(precision), external: none(precision) }
    }

    /// Reads what columns have.
    pub fn read(&mut self, world: &World, axes: &Axes) {
        let Self { internal, external } = self;
        resize(internal, axes.len());
        resize(external, axes.len());
        for (body, range) in axes.each() {
            let entity = world.entity(body);
            if let Some(force) = entity.get::<InternalForce>() {
                copy_to(internal, range.start, force);
            }
            if let Some(force) = entity.get::<ExternalForce>() {
                copy_to(external, range.start, force);
            }
        }
    }

    /// Puts columns back.
    pub fn put_back(&self, world: &mut World, axes: &Axes) {
        for (body, range) in axes.each() {
            if let Some(mut force) = world.get_mut::<InternalForce>(body) {
                with_numbers!(force, T => force.slice_mut::<T>().copy_from_slice(&self.internal.slice::<T>()[range.clone()]));
            }
            if let Some(mut force) = world.get_mut::<ExternalForce>(body) {
                with_numbers!(force, T => force.slice_mut::<T>().copy_from_slice(&self.external.slice::<T>()[range]));
            }
        }
    }

    /// F − R of an axis (N).
    pub fn net(&self, axis: usize) -> f64 {
        self.internal.get(axis) - self.external.get(axis)
    }

    /// Bytes of both.
    pub fn bytes(&self) -> usize {
        self.internal.bytes().len() + self.external.bytes().len()
    }
}
