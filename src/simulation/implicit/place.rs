//! Where axes are at the end of a step, as what is added to where their velocity leads: that is found to the digits of
//! what forces do, and not of how far axes go.

use super::axes::{Axes, Motion, acceleration_before};
use super::formula::Formula;
use super::vectors::{none, with_numbers};
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// w = y + what is added, y = u + h v; of axes that are not free, y = u.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub formula: &'a Formula,
    /// The length of the step (s).
    pub h: f64,
    pub motion: &'a Motion,
    /// What is added (m).
    pub correction: &'a Reals,
    /// How much of a direction (m) is added beside.
    pub beyond: Option<(f64, &'a Reals)>,
}

impl<'a> Place<'a> {
    /// Farther along a direction.
    pub fn beyond(self, share: f64, direction: &'a Reals) -> Self {
        Self { beyond: Some((share, direction)), ..self }
    }

    /// w − y of an axis (m).
    #[inline]
    pub fn correction(&self, axis: usize) -> f64 {
        let beyond = self.beyond.map_or(0.0, |(share, direction)| share * direction.get(axis));
        self.correction.get(axis) + beyond
    }

    /// w of an axis (m), to the digits of the run.
    #[inline]
    pub fn displacement(&self, axis: usize) -> f64 {
        self.motion.predicted(axis, self.h) + self.correction(axis)
    }

    /// w − u of an axis (m).
    #[inline]
    pub fn moved(&self, axis: usize) -> f64 {
        let Self { motion, h, .. } = self;
        if motion.free[axis] { h * motion.velocity(axis) + self.correction(axis) } else { self.correction(axis) }
    }

    /// The velocity (m/s) and acceleration (m/s²) of an axis there, that had an acceleration before.
    #[inline]
    pub fn arrival(&self, axis: usize, before: f64) -> (f64, f64) {
        let Self { formula, h, motion, .. } = self;
        motion.arrival(formula, axis, *h, (self.correction(axis), motion.velocity(axis), before))
    }

    /// The step (m) that the velocity of an axis there is; at rest the way from where the search began.
    #[inline]
    fn step(&self, axis: usize, before: f64) -> f64 {
        if self.formula.is_of_rest() { self.moved(axis) } else { self.h * self.arrival(axis, before).0 }
    }

    /// The steps of all axes (m).
    pub fn steps(&self, axes: &'a Axes, world: &'a World) -> impl Iterator<Item = f64> {
        axes.accelerations(world).enumerate().map(|(axis, before)| self.step(axis, before))
    }

    /// Puts all axes there, rounded.
    pub fn displace(&self, axes: &Axes, world: &mut World) {
        for (body, range) in axes.each() {
            let Some(mut column) = taken::<Displacement>(world, body) else { continue };
            let lost = world.get::<DisplacementCompensation>(body).map(|lost| &lost.0);
            with_numbers!(column, T => self.fill(range, lost, column.slice_mut::<T>()));
            put(world, body, Displacement(column));
        }
    }

    fn fill<T: Scalar>(&self, range: Range<usize>, lost: Option<&Reals>, column: &mut [T]) {
        let Self { h, motion, correction, beyond, .. } = self;
        let (count, ahead) = (column.len(), h * motion.rate);
        let own = |vector: &'a Reals| &vector.slice::<T>()[range.clone()][..count];
        let (u, step, correction) = (own(&motion.u), own(&motion.step), own(correction));
        let free = &motion.free[range.clone()][..count];
        let lost = lost.map(|lost| lost.slice::<T>().split_at(count));
        let lost = lost.map(|(of_u, of_step)| (&of_u[..count], &of_step[..count]));
        let predicted = |i: usize| {
            let (of_u, of_step) = lost.map_or((0.0, 0.0), |(u, step)| (u[i].to_f64(), step[i].to_f64()));
            let u = u[i].to_f64() - of_u;
            if free[i] { u + ahead * (step[i].to_f64() - of_step) } else { u }
        };
        let Some((share, direction)) = *beyond else {
            (0..count).for_each(|i| column[i] = T::from_f64(predicted(i) + correction[i].to_f64()));
            return;
        };
        let direction = own(direction);
        for i in 0..count {
            let added = correction[i].to_f64() + share * direction[i].to_f64();
            column[i] = T::from_f64(predicted(i) + added);
        }
    }

    /// Makes the steps of all axes those of their velocities there, rounded.
    pub fn write_steps(&self, axes: &Axes, world: &mut World) {
        for (body, range) in axes.each() {
            let Some(mut step) = taken::<DisplacementIncrement>(world, body) else { continue };
            let before = (0..range.len()).map(acceleration_before(world, body)).enumerate();
            before.for_each(|(at, before)| step.set(at, self.step(range.start + at, before)));
            put(world, body, DisplacementIncrement(step));
        }
    }

    /// Takes the state there over, with what rounding leaves out of it.
    pub fn arrive(&self, axes: &Axes, world: &mut World) {
        let Self { formula, h, motion, .. } = self;
        for (body, range) in axes.each() {
            let (Some(mut u), Some(mut step)) =
                (taken::<Displacement>(world, body), taken::<DisplacementIncrement>(world, body))
            else {
                continue;
            };
            let mut lost = taken::<DisplacementCompensation>(world, body);
            let mut accelerations = taken::<Acceleration>(world, body);
            let count = range.len();
            for i in 0..count {
                let axis = range.start + i;
                let [of_u, of_step] = [i, count + i].map(|at| lost.as_ref().map_or(0.0, |lost| lost.get(at)));
                let velocity = motion.rate * (motion.step.get(axis) - of_step);
                let predicted = if motion.free[axis] { h * velocity } else { 0.0 };
                let w = motion.u.get(axis) - of_u + predicted + self.correction(axis);
                let before = accelerations.as_ref().map_or(0.0, |all| all.get(i));
                let (arrives, acceleration) =
                    motion.arrival(formula, axis, *h, (self.correction(axis), velocity, before));
                u.set(i, w);
                step.set(i, h * arrives);
                if let Some(all) = &mut accelerations {
                    all.set(i, acceleration);
                }
                if let Some(lost) = &mut lost {
                    lost.set(i, u.get(i) - w);
                    lost.set(count + i, step.get(i) - h * arrives);
                }
            }
            put(world, body, Displacement(u));
            put(world, body, DisplacementIncrement(step));
            lost.into_iter().for_each(|lost| put(world, body, DisplacementCompensation(lost)));
            accelerations.into_iter().for_each(|all| put(world, body, Acceleration(all)));
        }
    }
}

/// A column of a body, which is not there until it is [`put`] back.
fn taken<C: Component<Mutability = Mutable> + std::ops::DerefMut<Target = Reals>>(
    world: &mut World,
    body: Entity,
) -> Option<Reals> {
    let mut column = world.get_mut::<C>(body)?;
    let precision = column.precision();
    Some(std::mem::replace(&mut **column, none(precision)))
}

/// Puts a column back.
fn put<C: Component<Mutability = Mutable>>(world: &mut World, body: Entity, column: C) {
    if let Some(mut place) = world.get_mut::<C>(body) {
        *place = column;
    }
}
