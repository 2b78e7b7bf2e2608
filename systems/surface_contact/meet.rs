//! The forces that keep points outside of what they face.

use super::body_slices::{BodySlices, Kept, set_vector, vector};
use super::faced::tasks;
use super::gather::{Gathered, InStep, gather};
use super::{Meeting, Surface, SurfaceContacts};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Contact, ContactSet, Facing, Point, bilinear};
use crate::math::Scalar;
use glam::{DVec3, DVec4};
use smallvec::SmallVec;

/// Nodes with signed weights.
pub(super) type SignedNodes = SmallVec<[(u32, f64); 8]>;

impl SurfaceContacts {
    /// How far a point is outside what it must stay outside of (m).
    pub(super) fn gap(&self, point: &Point, facing: &Facing) -> f64 {
        let body = self.surface.triangles.bodies[facing.triangle as usize];
        facing.gap - self.meeting(point.body, body).map_or(0.0, |meeting| meeting.thickness)
    }

    /// What `allowed` asks of a point and what it faces.
    pub(super) fn in_step(&self, point: &Point, facing: &Facing, clock: &Clock) -> InStep {
        let body = self.surface.triangles.bodies[facing.triangle as usize];
        let settling = self.meeting(point.body, body).map_or(0.0, |meeting| meeting.settling(clock));
        InStep { largest: self.surface.motion.largest, settling }
    }

    /// Where a point's numbers are.
    pub(super) fn kept(&self, point: u32) -> Kept {
        self.surface.kept(point)
    }
}

impl Meeting {
    /// How far points that are inside and may be come out in this step (m): what they began with while a wave goes
    /// through the body, what the corners of faces have let in later a hundred times as slowly, since that does work.
    pub(super) fn settling(&self, clock: &Clock) -> f64 {
        match clock.relaxation {
            Some(_) => f64::INFINITY,
            None if clock.time() * self.settling < 0.5 * self.edge => self.settling * clock.time_step,
            None => 0.01 * self.settling * clock.time_step,
        }
    }
}

impl Surface {
    /// The corners of what a point faces and their weights: of a node those of the triangle, of a point of a face those
    /// of the whole facet.
    pub(super) fn corners_of(&self, point: &Point, facing: &Facing) -> ([u32; 4], [f64; 4]) {
        if let Some(&facet) = self.facets.get(facing.triangle as usize).filter(|_| point.triangle.is_some())
            && facet[2] != facet[3]
            // not beyond a rim; of a place on a side rounding may leave a little less than nothing
            && facing.weights.iter().all(|&weight| weight > -1e-9)
        {
            return (facet, bilinear(facing.at, facet.map(|node| self.places[node as usize])));
        }
        let ([a, b, c], [u, v, w]) = (self.triangles.triangles[facing.triangle as usize], facing.weights);
        ([a, b, c, c], [u, v, w, 0.0])
    }

    /// A point's nodes against those of what it faces, and how many of them, the first, are the point's.
    pub(super) fn between(&self, point: &Point, facing: &Facing) -> (SignedNodes, usize) {
        let (corners, weights) = self.corners_of(point, facing);
        let of_face = corners.into_iter().zip(weights).map(|(node, weight)| (node, -weight));
        (point.parts().chain(of_face).collect(), point.parts().count())
    }
}

impl Surface {
    /// How far a point is outside of the place on a facet that bears it (m): of a warped quadrilateral, that is not
    /// quite its triangles, the gap that the step foresees is the one that is found after it, or forces would do work.
    pub(super) fn gap_of_facet(&self, point: &Point, facing: &Facing) -> f64 {
        let (nodes, weights) = self.corners_of(point, facing);
        let mut at = DVec3::ZERO;
        for (&node, weight) in nodes.iter().zip(weights) {
            at += self.places[node as usize] * weight;
        }
        facing.normal.dot(point.place(&self.places) - at)
    }
}

/// Clears the forces of the last step, and into how many shares masses were split in it.
pub(super) fn release<T: Scalar>(surface: &mut Surface, bodies: &mut [BodySlices<'_, T>]) {
    for node in surface.pressed.drain(..) {
        let (body, row) = surface.nodes[node as usize];
        set_vector(bodies[body as usize].force, 3 * row as usize, DVec3::ZERO);
        bodies[body as usize].touch[share_at(row)] = T::default();
    }
}

/// Forgets what points touched or faced in the last step that face nothing in this one: all but those of `now`, which
/// ascend like these.
pub(super) fn forget<T: Scalar>(contacts: &mut SurfaceContacts, now: &[u32], bodies: &mut [BodySlices<'_, T>]) {
    let mut still = now.iter().copied().peekable();
    for place in 0..contacts.surface.touching.len() {
        let point = contacts.surface.touching[place];
        while still.next_if(|&other| other < point).is_some() {}
        if still.peek() == Some(&point) {
            continue;
        }
        let kept = contacts.kept(point);
        let touch = bodies[kept.body].kept_mut(kept);
        set_vector(touch, 0, DVec3::ZERO);
        // as deep as a point may be inside that never faced anything, so that a run that goes on from here finds the
        // same
        touch[3] = T::default();
        touch[4] = T::from_f64(PointState::default().number());
        touch[5] = T::default();
    }
    contacts.surface.touching.clear();
    contacts.surface.touching.extend_from_slice(now);
}

/// Finds the forces of a step and adds them to the loads. Where somebody looks after it, it is noted what they give
/// that they cannot: of one sweep of the kinematic law that is known.
pub(super) fn meet<T: Scalar>(
    contacts: &mut SurfaceContacts,
    ((clock, cpu), reach): ((&Clock, &Cpu), f64),
    bodies: &mut [BodySlices<'_, T>],
    (signals, gain): (&Signals, Option<&mut ContactGain>),
) {
    let coefficients = IntegrationCoefficients::<f64>::of(clock);
    let mut gathered = std::mem::take(&mut contacts.surface.gathered);
    // one more for edges that cross
    gathered.begin(tasks(contacts) + 1);
    gathered.remember_shares(&contacts.surface, bodies);
    release(&mut contacts.surface, bodies);
    gathered.foresee(&contacts.surface, &coefficients, bodies, cpu);
    gathered.hold(&contacts.surface, (&coefficients, signals), bodies);
    gather(contacts, &mut gathered, (clock, reach, cpu), bodies);
    forget(contacts, &gathered.facing, bodies);
    let is_known = clock.relaxation.is_none() && contacts.sweeps <= 1;
    let gain = gain.filter(|_| is_known && !gathered.set.contacts().any(|contact| contact.springs));
    if gain.is_some() {
        gathered.before.clear();
        gathered.before.extend(gathered.set.beginnings());
    }
    gathered.set.solve(contacts.sweeps, cpu);
    if let Some(gain) = gain {
        gain.steps += 1;
        gain.energy += coefficients.work_factor * gathered.set.beyond_bound(&gathered.before);
    }
    let work_factor = clock.relaxation.is_none().then_some(coefficients.work_factor);
    note_touches(contacts, &gathered, work_factor.is_some(), bodies);
    if let Some(work_factor) = work_factor {
        count_work(&contacts.surface, &gathered.set, work_factor, bodies);
    }
    push(contacts, &gathered.set.forces, bodies);
    note_shares(&contacts.surface, &gathered, bodies);
    contacts.surface.gathered = gathered;
}

/// Notes what contacts came to.
fn note_touches<T: Scalar>(
    contacts: &mut SurfaceContacts,
    Gathered { set, .. }: &Gathered,
    counts_ways: bool,
    bodies: &mut [BodySlices<'_, T>],
) {
    let mut deepest = contacts.surface.figures.deepest;
    for contact in set.contacts().filter(|contact| contact.pressing > 0.0) {
        let kept = contacts.kept(contact.point);
        let touch = bodies[kept.body].kept_mut(kept);
        let after = contact.outside + contact.normal.dot(contact.step);
        deepest = deepest.max(-after);
        if contact.of_point {
            note_touch(touch, contact);
        }
        if counts_ways {
            touch[6] = T::from_f64(touch[6].to_f64() + contact.slid);
        }
    }
    contacts.surface.figures.deepest = deepest;
}

/// Notes that a point that faced something touches it, and how far it has slipped elastically: of two walls the first
/// that it touches, for along both it has slipped alike.
pub(super) fn note_touch<T: Scalar>(touch: &mut [T], contact: &Contact) {
    let faced = PointState::of(touch[4].to_f64());
    if !faced.touched() {
        let did = if contact.slides { Did::Slides } else { Did::Sticks };
        set_vector(touch, 0, contact.slip);
        touch[4] = T::from_f64(PointState { did, ..faced }.number());
    }
}

/// Counts what contact takes of each node, with `work_factor` for each joule, by where that goes by now. Who acts on
/// nodes after this counts in the same place what that changes (`note_farther`).
fn count_work<T: Scalar>(
    Surface { nodes, near, .. }: &Surface,
    set: &ContactSet,
    work_factor: f64,
    bodies: &mut [BodySlices<'_, T>],
) {
    for (place, work) in set.works() {
        let (body, row) = nodes[near.nodes[place] as usize];
        let (of_body, row) = (&mut bodies[body as usize], row as usize);
        // along axes that are told the step to come was taken for the last one, too
        let ahead = vector(of_body.step, row) - of_body.last_step(row);
        let work = work - 0.5 * set.forces[place].truncate().dot(ahead);
        let taken = &mut of_body.touch[MEETING_NUMBERS * row + 7];
        *taken = T::from_f64(taken.to_f64() - work_factor * work);
    }
}

/// Where the number of shares of a node is among what is kept of those of its body.
pub(super) fn share_at(row: u32) -> usize {
    MEETING_NUMBERS * row as usize + 8
}

/// Notes into how many shares the masses of nodes were split that bear a force.
fn note_shares<T: Scalar>(
    Surface { nodes, pressed, .. }: &Surface,
    Gathered { set, slots, .. }: &Gathered,
    bodies: &mut [BodySlices<'_, T>],
) {
    for &node in pressed {
        let (body, row) = nodes[node as usize];
        bodies[body as usize].touch[share_at(row)] = T::from_f64(set.share(slots[node as usize] as usize));
    }
}

/// Adds the forces to the loads, and notes them.
pub(super) fn push<T: Scalar>(contacts: &mut SurfaceContacts, forces: &[DVec4], bodies: &mut [BodySlices<'_, T>]) {
    let Surface { nodes, near, pressed, .. } = &mut contacts.surface;
    let pushed = near.nodes.iter().zip(forces).filter(|(_, force)| **force != DVec4::ZERO);
    for (&node, force) in pushed {
        let (body, row) = nodes[node as usize];
        let (columns, row, force) = (&mut bodies[body as usize], row as usize, force.truncate());
        let load = vector(columns.external, row) + force;
        set_vector(columns.external, 3 * row, load);
        set_vector(columns.force, 3 * row, force);
        pressed.push(node);
    }
}

#[cfg(test)]
mod tests;
