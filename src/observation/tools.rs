//! What tools feel.

use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::math::{degrees, shorter};
use bevy_ecs::prelude::*;
use glam::{DQuat, DVec3};

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
    /// How many nodes slipped out of its grasps when these were closed last, as more than their `strength` held them.
    pub slipped: usize,
    /// How deep the deepest of the nodes that it may touch is inside it (m); 0 where none is.
    pub penetration: f64,
    /// The part of the force that is of what it sucks (N).
    pub suction: DVec3,
    /// The work that it has done since the start (J); none in a static analysis, which counts none.
    pub work: Option<f64>,
    /// What of this work impact, friction and catching nodes have taken (J); none in a static analysis, likewise.
    pub loss: Option<f64>,
    /// The volume (m³) that it has taken in at a rate and that waits to go, as `burst` lets no more elements go at a
    /// time; 0 where no more waits than the largest of them and what it takes in from one look to the next.
    pub waiting: f64,
    /// Of one that moves freely, how.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeReading>,
}

impl ToolReading {
    /// Adds work, and what of it is lost (J), where these are counted.
    pub(super) fn spend(&mut self, work: f64, loss: f64) {
        for (sum, more) in [(&mut self.work, work), (&mut self.loss, loss)] {
            *sum = sum.map(|sum| sum + more);
        }
    }
}

/// How a free tool moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct FreeReading {
    /// Its mass (kg).
    pub mass: f64,
    /// Where its centre of mass is (m).
    pub center: DVec3,
    /// Velocity of that in the middle of the last step (m/s), as of nodes.
    pub velocity: DVec3,
    /// How fast it turns (rad/s).
    pub spin: DVec3,
    /// Angular momentum about its centre of mass (kg m²/s).
    pub angular_momentum: DVec3,
    /// Kinetic energy in the middle of the last step (J).
    pub kinetic: f64,
    /// Potential energy in the field of gravity there, 0 at the start: minus the work that gravity has done (J).
    pub potential: f64,
    /// What damping has taken since the start (J).
    pub damping_loss: f64,
}

/// What a tool feels. Forces are those of the step that led here. Arms of contact are those of its beginning, when its
/// forces acted, and of implicit steps and at rest those of its end; arms of grasps are those of its end, where nodes
/// are put on the tool.
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
        ToolIntake::NAME,
    ];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    if let Some(reading) = super::free_tools::read(world, tool) {
        return Ok(reading);
    }
    let clock = *world.resource::<Clock>();
    let now = poses_now(world);
    let (back, acted) = when_forces_acted(world);
    let counted = clock.relaxation.is_none().then_some(0.0);
    let mut reading = ToolReading { work: counted, loss: counted, ..ToolReading::default() };
    let of_tool =
        slot_of(world, tool).and_then(|(slot, reference)| Some((now.iter().find(|of| of.0 == slot)?, reference)));
    reading.place = of_tool.map_or(DVec3::ZERO, |((_, pose), reference)| pose.at + reference);
    type Bodies<'a> = ((&'a ToolContacts, &'a ToolTouch), &'a Mass, Places<'a>);
    let mut bodies = world.query::<Bodies<'_>>();
    for ((contacts, touch), mass, (rest, u, step)) in bodies.iter(world) {
        for (number, contact) in contacts.tools.iter().enumerate().filter(|(_, contact)| contact.tool == tool) {
            let [pose, earlier] = [&now, &acted].map(|poses| pose_in(poses, contact.signal));
            let (Some(pose), Some(earlier)) = (pose, earlier) else { continue };
            let ball = contact.geometry.bounding_sphere().map(|(center, radius)| (pose.place(center), radius));
            for (place, (&row, &mask)) in contacts.rows.iter().zip(&contacts.masks).enumerate() {
                if mask >> number & 1 == 0 {
                    continue;
                }
                let row = row as usize;
                let at = contacts.numbers_a_tool() * (contacts.tools.len() * place + number);
                let number = |i: usize| touch.get(at + i);
                reading.spend(number(5), number(6));
                let end = rest.0[row] - contacts.reference + u.vector(row);
                // who is outside a ball around all of it is not inside; what is left of nodes whose elements are gone
                // is nowhere, but bore what it bore in the step in which they went
                let within = |(center, radius): (DVec3, f64)| end.distance_squared(center) <= radius * radius;
                if mass.get(row) > 0.0 && ball.is_none_or(within) {
                    let distance = contact.geometry.distance(pose.inverse(end)).0;
                    reading.penetration = reading.penetration.max(-distance);
                }
                if number(3) > 0.0 {
                    let force = -DVec3::new(number(0), number(1), number(2));
                    reading.nodes += 1;
                    reading.force += force;
                    reading.torque += (end - back * step.vector(row) - earlier.at).cross(force);
                }
            }
        }
    }
    let mut suctions = world.query::<(&Suction, &OfBody)>();
    for (suction, body) in suctions.iter(world).filter(|(suction, _)| suction.tool == tool) {
        if let Some((force, torque)) = suction_at(world, suction, body.0, reading.place) {
            reading.force += force;
            reading.torque += torque;
            reading.suction += force;
        }
    }
    super::grasps::read(world, tool, &now, &mut reading);
    reading.waiting = waiting(world, tool);
    Ok(reading)
}

/// What a tool has taken in (m³) beyond what waits for an element to be whole, and for the next look.
fn waiting(world: &mut World, tool: &str) -> f64 {
    let clock = *world.resource::<Clock>();
    let step = clock.time_step.max(clock.before);
    let look = world.get_resource::<ToolLooks>().map_or(0.0, |looks| looks.0 as f64 * step);
    let mut sum = 0.0;
    for (removals, intake) in world.query::<(&ToolRemovals, &ToolIntake)>().iter(world) {
        let of_tool = removals.all.iter().enumerate().filter(|(_, removal)| removal.tool == tool);
        for (number, removal) in of_tool.filter(|(_, removal)| removal.threshold.is_none()) {
            let signals = world.resource::<Signals>();
            // a program may go on beyond the duration of the scene
            let now = signals.values()[removal.rate][0];
            let fastest = (signals.largest_input(removal.rate) * removal.fastest).max(now);
            let usual = removal.largest + fastest * look;
            // rounding of what just fits is none that waits
            let more = intake.get(INTAKE_NUMBERS * number) - usual * (1.0 + 1e-3);
            sum += more.max(0.0);
        }
    }
    sum
}

/// Where a tool's origin is (m) and how it is turned (axis times angle, degrees), or the velocity of its origin (m/s)
/// and how fast it turns (rad/s) in the middle of the last step.
pub fn way_of(world: &mut World, tool: &str, of_velocity: bool) -> [DVec3; 2] {
    let clock = *world.resource::<Clock>();
    if of_velocity && let Some((velocity, spin)) = super::free_tools::velocity_of(world, tool) {
        return [velocity, spin];
    }
    if !of_velocity && let Some((at, turn)) = super::free_tools::pose_of(world, tool) {
        return [at, degrees(turn)];
    }
    let Some((slot, reference)) = slot_of(world, tool) else { return [DVec3::ZERO; 2] };
    let signals = world.resource::<Signals>();
    let (time, before, rate) = match &clock.relaxation {
        Some(relaxation) => (relaxation.end, relaxation.end, 0.0),
        None => (clock.time(), clock.time() - clock.time_step, clock.rate()),
    };
    let pose_at = |time: f64| {
        let all = match &clock.relaxation {
            Some(relaxation) => signals.poses_at_share(time, relaxation.share(clock.step)),
            None => signals.poses_at(time),
        };
        all.into_iter().find(|(of, _)| *of == slot).map(|(_, pose)| pose)
    };
    let Some(now) = pose_at(time) else { return [DVec3::ZERO; 2] };
    let turn = DQuat::from_mat3(&now.rotation);
    if !of_velocity {
        return [now.at + reference, degrees(turn)];
    }
    let Some(earlier) = pose_at(before) else { return [DVec3::ZERO; 2] };
    let turned = turn * DQuat::from_mat3(&earlier.rotation).conjugate();
    [(now.at - earlier.at) * rate, shorter(turned).to_scaled_axis() * rate]
}

/// The slot of a pose of a guided tool, wherever it is used, and the point from which that is counted (m).
fn slot_of(world: &mut World, tool: &str) -> Option<(usize, DVec3)> {
    let mut found = Vec::new();
    for contacts in world.query::<&ToolContacts>().iter(world) {
        let of_tool = contacts.tools.iter().filter(|contact| contact.tool == tool);
        found.extend(of_tool.map(|contact| (contact.signal, contacts.reference)));
    }
    for removals in world.query::<&ToolRemovals>().iter(world) {
        let of_tool = removals.all.iter().filter(|removal| removal.tool == tool);
        found.extend(of_tool.map(|removal| (removal.pose, removals.reference)));
    }
    for suction in world.query::<&Suction>().iter(world).filter(|suction| suction.tool == tool) {
        found.push((suction.pose, suction.reference));
    }
    for grasps in world.query::<&Grasps>().iter(world) {
        let of_tool = grasps.grasps.iter().filter(|grasp| grasp.tool.tool == tool);
        found.extend(of_tool.map(|grasp| (grasp.tool.signal, grasps.reference)));
    }
    let idle = world.get_resource::<IdleTools>();
    found.extend(idle.and_then(|IdleTools(all)| all.get(tool)).map(|&slot| (slot, DVec3::ZERO)));
    found.into_iter().min_by_key(|(slot, _)| *slot)
}

/// The force on a tool of what it sucks at a body (N), and its moment about a place (N m): of faces as they were at the
/// beginning of the step that led here, each with its force at its centroid as that is now.
fn suction_at(world: &World, suction: &Suction, body: Entity, about: DVec3) -> Option<(DVec3, DVec3)> {
    let (rest, u, step) =
        (world.get::<RestPosition>(body)?, world.get::<Displacement>(body)?, world.get::<DisplacementIncrement>(body)?);
    let mut now = suction.clone();
    now.renew(world.get::<SuctionMarks>(body)?, world.get::<SuctionPressure>(body)?);
    let place = |node: u32| rest.0[node as usize] + u.vector(node as usize);
    let mut sums = (DVec3::ZERO, DVec3::ZERO);
    for (nodes, weight) in now.active.faces.iter().zip(&now.active.weights) {
        let [a, b, c, d] = nodes.map(|node| place(node) - step.vector(node as usize));
        let force = -now.now * weight * 0.5 * (c - a).cross(d - b);
        let [a, b, c, d] = nodes.map(place);
        let centroid = if nodes[2] == nodes[3] { (a + b + c) / 3.0 } else { (a + b + c + d) / 4.0 };
        sums.0 += force;
        sums.1 += (centroid - about).cross(force);
    }
    Some(sums)
}

/// What the tool of a hand felt in a batch of steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Felt {
    /// The mean of the force on it (N); of what it sucks that of the last step.
    pub force: DVec3,
    /// The moment of this force about its origin (N m), with arms as [`read_tool`] takes them, of the last step.
    pub torque: DVec3,
    /// Whether it touched, held or sucked anything.
    pub in_contact: bool,
}

/// Where guided tools are now, by the first slots of their poses.
pub(super) fn poses_now(world: &World) -> Vec<(usize, Pose)> {
    let (clock, signals) = (world.resource::<Clock>(), world.resource::<Signals>());
    match &clock.relaxation {
        Some(relaxation) => signals.poses_at_share(relaxation.end, relaxation.share(clock.step)),
        None => signals.poses_at(clock.time()),
    }
}

/// Where a node is at rest, and goes.
type Places<'a> = (&'a RestPosition, &'a Displacement, &'a DisplacementIncrement);

/// When the forces of contact in the last step acted: how many of a node's last increments lead back there, and where
/// guided tools were. In explicit steps that is the beginning of the step, else its end.
fn when_forces_acted(world: &World) -> (f64, Vec<(usize, Pose)>) {
    let clock = world.resource::<Clock>();
    if clock.back_to_middle() == 0.0 {
        return (0.0, poses_now(world));
    }
    // where Δt has changed since, increments are those of the new one
    let ago = clock.last_step();
    (ago / clock.time_step, world.resource::<Signals>().poses_at(clock.time() - ago))
}

fn pose_in(poses: &[(usize, Pose)], slot: usize) -> Option<Pose> {
    poses.iter().find(|(of, _)| *of == slot).map(|(_, pose)| *pose)
}

/// What the tools of hands felt in so many steps; another batch begins for each tool that is asked for. Of what they
/// suck that is the last step alone, whose faces and pressures are still there.
///
/// # Errors
/// What the GPU says.
pub fn feel(world: &mut World, tool: &str, steps: u64) -> Result<Felt, Error> {
    let wanted = [ToolTouch::NAME, ToolHold::NAME, Displacement::NAME, DisplacementIncrement::NAME];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    let now = world.resource::<Signals>().poses_at(world.resource::<Clock>().time());
    let (back, acted) = when_forces_acted(world);
    let mut felt = Felt::default();
    let mut bodies = world.query::<(&ToolContacts, &mut ToolTouch, Places<'_>)>();
    for (contacts, mut touch, (rest, u, step)) in bodies.iter_mut(world).filter(|(contacts, ..)| contacts.felt) {
        let numbers = contacts.numbers_a_tool();
        for (bit, contact) in contacts.tools.iter().enumerate().filter(|(_, contact)| contact.tool == tool) {
            let Some(earlier) = pose_in(&acted, contact.signal) else { continue };
            for (place, &row) in contacts.rows.iter().enumerate() {
                let first = numbers * (contacts.tools.len() * place + bit) + TOUCH_NUMBERS;
                let force = -DVec3::from_array([0, 1, 2].map(|i| touch.get(first + i))) / steps as f64;
                if force == DVec3::ZERO {
                    continue;
                }
                (0..FELT_NUMBERS).for_each(|i| touch.set(first + i, 0.0));
                let row = row as usize;
                let place = rest.0[row] - contacts.reference + u.vector(row) - back * step.vector(row);
                felt.force += force;
                felt.torque += (place - earlier.at).cross(force);
                felt.in_contact = true;
            }
        }
    }
    super::grasps::feel(world, tool, &now, steps, &mut felt);
    if felt.in_contact {
        send_to_device(world, |_, name| name == ToolTouch::NAME || name == ToolHold::NAME)?;
    }
    let mut suctions = world.query::<(&Suction, &OfBody)>();
    if !suctions.iter(world).any(|(suction, _)| suction.tool == tool) {
        return Ok(felt);
    }
    let wanted = [SuctionMarks::NAME, SuctionPressure::NAME];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    for (suction, body) in suctions.iter(world).filter(|(suction, _)| suction.tool == tool) {
        let Some(at) = now.iter().find(|(slot, _)| *slot == suction.pose).map(|(_, pose)| pose.at) else { continue };
        if let Some((force, torque)) = suction_at(world, suction, body.0, at + suction.reference) {
            felt.force += force;
            felt.torque += torque;
            felt.in_contact |= force != DVec3::ZERO;
        }
    }
    Ok(felt)
}
