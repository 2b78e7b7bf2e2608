//! Axes that closed tools hold: held as if they were told where to go.

use super::axes::{Axes, Motion, acceleration_before};
use super::place::Place;
use super::to_go::ToGo;
use crate::components::{DisplacementCompensation, ExternalForce, Grasps, InternalForce, Reals};
use crate::systems::{HeldNode, held_in_step, note_held};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Nodes that tools hold in a step, with the first of their axes.
pub(super) struct Grasped(Vec<(HeldNode, usize, [bool; 3])>);

impl Grasped {
    /// Holds the free axes of nodes that closed tools hold, and says how far they have to go (m).
    pub fn hold(world: &mut World, axes: &Axes, motion: &mut Motion, to_go: &mut ToGo) -> Self {
        let mut all = Vec::new();
        // a step asks for no memory for what is not there
        if !axes.bodies.iter().any(|&body| world.get::<Grasps>(body).is_some()) {
            return Self(all);
        }
        for node in held_in_step(world) {
            let Some((_, range)) = axes.each().find(|(body, _)| *body == node.body) else { continue };
            let first = range.start + 3 * node.row;
            let mut own = [false; 3];
            for (i, to) in node.displacement.to_array().into_iter().enumerate() {
                let axis = first + i;
                own[i] = motion.free[axis];
                if own[i] {
                    motion.free[axis] = false;
                    let lost = world.get::<DisplacementCompensation>(node.body);
                    let lost = lost.map_or(0.0, |lost| lost.get(3 * node.row + i));
                    to_go.push(axis, to - (motion.u.get(axis) - lost));
                }
            }
            all.push((node, first, own));
        }
        Self(all)
    }

    /// Makes the forces of tools loads at rest, where they balance those of elements and all others.
    pub fn load(&self, world: &mut World) {
        for (HeldNode { body, row, .. }, _, own) in &self.0 {
            let Some(internal) = world.get::<InternalForce>(*body).map(|internal| internal.vector(*row)) else {
                continue;
            };
            let Some(mut external) = world.get_mut::<ExternalForce>(*body) else { continue };
            for i in (0..3).filter(|&i| own[i]) {
                external.set(3 * row + i, internal[i]);
            }
        }
    }

    /// Notes the forces of tools at the end of a step of h (s): what balances forces, damping and inertia there; at
    /// rest forces alone.
    pub fn note(&self, world: &mut World, place: &Place<'_>, net: &Reals) {
        let Place { formula, h, motion, .. } = place;
        for (node, first, own) in &self.0 {
            let of_axis = |i: usize| {
                let axis = first + i;
                let acceleration = acceleration_before(world, node.body);
                let (before, velocity) = (motion.velocity(axis), place.arrival(axis, acceleration(3 * node.row + i)).0);
                let (mass, damping) = (motion.mass.get(axis / 3), motion.damping(axis));
                let inertial = mass * (velocity - before) / h + damping * velocity;
                let inertial = if formula.is_of_rest() { 0.0 } else { inertial };
                if own[i] { net.get(axis) + inertial } else { 0.0 }
            };
            note_held(world, node, DVec3::from_array([0, 1, 2].map(of_axis)));
        }
    }
}
