//! The contacts of a step: which points end too near what they face, and where nodes would go.

use super::body_slices::{BodySlices, set_vector, vector_at};
use super::faced::Found;
use super::meet::{FACES, FREE, STICKS};
use super::{Meeting, Surface, SurfaceContacts};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Beginning, Contact, ContactSet, Parts};
use crate::math::Scalar;
use glam::{DVec3, DVec4};

/// How far a point that is inside comes out in a step at most, in edges.
pub(super) const OUT: f64 = 0.1;

/// Points of faces share their nodes' masses while they are no farther from touching than this, in edges: who shares
/// stays the same from step to step then, and pressures come to rest.
const SHARES: f64 = 1e-3;

/// Nodes that a task foresees.
const NODES_A_TASK: usize = 1024;

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
pub(super) struct InStep {
    /// How far the fastest node went in the last step (m).
    pub largest: f64,
    /// How far points that are inside and may be come out (m).
    pub settling: f64,
}

/// The contacts of a step, and what they act on: nodes that are near something.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered {
    pub set: ContactSet,
    /// What its contacts begin the step with, where somebody looks afterwards.
    pub before: Vec<Beginning>,
    pub met: Vec<Met>,
    /// Place of each node of the surfaces in the set, of those that are near something.
    pub slots: Vec<u32>,
    /// Points that face something.
    pub facing: Vec<u32>,
}

impl Gathered {
    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let Self { set, before, met, slots, facing } = self;
        let of_points = size_of_val(&met[..]) + size_of_val(&facing[..]);
        set.bytes() + size_of_val(&before[..]) + of_points + size_of_val(&slots[..])
    }

    pub fn clear(&mut self) {
        self.set.clear();
        self.met.clear();
        self.facing.clear();
    }

    /// Foresees where the nodes would go that are near something: one after the other in the order of their rows, so
    /// that columns are read as they lie.
    pub fn foresee<T: Scalar>(
        &mut self,
        surface: &Surface,
        coefficients: &IntegrationCoefficients<f64>,
        bodies: &[BodySlices<'_, T>],
        cpu: &Cpu,
    ) {
        let near = &surface.near.nodes;
        let ContactSet { steps, earlier, responses, .. } = &mut self.set;
        for all in [&mut *steps, &mut *earlier, &mut *responses] {
            all.resize(near.len(), DVec4::ZERO);
        }
        let of_steps = steps.chunks_mut(NODES_A_TASK).zip(earlier.chunks_mut(NODES_A_TASK));
        let tasks = near.chunks(NODES_A_TASK).zip(of_steps.zip(responses.chunks_mut(NODES_A_TASK)));
        cpu.for_each(tasks, |(nodes, ((steps, earlier), responses))| {
            for (((node, step), before), response) in nodes.iter().zip(steps).zip(earlier).zip(responses) {
                let (body, row) = surface.nodes[*node as usize];
                let of_node = bodies[body as usize].foresee(row as usize, coefficients);
                (*step, *before) = (of_node.step.extend(0.0), of_node.before.extend(0.0));
                *response = (of_node.free / of_node.to_force).extend(0.0);
            }
        });
    }

    /// Adds a contact of these nodes with weights, along a normal with a gap (m) and with friction and slip, if it ends
    /// nearer than `within` (m): as far outside (m) as that; with a spring, which asks for nothing else, as far as it
    /// is.
    #[inline]
    fn add(
        &mut self,
        [of_point, of_face]: [(&[u32], &[f64]); 2],
        ((normal, gap), resists): ((DVec3, f64), (f64, DVec3)),
        (spring, outside, within): (Option<ContactSpring>, f64, f64),
        met: Met,
    ) {
        let Self { set, slots, .. } = self;
        let mut parts = Parts::default();
        for (&node, &weight) in of_point.0.iter().zip(of_point.1) {
            parts.add(slots[node as usize], weight);
        }
        for (&node, &weight) in of_face.0.iter().zip(of_face.1) {
            parts.add(slots[node as usize], -weight);
        }
        let step = parts.step(&set.steps);
        let (gap, ends) = match spring {
            None => (gap, gap + normal.dot(step)),
            Some(spring) => (spring.gap(outside, normal.dot(parts.step(&set.earlier))), outside),
        };
        if ends < within {
            let mut contact = Contact::new(parts, (normal, gap, step), resists);
            contact.springs = spring.is_some();
            set.add(contact);
            self.met.push(met);
        }
    }
}

/// How deep a point may be inside (m) that is so far outside (m) of what it faces: as deep as it is found there and no
/// motion has brought it, by and by less. A point that was not seen before (at the start, laid bare, at a corner that
/// comes round) is not thrown out in a step.
pub(super) fn allowed<T: Scalar>(touch: &[T], gap: f64, in_step: &InStep) -> f64 {
    let expected = match touch[4].to_f64() {
        FREE => 0.0,
        // as deep as any motion may have brought it
        FACES => touch[5].to_f64() - 2.0 * in_step.largest,
        _ => touch[5].to_f64(),
    };
    (touch[3].to_f64() + (gap - expected).min(0.0) + in_step.settling).min(0.0).max(gap.min(0.0))
}

/// The contacts of a step, of nodes whose steps are foreseen; notes what points face, and how far they are outside of
/// it.
pub(super) fn gather<T: Scalar>(
    contacts: &SurfaceContacts,
    gathered: &mut Gathered,
    found: &[Found],
    in_step: &InStep,
    bodies: &mut [BodySlices<'_, T>],
) {
    let surface = &contacts.surface;
    for Found { place, faced } in found {
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
                [point.slices(), of_face],
                ((facing.normal, gap), (friction, slip)),
                (spring, outside - allowed, within),
                Met { point: number, first: is_first, gap: outside },
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
        // nodes are the first of the points
        let met = Met { point: one.nodes[0], first: false, gap: outside };
        gathered.add(
            [(&one.nodes, of_one), (&other.nodes, of_other)],
            ((crossing.normal, gap), (friction[1], DVec3::ZERO)),
            (spring, outside, 0.0),
            met,
        );
    }
}
