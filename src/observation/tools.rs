//! What tools feel.

use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What a tool feels of all bodies that it touches, in the step that has just been taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ToolReading {
    /// The force on it (N).
    pub force: DVec3,
    /// The moment of this force about its origin (N m).
    pub torque: DVec3,
    /// Where its origin is (m).
    pub place: DVec3,
    /// How many nodes it touches or holds.
    pub nodes: usize,
    /// How deep the deepest of the nodes that it may touch is inside it (m); 0 where none is.
    pub penetration: f64,
    /// The work that it has done since the start (J).
    pub work: f64,
    /// What of this work impact, friction and catching nodes have taken (J).
    pub loss: f64,
}

/// What a tool feels. Forces are those of the beginning of the step that led here, and act there.
///
/// # Errors
/// What the GPU says.
pub fn read_tool(world: &mut World, tool: &str) -> Result<ToolReading, Error> {
    let wanted = [ToolTouch::NAME, ToolHold::NAME, Displacement::NAME, DisplacementIncrement::NAME];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    let clock = *world.resource::<Clock>();
    let now = match &clock.relaxation {
        Some(relaxation) => world.resource::<Signals>().poses_at_share(relaxation.end, relaxation.share(clock.step)),
        None => world.resource::<Signals>().poses_at(clock.time()),
    };
    let mut reading = ToolReading::default();
    let mut bodies = world.query::<(&ToolContacts, &ToolTouch, &RestPosition, &Displacement, &DisplacementIncrement)>();
    for (contacts, touch, rest, u, step) in bodies.iter(world) {
        for (number, contact) in contacts.tools.iter().enumerate().filter(|(_, contact)| contact.tool == tool) {
            let Some(pose) = now.iter().find(|(slot, _)| *slot == contact.signal).map(|(_, pose)| *pose) else {
                continue;
            };
            reading.place = pose.at + contacts.reference;
            let ball = contact.geometry.bounding_sphere().map(|(center, radius)| (pose.place(center), radius));
            for (place, (&row, &mask)) in contacts.rows.iter().zip(&contacts.masks).enumerate() {
                if mask >> number & 1 == 0 {
                    continue;
                }
                let row = row as usize;
                let at = contacts.numbers_a_tool() * (contacts.tools.len() * place + number);
                let number = |i: usize| touch.get(at + i);
                reading.work += number(5);
                reading.loss += number(6);
                let end = rest.0[row] - contacts.reference + u.vector(row);
                // who is outside a ball around all of it is not inside
                if ball.is_none_or(|(center, radius)| end.distance_squared(center) <= radius * radius) {
                    let distance = contact.geometry.distance(pose.inverse(end)).0;
                    reading.penetration = reading.penetration.max(-distance);
                }
                if number(3) > 0.0 {
                    let force = -DVec3::new(number(0), number(1), number(2));
                    reading.nodes += 1;
                    reading.force += force;
                    reading.torque += (end - step.vector(row) - pose.at).cross(force);
                }
            }
        }
    }
    super::grasps::read(world, tool, &now, &mut reading);
    Ok(reading)
}

/// What the tool of a hand felt in a batch of steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Felt {
    /// The mean of the force on it (N).
    pub force: DVec3,
    /// The moment of this force about its origin, where nodes and tool are at the end (N m).
    pub torque: DVec3,
    /// Whether it touched anything.
    pub in_contact: bool,
}

/// What the tools of hands felt in so many steps; another batch begins for each tool that is asked for.
///
/// # Errors
/// What the GPU says.
pub fn feel(world: &mut World, tool: &str, steps: u64) -> Result<Felt, Error> {
    bring_to_host(world, |_, name| [ToolTouch::NAME, ToolHold::NAME, Displacement::NAME].contains(&name))?;
    let now = world.resource::<Signals>().poses_at(world.resource::<Clock>().time());
    let mut felt = Felt::default();
    let mut bodies = world.query::<(&ToolContacts, &mut ToolTouch, &RestPosition, &Displacement)>();
    for (contacts, mut touch, rest, u) in bodies.iter_mut(world).filter(|(contacts, ..)| contacts.felt) {
        let numbers = contacts.numbers_a_tool();
        for (bit, contact) in contacts.tools.iter().enumerate().filter(|(_, contact)| contact.tool == tool) {
            let Some(at) = now.iter().find(|(slot, _)| *slot == contact.signal).map(|(_, pose)| pose.at) else {
                continue;
            };
            for (place, &row) in contacts.rows.iter().enumerate() {
                let first = numbers * (contacts.tools.len() * place + bit) + TOUCH_NUMBERS;
                let force = -DVec3::from_array([0, 1, 2].map(|i| touch.get(first + i))) / steps as f64;
                if force == DVec3::ZERO {
                    continue;
                }
                (0..FELT_NUMBERS).for_each(|i| touch.set(first + i, 0.0));
                let end = rest.0[row as usize] - contacts.reference + u.vector(row as usize);
                felt.force += force;
                felt.torque += (end - at).cross(force);
                felt.in_contact = true;
            }
        }
    }
    super::grasps::feel(world, tool, &now, steps, &mut felt);
    if felt.in_contact {
        send_to_device(world, |_, name| name == ToolTouch::NAME || name == ToolHold::NAME)?;
    }
    Ok(felt)
}
