//! What points face in a step, and the forces that keep them outside.

use super::{Meeting, MeetingColumns, MeetingColumnsReadOnlyItem, SurfaceContacts};
use crate::backend::cpu::{Cpu, Foreseen, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Contact, Faced, Facing, Point};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What a point did in the last step, in [`SurfaceTouch`].
pub(super) const FREE: f64 = 0.0;
const FACES: f64 = 1.0;
const STICKS: f64 = 2.0;
const SLIDES: f64 = 3.0;

/// How far a point that is inside comes out in a step at most, in edges.
const OUT: f64 = 0.1;

/// Points that a task looks at.
const POINTS_A_TASK: usize = 256;

/// A contact of the set.
struct Met {
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
}

/// What points face now: those in the lists that may be near something.
fn faced(contacts: &mut SurfaceContacts, reach: f64, cpu: &Cpu) -> Vec<(u32, Faced)> {
    let farthest = contacts.farthest(reach);
    let surface = &contacts.surface;
    let count = surface.lists.points.len();
    let task = |task: usize| {
        let mut found = Vec::new();
        for place in task * POINTS_A_TASK..count.min((task + 1) * POINTS_A_TASK) {
            if surface.travelled + farthest < surface.wake[place] {
                continue;
            }
            let point = &surface.points[surface.lists.points[place] as usize];
            let reach_of = |triangle: u32| {
                let body = surface.triangles.bodies[triangle as usize];
                reach + contacts.meeting(point.body, body).map_or(0.0, |meeting| meeting.thickness)
            };
            let triangles = surface.lists.triangles(place);
            found.push((
                place as u32,
                surface.triangles.faced(&surface.places, point, triangles, reach_of, contacts.edge),
            ));
        }
        found
    };
    let found = cpu.map(count.div_ceil(POINTS_A_TASK), task).concat();
    let surface = &mut contacts.surface;
    for (place, faced) in &found {
        // nobody can be there before the nearest has come so far
        surface.wake[*place as usize] = surface.travelled + faced.nearest;
    }
    found
}

/// Where a node would go, from what is known of its body.
fn foresee(
    columns: &MeetingColumnsReadOnlyItem<'_, '_>,
    row: usize,
    coefficients: &IntegrationCoefficients<f64>,
) -> Foreseen {
    let mass = columns.fictitious.map_or_else(|| columns.mass.get(row), |mass| mass.get(row));
    // inactive nodes stay where they are
    if mass <= 0.0 {
        return Foreseen { before: DVec3::ZERO, step: DVec3::ZERO, free: DVec3::ZERO, to_force: f64::INFINITY };
    }
    let damping = columns.damping.map_or(0.0, |damping| damping.get(row));
    let force = columns.external.vector(row) - columns.internal.vector(row);
    coefficients.foresee(mass, damping, columns.axes[row], columns.step.vector(row), force)
}

/// Finds the forces of a step and adds them to the loads.
pub(super) fn meet(
    contacts: &mut SurfaceContacts,
    reach: f64,
    clock: &Clock,
    cpu: &Cpu,
    bodies: &mut Query<MeetingColumns>,
) {
    let found = faced(contacts, reach, cpu);
    let coefficients = IntegrationCoefficients::<f64>::of(clock);
    let settling = contacts.settling(clock);
    begin(contacts, &found, settling, bodies);
    let (met, foreseen) = gather(contacts, &found, (&coefficients, settling), bodies);
    let mut set = std::mem::take(&mut contacts.surface.set);
    set.solve(contacts.sweeps);
    let work_factor = clock.relaxation.is_none().then_some(coefficients.work_factor);
    // forces on nodes, in the order of contacts
    let mut forces = vec![DVec3::ZERO; foreseen.len()];
    for (contact, met) in set.contacts.iter().zip(&met).filter(|(contact, _)| contact.pressing > 0.0) {
        let force = contact.force();
        contact.parts().for_each(|(slot, weight)| forces[slot] += force * weight);
        let (body, row) = contacts.surface.nodes[contacts.surface.points[met.point as usize].nodes[0] as usize];
        let Ok(mut columns) = bodies.get_mut(contacts.bodies[body as usize]) else { continue };
        let at = MEETING_NUMBERS * row as usize;
        let touch = &mut columns.touch;
        if met.first {
            touch.set_vector_at(at, contact.slip);
            touch.set(at + 4, if contact.slides { SLIDES } else { STICKS });
            touch.set(at + 5, met.gap + contact.normal.dot(contact.relative(&set.steps)));
        }
        if let Some(work_factor) = work_factor {
            let after = contact.relative(&set.steps);
            let before: DVec3 = contact.parts().map(|(slot, weight)| foreseen[slot].1.before * weight).sum();
            let along = (after - contact.normal * after.dot(contact.normal)).length();
            let slid = touch.get(at + 6) + if contact.slides { along } else { 0.0 };
            let lost = touch.get(at + 7) - work_factor * force.dot(0.5 * (before + after));
            touch.set(at + 6, slid);
            touch.set(at + 7, lost);
        }
    }
    for (&(node, _), &force) in foreseen.iter().zip(&forces) {
        contacts.surface.slots[node as usize] = u32::MAX;
        if force == DVec3::ZERO {
            continue;
        }
        let (body, row) = contacts.surface.nodes[node as usize];
        let Ok(mut columns) = bodies.get_mut(contacts.bodies[body as usize]) else { continue };
        let row = row as usize;
        let load = columns.external.vector(row) + force;
        columns.external.set_vector(row, load);
        columns.force.set_vector(row, force);
        contacts.surface.pressed.push(node);
    }
    contacts.surface.set = set;
}

/// Clears what the last step left, and finds how deep points may be inside: as deep as they are found there and no motion
/// has brought them, by and by less. A point that was not seen before (at the start, laid bare, at a corner that comes
/// round) is not thrown out in a step.
fn begin(contacts: &mut SurfaceContacts, found: &[(u32, Faced)], settling: f64, bodies: &mut Query<MeetingColumns>) {
    for node in std::mem::take(&mut contacts.surface.pressed) {
        let (body, row) = contacts.surface.nodes[node as usize];
        if let Ok(mut columns) = bodies.get_mut(contacts.bodies[body as usize]) {
            columns.force.set_vector(row as usize, DVec3::ZERO);
        }
    }
    let surface = &contacts.surface;
    for (place, faced) in found {
        let point = &surface.points[surface.lists.points[*place as usize] as usize];
        let (body, row) = surface.nodes[point.nodes[0] as usize];
        let Ok(mut columns) = bodies.get_mut(contacts.bodies[body as usize]) else { continue };
        let at = MEETING_NUMBERS * row as usize;
        let before = columns.touch.get(at + 3);
        let allowed = faced.first.map_or(0.0, |facing| {
            let gap = contacts.gap(point, &facing);
            let expected = match columns.touch.get(at + 4) {
                FREE => 0.0,
                // as deep as any motion may have brought it
                FACES => columns.touch.get(at + 5) - 2.0 * contacts.surface.largest,
                _ => columns.touch.get(at + 5),
            };
            (before + (gap - expected).min(0.0) + settling).min(0.0).max(gap.min(0.0))
        });
        if allowed != before {
            columns.touch.set(at + 3, allowed);
        }
    }
}

/// The contacts of a step, and where the nodes would go that they act on.
fn gather(
    contacts: &mut SurfaceContacts,
    found: &[(u32, Faced)],
    (coefficients, settling): (&IntegrationCoefficients<f64>, f64),
    bodies: &mut Query<MeetingColumns>,
) -> (Vec<Met>, Vec<(u32, Foreseen)>) {
    let mut set = std::mem::take(&mut contacts.surface.set);
    set.clear();
    let touched = std::mem::take(&mut contacts.surface.touching);
    let (mut met, mut foreseen): (Vec<Met>, Vec<(u32, Foreseen)>) = (Vec::new(), Vec::new());
    let mut slots = std::mem::take(&mut contacts.surface.slots);
    {
        let columns: Vec<_> = contacts.bodies.iter().filter_map(|&body| bodies.get(body).ok()).collect();
        let surface = &contacts.surface;
        let mut slot_of = |node: u32, set: &mut crate::contact::ContactSet| {
            let slot = &mut slots[node as usize];
            if *slot == u32::MAX {
                *slot = foreseen.len() as u32;
                let (body, row) = surface.nodes[node as usize];
                let of_node = foresee(&columns[body as usize], row as usize, coefficients);
                set.steps.push(of_node.step);
                set.responses.push(of_node.free / of_node.to_force);
                foreseen.push((node, of_node));
            }
            *slot
        };
        for (place, faced) in found {
            let number = surface.lists.points[*place as usize];
            let point = &surface.points[number as usize];
            let (body, row) = surface.nodes[point.nodes[0] as usize];
            let of_point = &columns[body as usize];
            let at = MEETING_NUMBERS * row as usize;
            let both = [(faced.first, true), (faced.second, false)];
            for (facing, first) in both.into_iter().filter_map(|(facing, first)| facing.map(|facing| (facing, first))) {
                let body = surface.triangles.bodies[facing.triangle as usize];
                let Some(Meeting { friction, .. }) = contacts.meeting(point.body, body) else { continue };
                let stuck = of_point.touch.get(at + 4) == STICKS;
                let slip = if first { of_point.touch.vector_at(at) } else { DVec3::ZERO };
                let outside = contacts.gap(point, &facing);
                let gap = match first {
                    true => (outside - of_point.touch.get(at + 3)).max(-OUT * contacts.edge),
                    // nothing is known of how it got there
                    false => outside.max(-settling),
                };
                let Facing { triangle, weights, normal, .. } = facing;
                let nodes = surface.triangles.triangles[triangle as usize];
                let friction = if stuck { friction[0] } else { friction[1] };
                let mut contact = Contact::new((normal, gap), (friction, slip));
                point.parts().for_each(|(node, weight)| contact.add(slot_of(node, &mut set), weight));
                nodes.into_iter().zip(weights).for_each(|(node, weight)| contact.add(slot_of(node, &mut set), -weight));
                if gap + normal.dot(contact.relative(&set.steps)) < 0.0 {
                    set.contacts.push(contact);
                    met.push(Met { point: number, first, gap: outside });
                }
            }
        }
    }
    // who touched or faced something before may do so no more
    for point in touched {
        let (body, row) = contacts.surface.nodes[contacts.surface.points[point as usize].nodes[0] as usize];
        if let Ok(mut columns) = bodies.get_mut(contacts.bodies[body as usize]) {
            let at = MEETING_NUMBERS * row as usize;
            columns.touch.set_vector_at(at, DVec3::ZERO);
            columns.touch.set(at + 4, FREE);
            columns.touch.set(at + 5, 0.0);
        }
    }
    for (place, faced) in found {
        let Some(first) = faced.first else { continue };
        let number = contacts.surface.lists.points[*place as usize];
        let point = contacts.surface.points[number as usize];
        let gap = contacts.gap(&point, &first);
        let (body, row) = contacts.surface.nodes[point.nodes[0] as usize];
        if let Ok(mut columns) = bodies.get_mut(contacts.bodies[body as usize]) {
            columns.touch.set(MEETING_NUMBERS * row as usize + 4, FACES);
            columns.touch.set(MEETING_NUMBERS * row as usize + 5, gap);
        }
        contacts.surface.touching.push(number);
    }
    (contacts.surface.set, contacts.surface.slots) = (set, slots);
    (met, foreseen)
}
