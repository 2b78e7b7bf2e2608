//! Bodies in implicit steps: springs, whose forces are those at the end of the step that is solved for.

use super::SurfaceContacts;
use super::body_slices::{BodySlices, Kept, set_vector, vector_at};
use super::gather::{Gathered, SHARES};
use super::meet::{forget, note_touch, push, release};
use super::pairs::{Pair, What};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Contact, Parts};
use crate::error::Error;
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use glam::{DMat3, DVec3};

/// [`TouchingSpring::slopes`] of a contact.
pub(super) type Slopes = [DMat3; 2];

impl SurfaceContacts {
    /// The largest share of a spring between a body and what it meets, if there is one.
    pub(crate) fn largest_share(&self, body: Entity) -> Option<f64> {
        let number = self.bodies.iter().position(|&other| other == body)?;
        let count = self.bodies.len();
        let of_body = self.meetings[number * count..(number + 1) * count].iter().flatten();
        of_body.filter_map(|meeting| meeting.spring).map(|spring| spring.share).reduce(f64::max)
    }
}

/// Looks which points may touch what in the step that begins, where the clock says that this is wanted. Whether there
/// are bodies that may meet.
pub(crate) fn seek(world: &mut World) -> Result<bool, Error> {
    if !world.contains_resource::<SurfaceContacts>() {
        return Ok(false);
    }
    let ran = world.run_system_once(super::surface_contact);
    ran.unwrap_or_else(|error| Err(Error::Options(format!("surfaces cannot be looked at: {error}"))))?;
    Ok(true)
}

/// The springs that the system has found where nodes were tried. `first_axis` is that of a body.
pub(crate) fn find(world: &World, first_axis: impl Fn(Entity) -> Option<usize>, found: &mut Vec<TouchingSpring>) {
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return };
    let (gathered, solved) = (&contacts.surface.gathered, &contacts.surface.solved);
    let axis_of = |slot: usize| {
        let (body, row) = contacts.surface.nodes[contacts.surface.near.nodes[slot] as usize];
        Some(first_axis(contacts.bodies[body as usize])? + 3 * row as usize)
    };
    for (contact, &slopes) in gathered.set.contacts().zip(solved) {
        let parts = contact.parts.iter().filter_map(|(slot, weight)| Some((axis_of(slot)?, weight)));
        found.push(TouchingSpring { parts: parts.collect(), force: contact.force(), slopes });
    }
}

/// Finds the forces of springs where nodes are. They are added to the loads, and what points carry on is noted, only
/// where the step is taken.
pub(super) fn press<T: Scalar>(
    contacts: &mut SurfaceContacts,
    (clock, springs, cpu): (&Clock, &SolvedSprings, &Cpu),
    bodies: &mut [BodySlices<'_, T>],
) {
    let mut gathered = std::mem::take(&mut contacts.surface.gathered);
    gathered.begin(1);
    let coefficients = IntegrationCoefficients::<f64>::of(clock);
    gathered.foresee(&contacts.surface, &coefficients, bodies, cpu);
    let time = 1.0 / coefficients.rate;
    let mut solved = std::mem::take(&mut contacts.surface.solved);
    solved.clear();
    let pairs = std::mem::take(&mut contacts.surface.pairs);
    let shares = springs.shared.then(|| shares_of(contacts, &gathered, &pairs));
    for pair in &pairs {
        let gap = pair.gap(&contacts.surface.places);
        if pair.what == What::First {
            gathered.facing.push(pair.point);
        }
        // what is no number is told by guards, not lost
        if gap > 0.0 {
            continue;
        }
        let mass = match &shares {
            Some(shares) => shared_mass(contacts, pair, (&gathered, &shares[..]), bodies),
            None => mass_between(contacts, pair.of_point().iter().copied(), bodies),
        };
        add(contacts, &mut gathered, (pair, gap, mass), (springs, time), bodies, &mut solved);
    }
    if springs.forces.are_noted() {
        gathered.set.find_forces(cpu);
        release(&mut contacts.surface, bodies);
        forget(contacts, &gathered.facing, bodies);
        note(contacts, &gathered, &pairs, bodies);
        push(contacts, &gathered.set.forces, bodies);
    }
    (contacts.surface.gathered, contacts.surface.pairs, contacts.surface.solved) = (gathered, pairs, solved);
}

/// The mass of a point between nodes with weights (kg).
fn mass_between<T: Scalar>(
    contacts: &SurfaceContacts,
    parts: impl Iterator<Item = (u32, f64)>,
    bodies: &[BodySlices<'_, T>],
) -> f64 {
    let mass = |(node, weight): (u32, f64)| {
        let (body, row) = contacts.surface.nodes[node as usize];
        weight * bodies[body as usize].weighs[row as usize].to_f64()
    };
    parts.map(mass).sum()
}

/// Into how many shares the mass of each node in the set is split, by the weights of all that touches there; points of
/// faces count that are about to, as in explicit steps.
fn shares_of(contacts: &SurfaceContacts, gathered: &Gathered, pairs: &[Pair]) -> Vec<f64> {
    let surface = &contacts.surface;
    let mut shares = vec![0.0; gathered.set.steps.len()];
    for pair in pairs {
        let is_of_face = surface.points[pair.point as usize].triangle.is_some();
        let within = if is_of_face { SHARES * pair.meeting.edge } else { 0.0 };
        if pair.gap(&surface.places) <= within {
            for &(node, weight) in &pair.nodes {
                shares[gathered.slots[node as usize] as usize] += weight.abs();
            }
        }
    }
    shares
}

/// The mass (kg) that resists a force between a point and what it faces along the normal, with the shares of nodes; 0
/// where none can be moved.
fn shared_mass<T: Scalar>(
    contacts: &SurfaceContacts,
    pair: &Pair,
    (gathered, shares): (&Gathered, &[f64]),
    bodies: &[BodySlices<'_, T>],
) -> f64 {
    let mut yields = 0.0;
    for &(node, weight) in &pair.nodes {
        let (body, row) = contacts.surface.nodes[node as usize];
        let (of_body, row) = (&bodies[body as usize], row as usize);
        let mass = of_body.weighs[row].to_f64();
        if mass > 0.0 {
            let free = DVec3::from_array([0, 1, 2].map(|axis| f64::from(1 - (of_body.axes[row] >> axis & 1))));
            let share = weight.abs() * shares[gathered.slots[node as usize] as usize];
            yields += share * pair.normal.dot(free * pair.normal) / mass;
        }
    }
    if yields > 0.0 { 1.0 / yields } else { 0.0 }
}

/// Adds the contact of a pair with such a gap (m), with its force, of springs that press on such a mass (kg) in steps
/// of such a time (s).
fn add<T: Scalar>(
    contacts: &SurfaceContacts,
    gathered: &mut Gathered,
    (pair, gap, mass): (&Pair, f64, f64),
    (springs, time): (&SolvedSprings, f64),
    bodies: &mut [BodySlices<'_, T>],
    all: &mut Vec<Slopes>,
) {
    let &Pair { meeting, point, what, normal, .. } = pair;
    let Some(spring) = meeting.spring else { return };
    let kept = contacts.kept(point);
    let touch = bodies[kept.body].kept(kept);
    let state = PointState::of(touch[4].to_f64());
    // of a second face, too: what has slipped along both is the same
    let kept = if what != What::Crossing && state.touched() { vector_at(touch, 0) } else { DVec3::ZERO };
    let slip = kept - pair.turned;
    let friction = meeting.friction[usize::from(state.did == Did::Slides)];
    let mut parts = Parts::default();
    for &(node, weight) in &pair.nodes {
        parts.add(gathered.slots[node as usize], weight);
    }
    let relative = parts.step(&gathered.set.earlier);
    let mut contact = Contact::new(parts, (normal, gap, relative), (friction, slip));
    let press = spring.press(springs, mass, gap, [normal.dot(relative), time]);
    let rubbing = press.rub(normal, contact.along(slip + relative), friction);
    all.push(press.with(normal, &rubbing).1);
    (contact.pressing, contact.rubbing, contact.slides) = (press.pressing, rubbing.force, rubbing.slides);
    // what slides keeps as much elastic slip as its force is of
    contact.slip = if press.stiffness > 0.0 { -contact.rubbing / press.stiffness } else { DVec3::ZERO };
    (contact.point, contact.of_point, contact.outside) = (point, what != What::Crossing, gap + pair.allowed);
    gathered.set.add(contact);
}

/// Notes what points do at the end of a step.
fn note<T: Scalar>(
    contacts: &mut SurfaceContacts,
    gathered: &Gathered,
    pairs: &[Pair],
    bodies: &mut [BodySlices<'_, T>],
) {
    for pair in pairs.iter().filter(|pair| pair.what != What::Crossing) {
        let outside = pair.gap(&contacts.surface.places) + pair.allowed;
        let kept = contacts.kept(pair.point);
        let touch = bodies[kept.body].kept_mut(kept);
        let in_corner = pair.what == What::Second;
        let outside = if in_corner { outside.min(touch[5].to_f64()) } else { outside };
        set_vector(touch, 0, DVec3::ZERO);
        let numbers = [pair.allowed, PointState { did: Did::Faces, in_corner }.number(), outside];
        touch[3..6].iter_mut().zip(numbers).for_each(|(touch, number)| *touch = T::from_f64(number));
    }
    contacts.surface.figures.contacts += gathered.set.count() as u64;
    for contact in gathered.set.contacts() {
        if contact.of_point {
            let kept = contacts.kept(contact.point);
            note_touch(bodies[kept.body].kept_mut(kept), contact);
        }
        let deepest = &mut contacts.surface.figures.deepest;
        *deepest = deepest.max(-contact.outside);
    }
}

/// Counts what contact takes of each node in a step that is found, and how far points slide. Forces work with the mean
/// of those at both ends, as all in implicit steps: `last`, and what nodes bear now ([`ContactForce`]). `first_axis` is
/// that of a body, and `moved` says how far the node goes whose first axis it is (m).
pub(crate) fn count_work(
    world: &mut World,
    last: &[(Entity, Reals)],
    first_axis: impl Fn(Entity) -> Option<usize>,
    moved: impl Fn(usize) -> DVec3,
) {
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return };
    let (surface, bodies) = (&contacts.surface, &contacts.bodies);
    let firsts: Vec<Option<usize>> = bodies.iter().map(|&body| first_axis(body)).collect();
    let mut counted = Vec::new();
    for contact in surface.gathered.set.contacts().filter(|contact| contact.slides) {
        let part = |(slot, weight): (usize, f64)| {
            let (body, row) = surface.nodes[surface.near.nodes[slot] as usize];
            Some(moved(firsts[body as usize]? + 3 * row as usize) * weight)
        };
        let relative: DVec3 = contact.parts.iter().filter_map(part).sum();
        let Kept { body, of_face, first } = contacts.kept(contact.point);
        counted.push((bodies[body], of_face, first + 6, contact.along(relative).length()));
    }
    for (&body, first) in bodies.iter().zip(&firsts) {
        let (Some(now), &Some(first)) = (world.get::<ContactForce>(body), first) else { continue };
        let before = last.iter().find(|(other, _)| *other == body).map(|(_, forces)| forces);
        for (row, force) in now.vectors().enumerate() {
            let forces = force + before.map_or(DVec3::ZERO, |before| before.vector(row));
            if forces != DVec3::ZERO {
                let taken = -0.5 * forces.dot(moved(first + 3 * row));
                counted.push((body, false, MEETING_NUMBERS * row + 7, taken));
            }
        }
    }
    for (body, of_face, number, more) in counted {
        let add = |touch: &mut Reals| {
            let sum = touch.get(number) + more;
            touch.set(number, sum);
        };
        // what contact goes on from stays as it is
        if let Some(mut touch) = world.get_mut::<FaceTouch>(body).filter(|_| of_face) {
            add(&mut touch.bypass_change_detection().0);
        } else if let Some(mut touch) = world.get_mut::<SurfaceTouch>(body) {
            add(&mut touch.bypass_change_detection().0);
        }
    }
}
