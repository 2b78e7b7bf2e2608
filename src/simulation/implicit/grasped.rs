//! Axes that closed tools hold: held as if they were told where to go.

use super::axes::{Axes, Motion};
use super::forces_before::ForcesBefore;
use super::place::Place;
use super::to_go::ToGo;
use crate::components::{DisplacementCompensation, ExternalForce, Grasps, InternalForce, Reals, WORK_NUMBERS, Work};
use crate::systems::{Given, HeldNode, held_in_step, note_held};
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
    /// rest, where nothing was before, forces alone. Tools work by what their nodes get, with the mean of the forces at
    /// both ends as all do; the kinetic energy of that is added to the work of constraints, which has the rest.
    pub fn note(&self, world: &mut World, place: &Place<'_>, net: &Reals, before: Option<&ForcesBefore>) {
        let Place { h, motion, .. } = place;
        for (node, first, own) in &self.0 {
            let (mut force, mut given, mut kinetic) = (DVec3::ZERO, Given::default(), 0.0);
            for i in (0..3).filter(|&i| own[i]) {
                let axis = first + i;
                // it is held: an acceleration before does not count, and at rest there is no velocity
                let (began, ends) = (motion.velocity(axis), place.arrival(axis, 0.0).0);
                let (mass, damping) = (motion.mass.get(axis / 3), motion.damping(axis));
                force[i] = net.get(axis) + mass * (ends - began) / h + damping * ends;
                let Some(before) = before else { continue };
                let balances = 0.5 * (before.net(axis) + net.get(axis) + damping * (began + ends));
                let gains = 0.5 * mass * (ends * ends - began * began);
                kinetic += gains;
                given.work += balances * place.moved(axis) + gains;
                given.by_a_jolt += 0.5 * mass * (ends - began).powi(2);
            }
            if let Some(mut work) = world.get_mut::<Work>(node.body) {
                let of_constraints = WORK_NUMBERS * node.row + 2;
                let sum = work.get(of_constraints) + kinetic;
                work.set(of_constraints, sum);
            }
            note_held(world, node, force, before.map(|_| given));
        }
    }
}
