//! The contacts of a step: which points end too near what they face, and where nodes would go.

use super::body_slices::{BodySlices, set_vector, vector_at};
use super::faced::Found;
use super::meet::{FACES, FREE, STICKS};
use super::{Meeting, Surface, SurfaceContacts};
use crate::backend::cpu::IntegrationCoefficients;
use crate::components::*;
use crate::contact::{Contact, ContactSet};
use crate::math::Scalar;
use glam::DVec3;

/// How far a point that is inside comes out in a step at most, in edges.
pub(super) const OUT: f64 = 0.1;

/// Points of faces share their nodes' masses while they are no farther from touching than this, in edges: who shares
/// stays the same from step to step then, and pressures come to rest.
const SHARES: f64 = 1e-3;

/// A contact of the set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub point: u32,
    /// Whether it is the first face of the point: only there slip is kept.
    pub first: bool,
    /// How far it was outside (m).
    pub gap: f64,
}

/// What is the same for all points in a step.
pub(super) struct InStep<'a> {
    /// How far the fastest node went in the last step (m).
    pub largest: f64,
    /// How far points that are inside and may be come out (m).
    pub settling: f64,
    pub coefficients: &'a IntegrationCoefficients<f64>,
}

/// The contacts of a step, and what they act on.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered {
    pub set: ContactSet,
    /// The same before it is solved, where somebody looks afterwards.
    pub before: ContactSet,
    pub met: Vec<Met>,
    /// Nodes of the set, by their place in it.
    pub acted_on: Vec<u32>,
    /// Place of a node in the set, or none.
    pub slots: Vec<u32>,
    /// Points that face something.
    pub facing: Vec<u32>,
}

impl Gathered {
    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let of_nodes = size_of_val(&self.acted_on[..]) + size_of_val(&self.slots[..]);
        self.set.bytes() + self.before.bytes() + size_of_val(&self.met[..]) + of_nodes + size_of_val(&self.facing[..])
    }

    pub fn clear(&mut self) {
        self.set.clear();
        self.met.clear();
        self.acted_on.clear();
        self.facing.clear();
    }

    /// The place in the set of a node of a surface, and where that would go.
    pub(super) fn slot_of<T: Scalar>(
        &mut self,
        node: u32,
        (surface, in_step): (&Surface, &InStep<'_>),
        bodies: &[BodySlices<'_, T>],
    ) -> u32 {
        let slot = &mut self.slots[node as usize];
        if *slot == u32::MAX {
            *slot = self.acted_on.len() as u32;
            let (body, row) = surface.nodes[node as usize];
            let of_node = bodies[body as usize].foresee(row as usize, in_step.coefficients);
            self.set.steps.push(of_node.step);
            self.set.responses.push(of_node.free / of_node.to_force);
            self.set.earlier.push(of_node.before);
            self.acted_on.push(node);
        }
        *slot
    }

    /// Adds a contact of these nodes with signed weights, if it ends nearer than `within` (m): see [`ends`].
    #[inline]
    fn add<T: Scalar>(
        &mut self,
        (contact, met): (Contact, Met),
        [of_point, of_face]: [(&[u32], &[f64]); 2],
        (spring, outside, within): (Option<ContactSpring>, f64, f64),
        of: (&Surface, &InStep<'_>),
        bodies: &[BodySlices<'_, T>],
    ) {
        // where it stays if it is one: it is too large to be handed about
        self.set.contacts.push(contact);
        for ((nodes, weights), sign) in [(of_point, 1.0), (of_face, -1.0)] {
            // a triangle's corners are four of which the last has no weight
            for (&node, &weight) in nodes.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
                let slot = self.slot_of(node, of, bodies);
                if let Some(contact) = self.set.contacts.last_mut() {
                    contact.add(slot, sign * weight);
                }
            }
        }
        let ContactSet { contacts, steps, earlier, .. } = &mut self.set;
        let Some(contact) = contacts.last_mut() else { return };
        if ends(contact, (spring, outside), [steps, earlier]) < within {
            self.met.push(met);
        } else {
            contacts.pop();
        }
    }
}

/// How deep a point may be inside (m) that is so far outside (m) of what it faces: as deep as it is found there and no
/// motion has brought it, by and by less. A point that was not seen before (at the start, laid bare, at a corner that
/// comes round) is not thrown out in a step.
pub(super) fn allowed<T: Scalar>(touch: &[T], gap: f64, in_step: &InStep<'_>) -> f64 {
    let expected = match touch[4].to_f64() {
        FREE => 0.0,
        // as deep as any motion may have brought it
        FACES => touch[5].to_f64() - 2.0 * in_step.largest,
        _ => touch[5].to_f64(),
    };
    (touch[3].to_f64() + (gap - expected).min(0.0) + in_step.settling).min(0.0).max(gap.min(0.0))
}

/// The contacts of a step, and where the nodes would go that they act on; notes what points face, and how far they are
/// outside of it.
pub(super) fn gather<T: Scalar>(
    contacts: &SurfaceContacts,
    gathered: &mut Gathered,
    found: &[Found],
    in_step: &InStep<'_>,
    bodies: &mut [BodySlices<'_, T>],
) {
    let surface = &contacts.surface;
    for Found { place, faced, .. } in found {
        let number = surface.lists.points[*place as usize];
        let point = &surface.points[number as usize];
        let kept = contacts.kept(number);
        let touch = bodies[kept.body].kept_mut(kept);
        let Some(first) = &faced.first else {
            if touch[3] != T::default() {
                touch[3] = T::default();
            }
            continue;
        };
        let outside = contacts.gap(point, first);
        let allowed = allowed(touch, outside, in_step);
        if allowed != touch[3].to_f64() {
            touch[3] = T::from_f64(allowed);
        }
        let (stuck, slip) = (touch[4].to_f64() == STICKS, vector_at(touch, 0));
        set_vector(touch, 0, DVec3::ZERO);
        (touch[4], touch[5]) = (T::from_f64(FACES), T::from_f64(outside));
        gathered.facing.push(number);
        let allowed = touch[3].to_f64();
        let second = faced.second.as_ref().map(|facing| (facing, false));
        for (facing, is_first) in std::iter::once((first, true)).chain(second) {
            let body = surface.triangles.bodies[facing.triangle as usize];
            let Some(Meeting { friction, spring, .. }) = contacts.meeting(point.body, body) else { continue };
            let friction = if stuck { friction[0] } else { friction[1] };
            // of another face nothing is known of how it got there
            let (outside, allowed, slip) = match is_first {
                true => (outside, allowed, slip),
                false => (contacts.gap(point, facing), 0.0, DVec3::ZERO),
            };
            let gap = match is_first {
                true => (outside - allowed).max(-OUT * contacts.edge),
                false => outside.max(-in_step.settling),
            };
            let (corners, weights) = surface.corners_of(point, facing);
            let of_face = (&corners[..], &weights[..]);
            let within = if point.triangle.is_some() { SHARES * contacts.edge } else { 0.0 };
            gathered.add(
                (
                    Contact::new((facing.normal, gap), (friction, slip)),
                    Met { point: number, first: is_first, gap: outside },
                ),
                [point.slices(), of_face],
                (spring, outside - allowed, within),
                (surface, in_step),
                bodies,
            );
        }
    }
    for (pair, crossing) in &surface.crossings.found {
        let [one, other] = pair.map(|edge| surface.crossings.edges[edge as usize]);
        let Some(Meeting { friction, thickness, spring, .. }) = contacts.crossing(one.body, other.body) else {
            continue;
        };
        let outside = crossing.gap - thickness;
        // nothing is known of how it got there, nor of how it slipped
        let gap = outside.max(-in_step.settling);
        let [of_one, of_other] = &crossing.weights;
        gathered.add(
            (
                Contact::new((crossing.normal, gap), (friction[1], DVec3::ZERO)),
                // nodes are the first of the points
                Met { point: one.nodes[0], first: false, gap: outside },
            ),
            [(&one.nodes, of_one), (&other.nodes, of_other)],
            (spring, outside, 0.0),
            (surface, in_step),
            bodies,
        );
    }
}

/// How far outside (m) a point would end that is to be kept there; with a spring how far it is, which is all that that
/// asks for: so far outside, or more than it may be inside.
fn ends(
    contact: &mut Contact,
    (spring, outside): (Option<ContactSpring>, f64),
    [steps, earlier]: [&[DVec3]; 2],
) -> f64 {
    let Some(spring) = spring else {
        return contact.gap + contact.normal.dot(contact.relative(steps));
    };
    contact.springs = true;
    contact.gap = spring.gap(outside, contact.normal.dot(contact.relative(earlier)));
    outside
}
