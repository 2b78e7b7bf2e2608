//! Parts of an implicit step by themselves, at a simulation's present state, for tests from outside
//! (`tests/physics/implicit_parts.rs`): unit tests that make simulations have all of the engine compiled once more.

use super::axes::{Axes, Motion};
use super::differences::difference;
use super::formula::Formula;
use super::place::Place;
use super::preconditioner::{Operator, Preconditioner, SpringSlope, TwoLevel};
use super::springs::Springs;
use super::trial::Trial;
use crate::Simulation;
use crate::backend::cpu::Cpu;
use crate::components::{Displacement, Reals};
use crate::error::Error;
use crate::scene::schema::ImplicitScheme;
use bevy_ecs::prelude::*;
use glam::DMat3;
use std::ops::Range;

impl Simulation {
    /// K p (N) of motions p (m) by differences of forces at displacements w (m): of all axes of all nodes in the order
    /// of rows, bodies one after the other. Nothing where an element is turned inside out.
    ///
    /// # Errors
    /// What systems say.
    #[doc(hidden)]
    pub fn stiffness_by_differences(&mut self, w: &[f64], motions: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, Error> {
        let axes = Axes::of(&mut self.world);
        let (mut motion, formula, h) = (axes.motion(), Formula::of(ImplicitScheme::Euler), 0.01);
        axes.read(&self.world, &mut motion);
        let mut correction = axes.zeros();
        w.iter().enumerate().for_each(|(axis, w)| correction.set(axis, w - motion.predicted(axis, h)));
        let place = Place { formula: &formula, h, motion: &motion, correction: &correction, beyond: None };
        let (mut net, mut springs) = (axes.zeros(), Springs::default());
        let mut trial = Trial {
            world: &mut self.world,
            passes: &mut self.entries,
            axes: &axes,
            springs: &mut springs,
            step: 0,
            count: 0,
            elsewhere: false,
        };
        if !trial.forces(&place, &mut net)? {
            return Ok(Vec::new());
        }
        let product = |p: &Vec<f64>| {
            let (p, mut image) = (Reals::from_f64(axes.precision(), p.iter().copied()), axes.zeros());
            difference(&mut trial, &place, &net, &p, &mut image)?;
            Ok(numbers(&image))
        };
        motions.iter().map(product).collect()
    }
}

/// The numbers of a vector, widened.
fn numbers(vector: &Reals) -> Vec<f64> {
    (0..vector.len()).map(|axis| vector.get(axis)).collect()
}

/// The preconditioner of two levels of D + K, by itself.
#[doc(hidden)]
pub struct TwoLevelParts {
    axes: Axes,
    motion: Motion,
    formula: Formula,
    h: f64,
    two_level: TwoLevel,
}

impl TwoLevelParts {
    /// Of a step of implicit Euler of so many seconds.
    pub fn of(simulation: &mut Simulation, h: f64) -> Self {
        let axes = Axes::of(&mut simulation.world);
        let mut motion = axes.motion();
        axes.read(&simulation.world, &mut motion);
        let two_level = TwoLevel::of(axes.precision());
        Self { axes, motion, formula: Formula::of(ImplicitScheme::Euler), h, two_level }
    }

    /// The bodies, and which axes are theirs.
    pub fn bodies(&self) -> Vec<(Entity, Range<usize>)> {
        self.axes.each().collect()
    }

    /// Whether each axis moves freely.
    pub fn free(&self) -> &[bool] {
        &self.motion.free
    }

    /// The inertia of a node (N/m).
    pub fn inertia(&self, node: usize) -> f64 {
        self.motion.inertia(&self.formula, self.h).of(node)
    }

    /// Puts all nodes where they are displaced to (m).
    pub fn displace(&self, simulation: &mut Simulation, u: &[f64]) {
        for (body, range) in self.axes.each() {
            if let Some(mut column) = simulation.world.get_mut::<Displacement>(body) {
                u[range].iter().enumerate().for_each(|(axis, u)| column.set(axis, *u));
            }
        }
    }

    /// Follows the state, with springs: first axes of their nodes with signed weights, and slopes (N/m). Whether
    /// something has turned.
    pub fn follow(&mut self, simulation: &Simulation, springs: &[(Vec<(usize, f64)>, DMat3)]) -> bool {
        let slopes = springs.iter().map(|(parts, slope)| SpringSlope { parts, slope: *slope });
        self.two_level.follow(&Operator {
            world: &simulation.world,
            bodies: &self.axes.bodies,
            free: &self.motion.free,
            inertia: self.motion.inertia(&self.formula, self.h),
            stiffness: 1.0,
            springs: &slopes.collect::<Vec<_>>(),
        });
        self.two_level.is_turned()
    }

    /// z = B r (m) of a residual r (N).
    pub fn apply(&mut self, simulation: &Simulation, residual: &[f64]) -> Vec<f64> {
        let residual = Reals::from_f64(self.axes.precision(), residual.iter().copied());
        let mut z = self.axes.zeros();
        self.two_level.apply(simulation.world.resource::<Cpu>(), &residual, &mut z);
        numbers(&z)
    }

    /// Of each piece the rigid motions P of its aggregates, and Pᵀ K P: columns from the diagonal down.
    pub fn coarse(&self) -> Vec<(Vec<Vec<f64>>, Vec<f64>)> {
        let of = self.two_level.coarse();
        of.into_iter().map(|coarse| (coarse.motions(&self.motion.free), coarse.stiffness.clone())).collect()
    }
}
