//! Tools that move freely: how they move, what they feel, and what their energies add.

use super::tools::{FreeReading, ToolReading};
use crate::components::*;
use bevy_ecs::prelude::*;
use glam::{DQuat, DVec3};

/// A free tool of a name, with how it moves and the point from which it is counted.
fn found<'a>(world: &'a World, name: &str) -> Option<(&'a FreeTool, &'a FreeMotion, DVec3)> {
    let tools = world.get_resource::<FreeTools>()?;
    let place = tools.place(name)?;
    let state = world.get_resource::<FreeMotions>()?.all.get(place)?;
    Some((&tools.all[place], state, tools.reference))
}

/// What a free tool of a name feels; nothing of one that is guided. Displacements are on the host.
pub(super) fn read(world: &World, name: &str) -> Option<ToolReading> {
    let (tool, state, reference) = found(world, name)?;
    let pose = tool.pose(&state.motion);
    let (force, moment) = state.felt();
    // where it was when forces acted
    let clock = world.resource::<Clock>();
    let earlier = tool.pose(&state.motion.after(-clock.last_step(), &tool.inertia));
    let center = earlier.place(tool.inertia.center);
    let free = FreeReading {
        mass: tool.inertia.mass,
        center: state.motion.place + reference,
        velocity: state.motion.velocity,
        spin: state.motion.spin(&tool.inertia),
        angular_momentum: state.motion.momentum,
        kinetic: state.motion.kinetic(&tool.inertia),
        potential: -state.gravity_work,
        damping_loss: state.damping_loss,
    };
    Some(ToolReading {
        force,
        torque: moment + (center - earlier.at).cross(force),
        place: pose.at + reference,
        nodes: state.touches.len(),
        slipped: 0,
        penetration: penetration(world, tool, &pose, reference),
        suction: DVec3::ZERO,
        work: clock.relaxation.is_none().then_some(-state.contact_work),
        loss: clock.relaxation.is_none().then(|| lost(world, tool, state)),
        waiting: 0.0,
        free: Some(free),
    })
}

/// How deep the deepest node is inside a tool (m).
fn penetration(world: &World, tool: &FreeTool, pose: &Pose, reference: DVec3) -> f64 {
    let Some((center, radius)) = tool.geometry.bounding_sphere() else { return 0.0 };
    let center = pose.place(center);
    let mut deepest = 0.0_f64;
    for met in &tool.meets {
        let columns =
            (world.get::<RestPosition>(met.body), world.get::<Displacement>(met.body), world.get::<Mass>(met.body));
        let (Some(rest), Some(u), Some(mass)) = columns else { continue };
        for row in met.rows.iter().map(|&row| row as usize).filter(|&row| mass.get(row) > 0.0) {
            let place = rest.0[row] - reference + u.vector(row);
            if place.distance_squared(center) <= radius * radius {
                deepest = deepest.max(-tool.geometry.distance(pose.inverse(place)).0);
            }
        }
    }
    deepest
}

/// Where a tool's origin is (m), and how it is turned.
pub(super) fn pose_of(world: &World, name: &str) -> Option<(DVec3, DQuat)> {
    let (tool, state, reference) = found(world, name)?;
    Some((tool.pose(&state.motion).at + reference, state.motion.turn))
}

/// Velocity of a tool's origin (m/s) and how fast it turns (rad/s), in the middle of the last step.
pub(super) fn velocity_of(world: &World, name: &str) -> Option<(DVec3, DVec3)> {
    let (tool, state, _) = found(world, name)?;
    let spin = state.motion.spin(&tool.inertia);
    let arm = tool.pose(&state.motion).at - state.motion.place;
    Some((state.motion.velocity + spin.cross(arm), spin))
}

/// What free tools do to the nodes of a body (N), added to its rows.
pub(super) fn add_forces(world: &World, body: Entity, forces: &mut [DVec3]) {
    let (Some(tools), Some(motions)) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>()) else {
        return;
    };
    for (tool, state) in tools.all.iter().zip(&motions.all) {
        for touch in &state.touches {
            if tool.meets[touch.node.0 as usize].body == body {
                forces[touch.node.1 as usize] += touch.force;
            }
        }
    }
}

/// How far the nodes of a body have slipped along free tools since the start (m), added to its rows.
pub(super) fn add_slips(world: &World, body: Entity, slid: &mut [f64]) {
    let (tools, motions) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>());
    let Some((tools, motions)) = tools.zip(motions) else { return };
    for (tool, state) in tools.all.iter().zip(&motions.all) {
        for &((place, row), length) in &state.slid {
            if tool.meets[place as usize].body == body {
                slid[row as usize] += length;
            }
        }
    }
}

/// What contact with each has taken since the start (J). Steps of nodes are on the host.
pub(super) fn losses(world: &World) -> Vec<f64> {
    let (tools, motions) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>());
    let Some((tools, motions)) = tools.zip(motions) else { return Vec::new() };
    tools.all.iter().zip(&motions.all).map(|(tool, state)| lost(world, tool, state)).collect()
}

/// What contact with one has taken since the start (J), with the second half of what forces on nodes did in their last
/// step.
fn lost(world: &World, tool: &FreeTool, state: &FreeMotion) -> f64 {
    let step = |body, row| world.get::<DisplacementIncrement>(body).map_or(DVec3::ZERO, |steps| steps.vector(row));
    state.contact_loss - state.work_of_half(tool, world.resource::<Clock>().time_step, step)
}

/// Kinetic energy of all (J).
pub(super) fn kinetic(world: &World) -> f64 {
    let (Some(tools), Some(motions)) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>()) else {
        return 0.0;
    };
    tools.all.iter().zip(&motions.all).map(|(tool, state)| state.motion.kinetic(&tool.inertia)).sum()
}

/// What contacts of free tools gave (J), of each such a share at most of what gravity would do on it over a way as long
/// as its radius of gyration: of tools that rest on something nothing else tells what is much. Steps of nodes are on
/// the host.
pub(super) fn given_by_weight(world: &World, share: f64) -> f64 {
    let (tools, motions) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>());
    let (Some((tools, motions)), Some(signals)) = (tools.zip(motions), world.get_resource::<Signals>()) else {
        return 0.0;
    };
    let of_tool = |(tool, state): (&FreeTool, &FreeMotion)| {
        let gravity = tool.gravity.iter().map(|&slot| DVec3::from_slice(&signals.values()[slot][..3])).sum::<DVec3>();
        let moments = tool.inertia.moments;
        let sum = moments.x_axis.x + moments.y_axis.y + moments.z_axis.z;
        let of_weight = gravity.length() * (0.5 * sum * tool.inertia.mass).sqrt();
        (-lost(world, tool, state)).max(0.0).min(share * of_weight)
    };
    tools.all.iter().zip(&motions.all).map(of_tool).sum()
}

/// Adds to the energies of bodies those of free tools: work done on them counts with that of loads, where it is
/// counted.
pub(super) fn add_energies(world: &World, sum: &mut Energies) {
    sum.kinetic += kinetic(world);
    for state in world.get_resource::<FreeMotions>().iter().flat_map(|motions| &motions.all) {
        if let Some(work) = &mut sum.load_work {
            *work += state.gravity_work + state.contact_work;
        }
        if let Some(loss) = &mut sum.damping_loss {
            *loss += state.damping_loss;
        }
    }
}
