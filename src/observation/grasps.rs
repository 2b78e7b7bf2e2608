//! What tools feel of the nodes that they hold.

use super::tools::{Felt, ToolReading};
use crate::components::*;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Adds what a tool feels of what it holds, with all columns on the host and tools where they are now.
pub(super) fn read(world: &mut World, tool: &str, now: &[(usize, Pose)], reading: &mut ToolReading) {
    let mut bodies = world.query::<(&Grasps, &ToolHold, &Mass, &RestPosition, &Displacement)>();
    for (grasps, hold, mass, rest, u) in bodies.iter(world) {
        for (number, grasp) in grasps.grasps.iter().enumerate().filter(|(_, grasp)| grasp.tool.tool == tool) {
            let Some(pose) = now.iter().find(|(slot, _)| *slot == grasp.tool.signal).map(|(_, pose)| *pose) else {
                continue;
            };
            for (place, &row) in grasps.rows.iter().enumerate() {
                let (first, row) = (grasps.numbers() * place + grasps.numbers_a_grasp() * number, row as usize);
                reading.spend(hold.get(first + 4), hold.get(first + 5));
                // nodes whose elements are gone are held by nobody
                let is_there = mass.get(row) > 0.0;
                let (holds, force) = (hold.get(first + 3), -hold.vector_at(first));
                reading.slipped += usize::from(is_there && ToolHold::has_slipped(holds));
                // who slips out, or loses its elements, is held to the end of the step
                if is_there && holds == ToolHold::HELD || force != DVec3::ZERO {
                    let end = rest.0[row] - grasps.reference + u.vector(row);
                    reading.nodes += 1;
                    reading.force += force;
                    reading.torque += (end - pose.at).cross(force);
                }
            }
        }
    }
}

/// Adds what the tool of a hand felt in so many steps of what it holds, of which another batch begins.
pub(super) fn feel(world: &mut World, tool: &str, now: &[(usize, Pose)], steps: u64, felt: &mut Felt) {
    let mut bodies = world.query::<(&Grasps, &mut ToolHold, &RestPosition, &Displacement)>();
    for (grasps, mut hold, rest, u) in bodies.iter_mut(world).filter(|(grasps, ..)| grasps.felt) {
        for (number, grasp) in grasps.grasps.iter().enumerate().filter(|(_, grasp)| grasp.tool.tool == tool) {
            let Some(at) = now.iter().find(|(slot, _)| *slot == grasp.tool.signal).map(|(_, pose)| pose.at) else {
                continue;
            };
            for (place, &row) in grasps.rows.iter().enumerate() {
                let first = grasps.numbers() * place + grasps.numbers_a_grasp() * number + HOLD_NUMBERS;
                let force = -hold.vector_at(first) / steps as f64;
                if force == DVec3::ZERO {
                    continue;
                }
                hold.set_vector_at(first, DVec3::ZERO);
                let end = rest.0[row as usize] - grasps.reference + u.vector(row as usize);
                felt.force += force;
                felt.torque += (end - at).cross(force);
                felt.in_contact = true;
            }
        }
    }
}

/// Adds what tools do to each node that they hold (N), by rows.
pub(super) fn forces(entity: EntityRef<'_>, forces: &mut [DVec3]) {
    let (Some(grasps), Some(hold)) = (entity.get::<Grasps>(), entity.get::<ToolHold>()) else { return };
    for (place, &row) in grasps.rows.iter().enumerate() {
        let first = grasps.numbers() * place;
        let of_grasp = |number: usize| hold.vector_at(first + grasps.numbers_a_grasp() * number);
        forces[row as usize] += (0..grasps.grasps.len()).map(of_grasp).sum::<DVec3>();
    }
}
