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
    /// The part of the force that is of what it sucks (N).
    pub suction: DVec3,
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
    let wanted = [
        ToolTouch::NAME,
        ToolHold::NAME,
        Mass::NAME,
        Displacement::NAME,
        DisplacementIncrement::NAME,
        SuctionMarks::NAME,
        SuctionPressure::NAME,
    ];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    let clock = *world.resource::<Clock>();
    let now = match &clock.relaxation {
        Some(relaxation) => world.resource::<Signals>().poses_at_share(relaxation.end, relaxation.share(clock.step)),
        None => world.resource::<Signals>().poses_at(clock.time()),
    };
    let mut reading = ToolReading::default();
    let mut bodies =
        world.query::<(&ToolContacts, &ToolTouch, &Mass, &RestPosition, &Displacement, &DisplacementIncrement)>();
    for (contacts, touch, mass, rest, u, step) in bodies.iter(world) {
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
                // what is left of nodes whose elements are gone is nowhere
                if mass.get(row) <= 0.0 {
                    continue;
                }
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
    let place =
        |slot: usize, reference: DVec3| now.iter().find(|(of, _)| *of == slot).map(|(_, pose)| pose.at + reference);
    let mut takers = world.query::<&ToolRemovals>();
    for removals in takers.iter(world) {
        for removal in removals.all.iter().filter(|removal| removal.tool == tool) {
            reading.place = place(removal.pose, removals.reference).unwrap_or(reading.place);
        }
    }
    let mut suctions = world.query::<(&Suction, &OfBody)>();
    for (suction, body) in suctions.iter(world).filter(|(suction, _)| suction.tool == tool) {
        reading.place = place(suction.pose, suction.reference).unwrap_or(reading.place);
        let at = reading.place;
        if let Some((force, torque)) = suction_at(world, suction, body.0, at) {
            reading.force += force;
            reading.torque += torque;
            reading.suction += force;
        }
    }
    super::grasps::read(world, tool, &now, &mut reading);
    Ok(reading)
}

/// The force on a tool of what it sucks at a body (N), and its moment about a place (N m): faces as they were at the
/// beginning of the step that led here, each with its force at its centroid.
fn suction_at(world: &World, suction: &Suction, body: Entity, about: DVec3) -> Option<(DVec3, DVec3)> {
    let (rest, u, step) =
        (world.get::<RestPosition>(body)?, world.get::<Displacement>(body)?, world.get::<DisplacementIncrement>(body)?);
    let mut now = suction.clone();
    now.renew(world.get::<SuctionMarks>(body)?, world.get::<SuctionPressure>(body)?);
    let place = |node: u32| rest.0[node as usize] + u.vector(node as usize) - step.vector(node as usize);
    let mut sums = (DVec3::ZERO, DVec3::ZERO);
    for (nodes, weight) in now.active.faces.iter().zip(&now.active.weights) {
        let [a, b, c, d] = nodes.map(place);
        let force = -now.now * weight * 0.5 * (c - a).cross(d - b);
        let centroid = if nodes[2] == nodes[3] { (a + b + c) / 3.0 } else { (a + b + c + d) / 4.0 };
        sums.0 += force;
        sums.1 += (centroid - about).cross(force);
    }
    Some(sums)
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
