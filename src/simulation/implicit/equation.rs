//! The equation of each axis in a step: its inertia, its damping, and what it is at a place.

use super::axes::{Axes, Motion, acceleration_before};
use super::forces_before::ForcesBefore;
use super::formula::Formula;
use super::place::Place;
use super::vectors::with_numbers;
use crate::components::Reals;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// D of nodes (N/m): what a displacement of 1 m changes of the equation of an axis beside forces.
#[derive(Clone, Copy)]
pub(in crate::simulation) struct Inertia<'a> {
    mass: &'a Reals,
    damping: &'a Reals,
    per_mass: f64,
    per_damping: f64,
}

impl Inertia<'_> {
    /// That of a node.
    #[inline]
    pub fn of(&self, node: usize) -> f64 {
        let damping = if self.damping.is_empty() { 0.0 } else { self.per_damping * self.damping.get(node) };
        self.per_mass * self.mass.get(node) + damping
    }

    /// Adds D p to a product (N) on free axes, and makes it 0 on others.
    pub fn add_product(&self, p: &Reals, free: &[bool], image: &mut Reals) {
        with_numbers!(image, T => {
            let nodes = image.slice_mut::<T>().as_chunks_mut::<3>().0.iter_mut().zip(p.slice::<T>().as_chunks::<3>().0);
            for (node, ((image, p), free)) in nodes.zip(free.as_chunks::<3>().0).enumerate() {
                let inertia = self.of(node);
                for i in 0..3 {
                    let sum = image[i].to_f64() + inertia * p[i].to_f64();
                    image[i] = if free[i] { T::from_f64(sum) } else { T::default() };
                }
            }
        });
    }

    /// Those of all nodes.
    pub fn all(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.mass.len()).map(|node| self.of(node))
    }
}

impl Motion {
    /// Bytes of all vectors.
    pub fn bytes(&self) -> usize {
        let Self { u, step, rate: _, mass, damping, free } = self;
        let numbers: usize = [u, step, mass, damping].into_iter().map(|vector| vector.bytes().len()).sum();
        numbers + size_of_val(&free[..])
    }

    /// Whether the axis is held; one that is not free else is of an inactive node.
    pub fn is_held(&self, axis: usize) -> bool {
        !self.free[axis] && self.mass.get(axis / 3) > 0.0
    }

    /// The velocity before (m/s), to the digits of the run.
    #[inline]
    pub fn velocity(&self, axis: usize) -> f64 {
        self.rate * self.step.get(axis)
    }

    /// The damping coefficient of an axis (kg/s).
    pub fn damping(&self, axis: usize) -> f64 {
        if self.damping.is_empty() { 0.0 } else { self.damping.get(axis / 3) }
    }

    /// y = u + h v (m), to the digits of the run.
    pub fn predicted(&self, axis: usize, h: f64) -> f64 {
        let u = self.u.get(axis);
        if self.free[axis] { u + h * self.velocity(axis) } else { u }
    }

    /// The velocity (m/s) and acceleration (m/s²) at the end of a step of h, of an axis that is so far from y then (m),
    /// and had a velocity and an acceleration before.
    #[inline]
    pub fn arrival(
        &self,
        formula: &Formula,
        axis: usize,
        h: f64,
        (correction, velocity, before): (f64, f64, f64),
    ) -> (f64, f64) {
        if formula.is_of_rest() {
            return (0.0, 0.0);
        }
        if !self.free[axis] {
            return (if self.is_held(axis) { correction / h } else { 0.0 }, 0.0);
        }
        let acceleration = formula.acceleration(h, correction, before);
        (formula.velocity(h, velocity, [before, acceleration]), acceleration)
    }

    /// D in a step of h.
    pub fn inertia(&self, formula: &Formula, h: f64) -> Inertia<'_> {
        let Self { mass, damping, .. } = self;
        let (per_mass, per_damping) = (formula.inertia(h, 1.0, 0.0), formula.inertia(h, 0.0, 1.0));
        Inertia { mass, damping, per_mass, per_damping }
    }

    /// What is constant of the equation of an axis (N) beside D (w − y) and the forces at the end; `before` gives its
    /// acceleration (m/s²) and F − R (N) before.
    fn constant(&self, formula: &Formula, h: f64, axis: usize, before: impl FnOnce() -> (f64, f64)) -> f64 {
        if !self.free[axis] || !formula.needs_acceleration() && self.damping.is_empty() {
            return 0.0;
        }
        let (mass, damping, velocity) = (self.mass.get(axis / 3), self.damping(axis), self.velocity(axis));
        let (acceleration, force) = before();
        let (after, arrives) = self.arrival(formula, axis, h, (0.0, velocity, acceleration));
        let inertial = formula.inertial_force(mass, damping, [velocity, after], [acceleration, arrives]);
        inertial + formula.alpha_f * force
    }
}

/// What a step begins with beside its motion.
#[derive(Clone, Copy)]
pub(super) struct Before<'a> {
    pub axes: &'a Axes,
    /// The columns of accelerations are in it.
    pub world: &'a World,
    pub forces: &'a ForcesBefore,
}

impl Before<'_> {
    /// Gives each axis with what is constant of its equation (N).
    fn each_constant(&self, place: &Place<'_>, mut take: impl FnMut(usize, f64)) {
        let Place { formula, h, motion, .. } = place;
        for (body, range) in self.axes.each() {
            let acceleration = acceleration_before(self.world, body);
            for axis in range.clone() {
                let before = || (acceleration(axis - range.start), self.forces.net(axis));
                take(axis, motion.constant(formula, *h, axis, before));
            }
        }
    }
}

impl Place<'_> {
    /// What inertia, damping and the forces before make of the equations of free axes (N): its norm.
    pub fn inertial_forces(&self, before: &Before<'_>) -> f64 {
        let Self { formula, h, motion, .. } = self;
        let (inertia, mut square) = (motion.inertia(formula, *h), 0.0);
        before.each_constant(self, |axis, constant| {
            if motion.free[axis] {
                square += (constant + inertia.of(axis / 3) * self.correction(axis)).powi(2);
            }
        });
        square.sqrt()
    }

    /// The residual of all free axes there (N), from the forces there.
    pub fn fill_residual(&self, net: &Reals, before: &Before<'_>, residual: &mut Reals) {
        let Self { formula, h, motion, correction, .. } = self;
        let (stiffness, inertia) = (formula.stiffness(), motion.inertia(formula, *h));
        with_numbers!(residual, T => {
            let (net, correction, residual) = (net.slice::<T>(), correction.slice::<T>(), residual.slice_mut::<T>());
            before.each_constant(self, |axis, constant| {
                let of_inertia = || inertia.of(axis / 3) * correction[axis].to_f64();
                residual[axis] = match motion.free[axis] {
                    true => T::from_f64(constant + of_inertia() + stiffness * net[axis].to_f64()),
                    false => T::default(),
                };
            });
        });
    }
}
