//! Springs of contact, and threads, where forces are tried. Which of them touch, and which stick or slide, is that of
//! the place at which a Newton iteration takes its tangent: a difference of forces would see some let go, others not.

use super::axes::Axes;
use super::formula::Formula;
use super::preconditioner::SpringSlope;
use crate::components::{Clock, Reals, SpringForces, TouchingSpring};
use crate::error::Error;
use crate::systems::{find_surface_springs, find_thread_springs, find_ties, find_tool_springs, seek_surfaces};
use bevy_ecs::prelude::*;

/// What springs resist of a motion at least, as a share of what they would across its way, beyond rounding.
const RESISTS: f64 = 1e-12;

/// Those that touch.
#[derive(Default)]
pub(super) struct Springs {
    touching: Vec<TouchingSpring>,
    /// Ties that hold, whose forces the columns of forces have: for preconditioners.
    ties: Vec<TouchingSpring>,
}

impl Springs {
    /// Looks which points of surfaces may touch what in the step that begins. Whether there are bodies that may.
    pub fn seek(world: &mut World) -> Result<bool, Error> {
        match &mut world.resource_mut::<Clock>().springs {
            Some(springs) => springs.forces = SpringForces::Sought,
            None => return Ok(false),
        }
        seek_surfaces(world)
    }

    /// Finds those that touch where nodes are, after the systems have found forces there.
    pub fn find(&mut self, world: &mut World, axes: &Axes) {
        self.touching.clear();
        self.ties.clear();
        if world.resource::<Clock>().springs.is_none() {
            return;
        }
        let first_axis = |body| axes.each().find(|(other, _)| *other == body).map(|(_, range)| range.start);
        find_surface_springs(world, first_axis, &mut self.touching);
        find_tool_springs(world, first_axis, &mut self.touching);
        find_thread_springs(world, first_axis, &mut self.touching);
        find_ties(world, first_axis, &mut self.ties);
    }

    /// Each that touches.
    pub fn touching(&self) -> &[TouchingSpring] {
        &self.touching
    }

    /// Takes a share of their forces from the residual (N) of free axes.
    pub fn press(&self, share: f64, free: &[bool], residual: &mut Reals) {
        for spring in &self.touching {
            spring.add(spring.force * -share, residual);
            for axis in spring.parts.iter().flat_map(|&(first, _)| first..first + 3).filter(|&axis| !free[axis]) {
                residual.set(axis, 0.0);
            }
        }
    }

    /// Adds their forces to loads (N).
    pub fn load(&self, external: &mut Reals) {
        self.touching.iter().for_each(|spring| spring.add(spring.force, external));
    }

    /// Adds a share of their part of K p (N) to that of the rest, where an axis that moves by 1 m makes a step of so
    /// many m.
    pub fn add_product(&self, share: f64, step: f64, p: &Reals, image: &mut Reals) {
        for spring in &self.touching {
            let [of_place, of_step] = spring.slopes;
            spring.add((of_place + of_step * step) * spring.relative(p) * share, image);
        }
    }

    /// Those that touch and ties that hold, with slopes as the formula of a step has them (N/m). Not ties at rest: the
    /// blocks of nodes would know of them, and nothing else (three times the iterations of two glued blocks).
    pub fn slopes(&self, formula: &Formula) -> Vec<SpringSlope<'_>> {
        let (share, step) = (formula.stiffness(), formula.step());
        let slope = |spring: &TouchingSpring| (spring.slopes[0] + spring.slopes[1] * step) * share;
        let ties = if formula.is_of_rest() { &[][..] } else { &self.ties };
        let all = self.touching.iter().chain(ties);
        all.map(|spring| SpringSlope { parts: &spring.parts, slope: slope(spring) }).collect()
    }

    /// Whether they resist a motion of all axes (m).
    pub fn resist(&self, motion: &Reals) -> bool {
        let (mut resists, mut most) = (0.0, 0.0);
        for spring in &self.touching {
            let [of_place, of_step] = spring.slopes;
            let (slope, way) = (of_place + of_step, spring.relative(motion));
            resists += way.dot(slope * way);
            most += way.length_squared() * slope.to_cols_array().iter().map(|entry| entry.abs()).fold(0.0, f64::max);
        }
        resists > RESISTS * most
    }

    /// The sum of the squares of their forces (N²).
    pub fn square(&self) -> f64 {
        self.touching.iter().map(|spring| spring.force.length_squared()).sum()
    }
}
