//! What tools feel.

use crate::backend::device::bring_to_host;
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
    /// How many nodes it touches.
    pub nodes: usize,
    /// How deep the deepest of the nodes that it may touch is inside it (m); 0 where none is.
    pub penetration: f64,
    /// The work that it has done since the start (J).
    pub work: f64,
    /// What of this work impact and friction have taken (J).
    pub loss: f64,
}

/// What a tool feels. Forces are those of the beginning of the step that led here, and act there.
///
/// # Errors
/// What the GPU says.
pub fn read_tool(world: &mut World, tool: &str) -> Result<ToolReading, Error> {
    bring_to_host(world, |_, name| [ToolTouch::NAME, Displacement::NAME, DisplacementIncrement::NAME].contains(&name))?;
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
                let at = TOUCH_NUMBERS * (contacts.tools.len() * place + number);
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
    Ok(reading)
}
