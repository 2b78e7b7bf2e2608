//! The forces that keep points outside of what they face.

use super::body_slices::{BodySlices, Kept, set_vector, vector, vector_at};
use super::faced::Found;
use super::{Meeting, Surface, SurfaceContacts};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Contact, ContactSet, Facing, Point, bilinear};
use crate::math::Scalar;
use glam::DVec3;

/// What a point did in the last step, in [`SurfaceTouch`].
pub(super) const FREE: f64 = 0.0;
pub(super) const FACES: f64 = 1.0;
pub(super) const STICKS: f64 = 2.0;
pub(super) const SLIDES: f64 = 3.0;

/// How far a point that is inside comes out in a step at most, in edges.
pub(super) const OUT: f64 = 0.1;

/// Points of faces share their nodes' masses while they are no farther from touching than this, in edges: who shares
/// stays the same from step to step then, and pressures come to rest.
const SHARES: f64 = 1e-3;

/// A contact of the set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    point: u32,
    /// Whether it is the first face of the point: only there slip is kept.
    first: bool,
    /// How far it was outside (m).
    gap: f64,
}

impl SurfaceContacts {
    /// How far a point is outside what it must stay outside of (m).
    fn gap(&self, point: &Point, facing: &Facing) -> f64 {
        let body = self.surface.triangles.bodies[facing.triangle as usize];
        facing.gap - self.meeting(point.body, body).map_or(0.0, |meeting| meeting.thickness)
    }

    /// How far points that are inside and may be come out in this step (m): what they began with while a wave goes
    /// through the body, what the corners of faces have let in later a hundred times as slowly, since that does work.
    fn settling(&self, clock: &Clock) -> f64 {
        match clock.relaxation {
            Some(_) => f64::INFINITY,
            None if clock.time() * self.settling < 0.5 * self.edge => self.settling * clock.time_step,
            None => 0.01 * self.settling * clock.time_step,
        }
    }

    /// Where a point's numbers are.
    fn kept(&self, point: u32) -> Kept {
        self.surface.kept[point as usize]
    }
}

impl Surface {
    /// The corners of what a point faces and their weights: of a node those of the triangle, of a point of a face those
    /// of the whole facet.
    pub(super) fn corners_of(&self, point: &Point, facing: &Facing) -> ([u32; 4], [f64; 4]) {
        let facet = self.facets[facing.triangle as usize];
        if point.triangle.is_some() && facet[2] != facet[3] {
            return (facet, bilinear(facing.at, facet.map(|node| self.places[node as usize])));
        }
        let ([a, b, c], [u, v, w]) = (self.triangles.triangles[facing.triangle as usize], facing.weights);
        ([a, b, c, c], [u, v, w, 0.0])
    }
}

impl Surface {
    /// How far a point is outside of the place on a facet that bears it (m): of a warped quadrilateral, that is not
    /// quite its triangles, the gap that the step foresees is the one that is found after it, or forces would do work.
    pub(super) fn gap_of_facet(&self, point: &Point, facing: &Facing) -> f64 {
        let (nodes, weights) = self.corners_of(point, facing);
        let at: DVec3 = nodes.iter().zip(weights).map(|(&node, weight)| self.places[node as usize] * weight).sum();
        facing.normal.dot(point.place(&self.places) - at)
    }
}

/// Clears the forces of the last step.
pub(super) fn release<T: Scalar>(surface: &mut Surface, bodies: &mut [BodySlices<'_, T>]) {
    for node in surface.pressed.drain(..) {
        let (body, row) = surface.nodes[node as usize];
        set_vector(bodies[body as usize].force, 3 * row as usize, DVec3::ZERO);
    }
}

/// Forgets what points touched or faced in the last step.
pub(super) fn forget<T: Scalar>(surface: &mut Surface, bodies: &mut [BodySlices<'_, T>]) {
    std::mem::swap(&mut surface.touching, &mut surface.touched);
    surface.touching.clear();
    for &point in &surface.touched {
        let kept = surface.kept[point as usize];
        let touch = bodies[kept.body].kept_mut(kept);
        set_vector(touch, 0, DVec3::ZERO);
        touch[4] = T::from_f64(FREE);
        touch[5] = T::default();
    }
}

/// Forgets how deep those of them may be inside that face nothing any more: looked at or asleep, they are as points that
/// never faced anything, so that a run that goes on from here finds what this one does.
pub(super) fn leave<T: Scalar>(surface: &Surface, bodies: &mut [BodySlices<'_, T>]) {
    for &point in &surface.touched {
        let kept = surface.kept[point as usize];
        let touch = bodies[kept.body].kept_mut(kept);
        if touch[4].to_f64() == FREE {
            touch[3] = T::default();
        }
    }
}

/// Finds the forces of a step and adds them to the loads.
pub(super) fn meet<T: Scalar>(
    contacts: &mut SurfaceContacts,
    largest: f64,
    (clock, cpu): (&Clock, &Cpu),
    bodies: &mut [BodySlices<'_, T>],
) {
    let coefficients = IntegrationCoefficients::<f64>::of(clock);
    let settling = contacts.settling(clock);
    let found = std::mem::take(&mut contacts.surface.found);
    let mut set = std::mem::take(&mut contacts.surface.set);
    release(&mut contacts.surface, bodies);
    begin(contacts, &found, (largest, settling), bodies);
    gather(contacts, &mut set, &found, (&coefficients, settling), bodies);
    forget(&mut contacts.surface, bodies);
    note_facing(contacts, &found, bodies);
    leave(&contacts.surface, bodies);
    set.solve(contacts.sweeps, cpu);
    let counts_work = clock.relaxation.is_none().then_some(&coefficients);
    note_touches(contacts, &set, counts_work, bodies);
    push(contacts, bodies);
    (contacts.surface.set, contacts.surface.found) = (set, found);
}

/// Finds how deep points may be inside: as deep as they are found there and no motion has brought them, by and by less.
/// A point that was not seen before (at the start, laid bare, at a corner that comes round) is not thrown out in a
/// step.
fn begin<T: Scalar>(
    contacts: &SurfaceContacts,
    found: &[Found],
    (largest, settling): (f64, f64),
    bodies: &mut [BodySlices<'_, T>],
) {
    for Found { place, faced } in found {
        let number = contacts.surface.lists.points[*place as usize];
        let kept = contacts.kept(number);
        let touch = bodies[kept.body].kept_mut(kept);
        let before = touch[3].to_f64();
        let allowed = faced.first.map_or(0.0, |facing| {
            let gap = contacts.gap(&contacts.surface.points[number as usize], &facing);
            let expected = match touch[4].to_f64() {
                FREE => 0.0,
                // as deep as any motion may have brought it
                FACES => touch[5].to_f64() - 2.0 * largest,
                _ => touch[5].to_f64(),
            };
            (before + (gap - expected).min(0.0) + settling).min(0.0).max(gap.min(0.0))
        });
        if allowed != before {
            touch[3] = T::from_f64(allowed);
        }
    }
}

/// The contacts of a step, and where the nodes would go that they act on.
fn gather<T: Scalar>(
    contacts: &mut SurfaceContacts,
    set: &mut ContactSet,
    found: &[Found],
    (coefficients, settling): (&IntegrationCoefficients<f64>, f64),
    bodies: &[BodySlices<'_, T>],
) {
    set.clear();
    let Surface { slots, met, acted_on, .. } = &mut contacts.surface;
    let (mut slots, mut met, mut acted_on) = (std::mem::take(slots), std::mem::take(met), std::mem::take(acted_on));
    met.clear();
    acted_on.clear();
    let surface = &contacts.surface;
    let mut slot_of = |node: u32, set: &mut ContactSet| {
        let slot = &mut slots[node as usize];
        if *slot == u32::MAX {
            *slot = acted_on.len() as u32;
            let (body, row) = surface.nodes[node as usize];
            let of_node = bodies[body as usize].foresee(row as usize, coefficients);
            set.steps.push(of_node.step);
            set.responses.push(of_node.free / of_node.to_force);
            set.earlier.push(of_node.before);
            acted_on.push(node);
        }
        *slot
    };
    for Found { place, faced } in found {
        let number = surface.lists.points[*place as usize];
        let point = &surface.points[number as usize];
        let kept = contacts.kept(number);
        let touch = bodies[kept.body].kept(kept);
        let both = [(faced.first, true), (faced.second, false)];
        for (facing, first) in both.into_iter().filter_map(|(facing, first)| facing.map(|facing| (facing, first))) {
            let body = surface.triangles.bodies[facing.triangle as usize];
            let Some(Meeting { friction, spring, .. }) = contacts.meeting(point.body, body) else { continue };
            let stuck = touch[4].to_f64() == STICKS;
            let slip = if first { vector_at(touch, 0) } else { DVec3::ZERO };
            let outside = contacts.gap(point, &facing);
            let gap = match first {
                true => (outside - touch[3].to_f64()).max(-OUT * contacts.edge),
                // nothing is known of how it got there
                false => outside.max(-settling),
            };
            let normal = facing.normal;
            let friction = if stuck { friction[0] } else { friction[1] };
            let mut contact = Contact::new((normal, gap), (friction, slip));
            point.parts().for_each(|(node, weight)| contact.add(slot_of(node, set), weight));
            let (nodes, weights) = surface.corners_of(point, &facing);
            nodes.into_iter().zip(weights).for_each(|(node, weight)| contact.add(slot_of(node, set), -weight));
            let within = if point.triangle.is_some() { SHARES * contacts.edge } else { 0.0 };
            let allowed = if first { touch[3].to_f64() } else { 0.0 };
            if ends(&mut contact, (spring, outside - allowed), set) < within {
                set.contacts.push(contact);
                met.push(Met { point: number, first, gap: outside });
            }
        }
    }
    for (pair, crossing) in &surface.crossings.found {
        let [one, other] = pair.map(|edge| surface.crossings.edges[edge as usize]);
        let Some(Meeting { friction, thickness, spring, .. }) = contacts.crossing(one.body, other.body) else {
            continue;
        };
        let outside = crossing.gap - thickness;
        // nothing is known of how it got there, nor of how it slipped
        let mut contact = Contact::new((crossing.normal, outside.max(-settling)), (friction[1], DVec3::ZERO));
        let [of_one, of_other] = crossing.weights;
        one.nodes.into_iter().zip(of_one).for_each(|(node, weight)| contact.add(slot_of(node, set), weight));
        other.nodes.into_iter().zip(of_other).for_each(|(node, weight)| contact.add(slot_of(node, set), -weight));
        if ends(&mut contact, (spring, outside), set) < 0.0 {
            set.contacts.push(contact);
            // nodes are the first of the points
            met.push(Met { point: one.nodes[0], first: false, gap: outside });
        }
    }
    acted_on.iter().for_each(|&node| slots[node as usize] = u32::MAX);
    let surface = &mut contacts.surface;
    (surface.slots, surface.met, surface.acted_on) = (slots, met, acted_on);
}

/// How far outside (m) a point would end that is to be kept there; with a spring how far it is, which is all that that
/// asks for: so far outside, or more than it may be inside.
fn ends(contact: &mut Contact, (spring, outside): (Option<ContactSpring>, f64), set: &ContactSet) -> f64 {
    let Some(spring) = spring else {
        return contact.gap + contact.normal.dot(contact.relative(&set.steps));
    };
    contact.springs = true;
    contact.gap = spring.gap(outside, contact.normal.dot(contact.relative(&set.earlier)));
    outside
}

/// Notes what points face, and how far they are outside of it.
fn note_facing<T: Scalar>(contacts: &mut SurfaceContacts, found: &[Found], bodies: &mut [BodySlices<'_, T>]) {
    for Found { place, faced } in found {
        let Some(first) = faced.first else { continue };
        let number = contacts.surface.lists.points[*place as usize];
        let gap = contacts.gap(&contacts.surface.points[number as usize], &first);
        let kept = contacts.kept(number);
        let touch = bodies[kept.body].kept_mut(kept);
        touch[4] = T::from_f64(FACES);
        touch[5] = T::from_f64(gap);
        contacts.surface.touching.push(number);
    }
}

/// Notes what contacts came to, and finds the forces on nodes, in the order of contacts.
fn note_touches<T: Scalar>(
    contacts: &mut SurfaceContacts,
    set: &ContactSet,
    counts_work: Option<&IntegrationCoefficients<f64>>,
    bodies: &mut [BodySlices<'_, T>],
) {
    let mut forces = std::mem::take(&mut contacts.surface.forces);
    forces.clear();
    forces.resize(set.steps.len(), DVec3::ZERO);
    let mut deepest = contacts.surface.figures.deepest;
    let surface = &contacts.surface;
    for (contact, met) in set.contacts.iter().zip(&surface.met).filter(|(contact, _)| contact.pressing > 0.0) {
        let force = contact.force();
        contact.parts().for_each(|(slot, weight)| forces[slot] += force * weight);
        let kept = contacts.kept(met.point);
        let touch = bodies[kept.body].kept_mut(kept);
        let after = contact.relative(&set.steps);
        deepest = deepest.max(-(met.gap + contact.normal.dot(after)));
        if met.first {
            set_vector(touch, 0, contact.slip);
            touch[4] = T::from_f64(if contact.slides { SLIDES } else { STICKS });
            touch[5] = T::from_f64(met.gap + contact.normal.dot(after));
        }
        if let Some(coefficients) = counts_work {
            let before = contact.relative(&set.earlier);
            let along = (after - contact.normal * after.dot(contact.normal)).length();
            let slid = touch[6].to_f64() + if contact.slides { along } else { 0.0 };
            let lost = touch[7].to_f64() - coefficients.work(force, before, after);
            touch[6] = T::from_f64(slid);
            touch[7] = T::from_f64(lost);
        }
    }
    contacts.surface.figures.deepest = deepest;
    contacts.surface.forces = forces;
}

/// Adds the forces to the loads.
fn push<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &mut [BodySlices<'_, T>]) {
    let Surface { nodes, acted_on, forces, pressed, .. } = &mut contacts.surface;
    let pushed = acted_on.iter().zip(&*forces).filter(|(_, force)| **force != DVec3::ZERO);
    for (&node, &force) in pushed {
        let (body, row) = nodes[node as usize];
        let (columns, row) = (&mut bodies[body as usize], row as usize);
        let load = vector(columns.external, row) + force;
        set_vector(columns.external, 3 * row, load);
        set_vector(columns.force, 3 * row, force);
        pressed.push(node);
    }
}
