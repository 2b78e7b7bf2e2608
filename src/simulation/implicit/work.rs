//! Work in implicit steps, and what their formula takes.

use super::axes::{Axes, Motion};
use crate::components::*;
use bevy_ecs::prelude::*;

/// Forces at the beginning of a step (N): F and R.
#[derive(Default)]
pub(super) struct Works {
    internal: Vec<f64>,
    external: Vec<f64>,
    now: [Vec<f64>; 2],
}

impl Works {
    /// Keeps the forces at the beginning of a step.
    pub fn begin(&mut self, world: &World, axes: &Axes) {
        read(world, axes, [&mut self.internal, &mut self.external]);
    }

    /// Adds up what a step did. Forces work with the mean of those at both ends: of linear bodies that is what they
    /// store. What is missing then to the change of kinetic energy of a free axis went into the formula: implicit Euler
    /// takes ½ M Δv² + ½ Δu·ΔF, less what a change of loads gives.
    pub fn end(&mut self, world: &mut World, axes: &Axes, motion: &Motion, w: &[f64], step: &[f64], h: f64) {
        let [internal, external] = &mut self.now;
        read(world, axes, [internal, external]);
        for (body, range) in axes.each() {
            let mut entity = world.entity_mut(body);
            let mut lost = vec![0.0; range.len() / 3];
            let Some(mut work) = entity.get_mut::<Work>() else { continue };
            for axis in range.clone() {
                let (at, node) = (axis - range.start, (axis - range.start) / 3);
                let (moved, velocity) = (w[axis] - motion.u[axis], step[axis] / h);
                let mean = |before: &[f64], after: &[f64]| 0.5 * (before[axis] + after[axis]);
                let of_loads = mean(&self.external, external) * moved;
                let of_elements = mean(&self.internal, internal) * moved;
                let damped = motion.damping[axis] * 0.5 * (velocity + motion.v[axis]) * moved;
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
                    let kinetic = 0.5 * motion.mass[axis] * (velocity * velocity - motion.v[axis] * motion.v[axis]);
                    lost[at / 3] += of_loads - of_elements - damped - kinetic;
                }
            }
            if let Some(mut loss) = entity.get_mut::<SchemeLoss>() {
                lost.iter().enumerate().for_each(|(node, part)| {
                    let sum = loss.get(node) + part;
                    loss.set(node, sum);
                });
            }
        }
    }
}

fn read(world: &World, axes: &Axes, [internal, external]: [&mut Vec<f64>; 2]) {
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
