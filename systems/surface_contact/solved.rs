//! Bodies in implicit steps: springs, whose forces are those at the end of the step that is solved for.

use super::body_slices::{BodySlices, set_vector, vector_at};
use super::faced::Found;
use super::gather::{Gathered, InStep, Met};
use super::meet::{FACES, SLIDES, STICKS, forget, push, release};
use super::{Meeting, SurfaceContacts};
use crate::backend::cpu::IntegrationCoefficients;
use crate::components::*;
use crate::contact::{Contact, Facing};
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

/// What a point is found to do, before its force is known.
struct Meets {
    meeting: Meeting,
    met: Met,
    normal: DVec3,
}

/// What is known of a contact besides.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    /// Its normal and tangential force (N) at the end of the last step.
    was: f64,
    rubbed: DVec3,
    /// [`TouchingSpring::slopes`].
    slopes: [DMat3; 2],
}

/// The springs that the system has found where nodes were tried. `first_axis` is that of a body.
pub(crate) fn find(world: &World, first_axis: impl Fn(Entity) -> Option<usize>, found: &mut Vec<TouchingSpring>) {
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return };
    let (gathered, solved) = (&contacts.surface.gathered, &contacts.surface.solved);
    let axis_of = |slot: usize| {
        let (body, row) = contacts.surface.nodes[gathered.acted_on[slot] as usize];
        Some(first_axis(contacts.bodies[body as usize])? + 3 * row as usize)
    };
    for (contact, solved) in gathered.set.contacts.iter().zip(solved) {
        let parts = contact.parts().filter_map(|(slot, weight)| Some((axis_of(slot)?, weight)));
        found.push(TouchingSpring { parts: parts.collect(), force: contact.force(), slopes: solved.slopes });
    }
}

/// Finds the forces of springs where nodes are. They are added to the loads, and what points carry on is noted, only
/// where the step is taken.
pub(super) fn press<T: Scalar>(
    contacts: &mut SurfaceContacts,
    (clock, springs): (&Clock, &SolvedSprings),
    bodies: &mut [BodySlices<'_, T>],
) {
    let found = std::mem::take(&mut contacts.surface.found);
    let mut gathered = std::mem::take(&mut contacts.surface.gathered);
    gathered.clear();
    let coefficients = IntegrationCoefficients::<f64>::of(clock);
    let in_step = InStep { largest: 0.0, settling: 0.0, coefficients: &coefficients };
    let mut solved = std::mem::take(&mut contacts.surface.solved);
    for Found { place, faced, .. } in &found {
        let number = contacts.surface.lists.points[*place as usize];
        if let Some(first) = &faced.first {
            gathered.facing.push(number);
            face(contacts, &mut gathered, (number, first, true), (&in_step, springs), bodies, &mut solved);
        }
        if let Some(second) = &faced.second {
            face(contacts, &mut gathered, (number, second, false), (&in_step, springs), bodies, &mut solved);
        }
    }
    cross(contacts, &mut gathered, (&in_step, springs), bodies, &mut solved);
    if springs.forces == SpringForces::Noted {
        let mut forces = std::mem::take(&mut contacts.surface.forces);
        forces.clear();
        forces.resize(gathered.acted_on.len(), DVec3::ZERO);
        for contact in &gathered.set.contacts {
            let force = contact.force();
            contact.parts().for_each(|(slot, weight)| forces[slot] += force * weight);
        }
        contacts.surface.forces = forces;
        release(&mut contacts.surface, bodies);
        forget(contacts, &gathered.facing, bodies);
        note(contacts, &gathered, &found, &solved, bodies);
        push(contacts, &gathered.acted_on, bodies);
    }
    gathered.acted_on.iter().for_each(|&node| gathered.slots[node as usize] = u32::MAX);
    (contacts.surface.gathered, contacts.surface.found, contacts.surface.solved) = (gathered, found, solved);
}

/// What a point does to a face.
fn face<T: Scalar>(
    contacts: &SurfaceContacts,
    gathered: &mut Gathered,
    (number, facing, first): (u32, &Facing, bool),
    of: (&InStep<'_>, &SolvedSprings),
    bodies: &mut [BodySlices<'_, T>],
    all: &mut Vec<Solved>,
) {
    let surface = &contacts.surface;
    let point = &surface.points[number as usize];
    let body = surface.triangles.bodies[facing.triangle as usize];
    let gap = contacts.gap(point, facing);
    // what is no number is told by guards, not lost
    if gap > 0.0 {
        return;
    }
    let Some(meeting) = contacts.meeting(point.body, body) else { return };
    let (corners, weights) = surface.corners_of(point, facing);
    let of_face = corners.into_iter().zip(weights).map(|(node, weight)| (node, -weight));
    let meets = Meets { meeting, met: Met { point: number, first, gap }, normal: facing.normal };
    add(contacts, gathered, meets, point.parts().chain(of_face), of, bodies, all);
}

/// What edges do that cross. Nothing is known of how they slipped.
fn cross<T: Scalar>(
    contacts: &SurfaceContacts,
    gathered: &mut Gathered,
    of: (&InStep<'_>, &SolvedSprings),
    bodies: &mut [BodySlices<'_, T>],
    all: &mut Vec<Solved>,
) {
    let surface = &contacts.surface;
    for (pair, crossing) in &surface.crossings.found {
        let [one, other] = pair.map(|edge| surface.crossings.edges[edge as usize]);
        let Some(meeting) = contacts.crossing(one.body, other.body) else { continue };
        let gap = crossing.gap - meeting.thickness;
        if gap > 0.0 {
            continue;
        }
        let [of_one, of_other] = crossing.weights;
        let of_other = other.nodes.into_iter().zip(of_other).map(|(node, weight)| (node, -weight));
        let nodes = one.nodes.into_iter().zip(of_one).chain(of_other);
        // nodes are the first of the points
        let met = Met { point: one.nodes[0], first: false, gap };
        add(contacts, gathered, Meets { meeting, met, normal: crossing.normal }, nodes, of, bodies, all);
    }
}

/// Adds a contact of nodes with signed weights, with its force. The mass that a spring presses on is that of the point.
fn add<T: Scalar>(
    contacts: &SurfaceContacts,
    gathered: &mut Gathered,
    Meets { meeting, met, normal }: Meets,
    nodes: impl Iterator<Item = (u32, f64)>,
    (in_step, springs): (&InStep<'_>, &SolvedSprings),
    bodies: &mut [BodySlices<'_, T>],
    all: &mut Vec<Solved>,
) {
    let Some(spring) = meeting.spring else { return };
    let kept = contacts.kept(met.point);
    let touch = bodies[kept.body].kept_mut(kept);
    let (state, before) = (touch[4].to_f64(), touch[5].to_f64());
    let (touched, sticks) = (met.first && state >= STICKS, met.first && state == STICKS);
    let slip = if touched { vector_at(touch, 0) } else { DVec3::ZERO };
    let friction = meeting.friction[usize::from(!sticks)];
    let mut contact = Contact::new((normal, met.gap), (friction, slip));
    let mut mass = 0.0;
    for (node, weight) in nodes {
        let slot = gathered.slot_of(node, (&contacts.surface, in_step), bodies);
        contact.add(slot, weight);
        if weight > 0.0 {
            let (body, row) = contacts.surface.nodes[node as usize];
            mass += weight * bodies[body as usize].mass[row as usize].to_f64();
        }
    }
    let relative = contact.relative(&gathered.set.earlier);
    let time = 1.0 / in_step.coefficients.rate;
    let press = spring.press(springs, mass, met.gap, [normal.dot(relative), time]);
    let rubbing = press.rub(normal, contact.along(slip + relative), friction);
    let slopes = press.with(normal, &rubbing).1;
    (contact.pressing, contact.rubbing, contact.slides) = (press.pressing, rubbing.force, rubbing.slides);
    let was = if touched { (-press.stiffness * before).max(0.0) } else { 0.0 };
    all.push(Solved { was, rubbed: -press.stiffness * contact.along(slip), slopes });
    // what slides keeps as much elastic slip as its force is of
    contact.slip = if press.stiffness > 0.0 { -contact.rubbing / press.stiffness } else { DVec3::ZERO };
    gathered.set.contacts.push(contact);
    gathered.met.push(met);
}

/// Notes what points do at the end of a step. Forces work with the mean of those at both ends, as all in implicit
/// steps.
fn note<T: Scalar>(
    contacts: &mut SurfaceContacts,
    gathered: &Gathered,
    found: &[Found],
    all: &[Solved],
    bodies: &mut [BodySlices<'_, T>],
) {
    for Found { place, faced, .. } in found {
        let Some(first) = &faced.first else { continue };
        let number = contacts.surface.lists.points[*place as usize];
        let gap = contacts.gap(&contacts.surface.points[number as usize], first);
        let kept = contacts.kept(number);
        let touch = bodies[kept.body].kept_mut(kept);
        set_vector(touch, 0, DVec3::ZERO);
        (touch[3], touch[4], touch[5]) = (T::default(), T::from_f64(FACES), T::from_f64(gap));
    }
    for ((contact, met), Solved { was, rubbed, .. }) in gathered.set.contacts.iter().zip(&gathered.met).zip(all) {
        let kept = contacts.kept(met.point);
        let touch = bodies[kept.body].kept_mut(kept);
        let relative = contact.relative(&gathered.set.earlier);
        if met.first {
            set_vector(touch, 0, contact.slip);
            touch[4] = T::from_f64(if contact.slides { SLIDES } else { STICKS });
        }
        let mean = 0.5 * (contact.force() + contact.normal * *was + *rubbed);
        let along = if contact.slides { contact.along(relative).length() } else { 0.0 };
        touch[6] = T::from_f64(touch[6].to_f64() + along);
        touch[7] = T::from_f64(touch[7].to_f64() - mean.dot(relative));
        let deepest = &mut contacts.surface.figures.deepest;
        *deepest = deepest.max(-met.gap);
    }
}
