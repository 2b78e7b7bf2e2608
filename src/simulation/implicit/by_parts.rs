//! Parts of an implicit step by themselves, at a simulation's present state, for tests from outside
//! (`tests/physics/implicit_parts.rs`): unit tests that make simulations have all of the engine compiled once more.

use super::axes::{Axes, Motion};
use super::differences::difference;
use super::formula::Formula;
use super::preconditioner::{Operator, Preconditioner, SpringSlope, TwoLevel};
use super::springs::Springs;
use super::trial::Trial;
use crate::Simulation;
use crate::backend::cpu::Cpu;
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
        let (mut motion, formula) = (Motion::default(), Formula::of(ImplicitScheme::Euler));
        axes.read(&self.world, &mut motion);
        let zeros = || vec![0.0; w.len()];
        let (mut net, mut elsewhere, mut steps, mut springs) = (zeros(), zeros(), zeros(), Springs::default());
        let mut trial = Trial {
            world: &mut self.world,
            passes: &mut self.entries,
            axes: &axes,
            springs: &mut springs,
            step: 0,
            count: 0,
            elsewhere: false,
        };
        if !trial.forces(w, None, &mut net)? {
            return Ok(Vec::new());
        }
        let product = |p: &Vec<f64>| {
            let mut image = zeros();
            let of_step = (&formula, 0.01, &motion);
            difference(&mut trial, of_step, (w, &net), &mut elsewhere, &mut steps, p, &mut image)?;
            Ok(image)
        };
        motions.iter().map(product).collect()
    }
}

/// The preconditioner of two levels of D + K, by itself.
#[doc(hidden)]
pub struct TwoLevelParts {
    axes: Axes,
    motion: Motion,
    inertia: Vec<f64>,
    two_level: TwoLevel,
}

impl TwoLevelParts {
    /// With so much inertia (N/m) for each kg.
    pub fn of(simulation: &mut Simulation, per_mass: f64) -> Self {
        let axes = Axes::of(&mut simulation.world);
        let mut motion = Motion::default();
        axes.read(&simulation.world, &mut motion);
        let inertia = motion.mass.iter().map(|mass| mass * per_mass).collect();
        Self { axes, motion, inertia, two_level: TwoLevel::default() }
    }

    /// The bodies, and which axes are theirs.
    pub fn bodies(&self) -> Vec<(Entity, Range<usize>)> {
        self.axes.each().collect()
    }

    /// Whether each axis moves freely.
    pub fn free(&self) -> &[bool] {
        &self.motion.free
    }

    /// The inertia of each node (N/m).
    pub fn inertia(&self) -> &[f64] {
        &self.inertia
    }

    /// Puts all nodes where they are displaced to (m).
    pub fn displace(&self, simulation: &mut Simulation, u: &[f64]) {
        self.axes.displace(&mut simulation.world, u);
    }

    /// Follows the state, with springs: first axes of their nodes with signed weights, and slopes (N/m). Whether
    /// something has turned.
    pub fn follow(&mut self, simulation: &Simulation, springs: &[(Vec<(usize, f64)>, DMat3)]) -> bool {
        let slopes = springs.iter().map(|(parts, slope)| SpringSlope { parts, slope: *slope });
        self.two_level.follow(&Operator {
            world: &simulation.world,
            bodies: &self.axes.bodies,
            free: &self.motion.free,
            inertia: &self.inertia,
            stiffness: 1.0,
            springs: &slopes.collect::<Vec<_>>(),
        });
        self.two_level.is_turned()
    }

    /// z = B r (m) of a residual r (N).
    pub fn apply(&mut self, simulation: &Simulation, residual: &[f64]) -> Vec<f64> {
        let mut z = vec![0.0; residual.len()];
        self.two_level.apply(simulation.world.resource::<Cpu>(), residual, &mut z);
        z
    }

    /// Of each piece the rigid motions P of its aggregates, and Pᵀ K P: columns from the diagonal down.
    pub fn coarse(&self) -> Vec<(Vec<Vec<f64>>, Vec<f64>)> {
        let of = self.two_level.coarse();
        of.into_iter().map(|coarse| (coarse.motions(&self.motion.free), coarse.stiffness.clone())).collect()
    }
}
