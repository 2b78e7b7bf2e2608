//! Work in implicit steps, and what their formula takes.

use super::axes::{Axes, Motion};
use crate::components::*;
use bevy_ecs::prelude::*;

/// Forces at the beginning of a step (N): F and R.
#[derive(Default)]
pub(super) struct Works {
    internal: Vec<f64>,
    external: Vec<f64>,
}

impl Works {
    /// Keeps the forces at the beginning of a step.
    pub fn begin(&mut self, world: &World, axes: &Axes) {
        let Self { internal, external } = self;
        internal.resize(axes.len(), 0.0);
        external.resize(axes.len(), 0.0);
        for (body, range) in axes.each() {
            if let Some(force) = world.get::<InternalForce>(body) {
                force.read(&mut internal[range.clone()]);
            }
            if let Some(force) = world.get::<ExternalForce>(body) {
                force.read(&mut external[range]);
            }
        }
    }

    /// Their bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.internal[..]) + size_of_val(&self.external[..])
    }

    /// Adds up what a step did. Forces work with the mean of those at both ends: of linear bodies that is what they
    /// store. What is missing then to the change of kinetic energy of a free axis went into the formula: implicit Euler
    /// takes ½ M Δv² + ½ Δu·ΔF, less what a change of loads gives.
    pub fn end(&mut self, world: &mut World, axes: &Axes, motion: &Motion, w: &[f64], step: &[f64], h: f64) {
        let mut columns =
            world.query::<(&mut Work, Option<&mut SchemeLoss>, Option<&InternalForce>, Option<&ExternalForce>)>();
        for (body, range) in axes.each() {
            let mut lost = vec![0.0; range.len() / 3];
            let Ok((mut work, loss, internal, external)) = columns.get_mut(world, body) else { continue };
            let of = |column: Option<&Reals>, at: usize| column.map_or(0.0, |column| column.get(at));
            let (internal, external) = (internal.map(|force| &force.0), external.map(|force| &force.0));
            for axis in range.clone() {
                let (at, node) = (axis - range.start, (axis - range.start) / 3);
                let (moved, velocity) = (w[axis] - motion.u[axis], step[axis] / h);
                let of_loads = 0.5 * (self.external[axis] + of(external, at)) * moved;
                let of_elements = 0.5 * (self.internal[axis] + of(internal, at)) * moved;
                let damped = motion.damping(axis) * 0.5 * (velocity + motion.v[axis]) * moved;
                let mut add = |number: usize, part: f64| {
                    let place = WORK_NUMBERS * node + number;
                    let sum = work.get(place) + part;
                    work.set(place, sum);
                };
                if motion.free[axis] || motion.held[axis] {
                    add(0, of_loads);
                    add(1, damped);
                    add(3, of_elements);
                }
                if motion.held[axis] {
                    add(2, of_elements - of_loads + damped);
                }
                if motion.free[axis] {
                    let kinetic = 0.5 * motion.mass[axis / 3] * (velocity * velocity - motion.v[axis] * motion.v[axis]);
                    lost[at / 3] += of_loads - of_elements - damped - kinetic;
                }
            }
            if let Some(mut loss) = loss {
                lost.iter().enumerate().for_each(|(node, part)| {
                    let sum = loss.get(node) + part;
                    loss.set(node, sum);
                });
            }
        }
    }
}
