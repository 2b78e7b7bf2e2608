//! The contacts of a step: which points end too near what they face, and where nodes would go.

use super::body_slices::{BodySlices, set_vector, vector_at};
use super::faced::face;
use super::meet::share_at;
use super::{Meeting, Surface, SurfaceContacts, crossings, turns};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Beginning, Contact, ContactSet, Faced, Facing, Parts, Point};
use crate::math::Scalar;
use crate::systems::tool_contact::STILL;
use glam::{DVec3, DVec4};

/// How far a point that is inside comes out in a step at most, in the smaller edges of both bodies: elements of neither
/// are to turn over.
pub(super) const OUT: f64 = 0.1;

/// Points of faces share their nodes' masses while they are no farther from touching than this, in the smaller edges of
/// both bodies: who shares stays the same from step to step then, and pressures come to rest.
pub(super) const SHARES: f64 = 1e-3;

/// Nodes that a task foresees.
const NODES_A_TASK: usize = 1024;

/// What a point that faces something is noted to do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub point: u32,
    /// How far it is outside of what it faces, of two the less (m).
    pub outside: f64,
    /// How deep it may be inside (m).
    pub allowed: f64,
    /// Whether it faces two walls.
    pub in_corner: bool,
}

/// What is the same for all points in a step.
pub(super) struct InStep {
    /// How far the fastest node went in the last step (m).
    pub largest: f64,
    /// How far points that are inside and may be come out (m).
    pub settling: f64,
}

/// How a point is to something that it faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outside {
    /// How far it is outside now (m).
    pub now: f64,
    /// How far outwards it has gone since it was noted how far that was (m).
    pub since: f64,
    /// The same in the last step (m).
    pub went: f64,
}

/// The contacts of a step, and what they act on: nodes that are near something.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered {
    pub set: ContactSet,
    /// What its contacts begin the step with, where somebody looks afterwards.
    pub before: Vec<Beginning>,
    /// Points that face something, in batches as contacts are.
    seen: Vec<Vec<Seen>>,
    /// Place of each node of the surfaces in the set, of those that are near something.
    pub slots: Vec<u32>,
    /// Points that face something.
    pub facing: Vec<u32>,
}

impl Gathered {
    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let Self { set, before, seen, slots, facing } = self;
        let seen: usize = seen.iter().map(|seen| size_of_val(&seen[..])).sum();
        let of_points = seen + size_of_val(&facing[..]);
        set.bytes() + size_of_val(&before[..]) + of_points + size_of_val(&slots[..])
    }

    /// Forgets the last step, and has so many batches at least from now on.
    pub fn begin(&mut self, batches: usize) {
        self.set.begin(batches);
        self.seen.resize_with(batches.max(self.seen.len()), Vec::new);
        self.seen.iter_mut().for_each(Vec::clear);
        self.facing.clear();
    }

    /// Remembers into how many shares the masses of nodes were split that bore a force in the last step.
    pub fn remember_shares<T: Scalar>(&mut self, surface: &Surface, bodies: &[BodySlices<'_, T>]) {
        let near = &surface.near.nodes;
        let is_near = |&(slot, node): &(u32, u32)| near.get(slot as usize) == Some(&node);
        let of_pressed = surface.pressed.iter().map(|&node| (self.slots[node as usize], node)).filter(is_near);
        let share = |(slot, node): (u32, u32)| {
            let (body, row) = surface.nodes[node as usize];
            (slot, bodies[body as usize].touch[share_at(row)].to_f64())
        };
        self.set.shares_before.clear();
        self.set.shares_before.extend(of_pressed.map(share));
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
            cpu.dispatch(Foresee { surface, coefficients, bodies, nodes, steps, earlier, responses });
        });
    }
}

/// The task of foreseeing where some nodes would go.
struct Foresee<'a, 'b, T> {
    surface: &'a Surface,
    coefficients: &'a IntegrationCoefficients<f64>,
    bodies: &'a [BodySlices<'b, T>],
    nodes: &'a [u32],
    steps: &'a mut [DVec4],
    earlier: &'a mut [DVec4],
    responses: &'a mut [DVec4],
}

impl<T: Scalar> pulp::WithSimd for Foresee<'_, '_, T> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { surface, coefficients, bodies, nodes, steps, earlier, responses } = self;
        for (((node, step), before), response) in nodes.iter().zip(steps).zip(earlier).zip(responses) {
            let (body, row) = surface.nodes[*node as usize];
            let of_node = bodies[body as usize].foresee(row as usize, coefficients);
            (*step, *before) = (of_node.step.extend(0.0), of_node.before.extend(0.0));
            *response = (of_node.free / of_node.to_force).extend(0.0);
        }
    }
}

/// What is noted in a contact of who meets.
struct Met {
    point: u32,
    of_point: bool,
    outside: f64,
}

/// Nodes whose steps are foreseen.
struct Nodes<'a> {
    slots: &'a [u32],
    steps: &'a [DVec4],
    earlier: &'a [DVec4],
    /// [`IntegrationCoefficients::work_factor`].
    work_factor: f64,
}

impl Nodes<'_> {
    /// Nodes with weights against others.
    #[inline(always)] // with the instructions of whoever asks
    fn between(&self, [of_point, of_face]: [(&[u32], &[f64]); 2]) -> Parts {
        let mut parts = Parts::default();
        for (&node, &weight) in of_point.0.iter().zip(of_point.1) {
            parts.add(self.slots[node as usize], weight);
        }
        for (&node, &weight) in of_face.0.iter().zip(of_face.1) {
            parts.add(self.slots[node as usize], -weight);
        }
        parts
    }

    /// Those of a point against what it faces.
    #[inline(always)] // likewise
    fn parts(&self, surface: &Surface, point: &Point, facing: &Facing) -> Parts {
        let (corners, weights) = surface.corners_of(point, facing);
        self.between([point.slices(), (&corners[..], &weights[..])])
    }

    /// What a point faces of what it sees, by where it would end.
    fn faced_at_end(&self, contacts: &SurfaceContacts, number: u32, faced: &Faced) -> Faced {
        let step = |point: &Point, facing: &Facing| self.parts(&contacts.surface, point, facing).step(self.steps);
        let at_end = |facing: &Facing| contacts.faced_at_end(number, facing, false, step);
        let [first, second] = [&faced.first, &faced.second].map(|facing| facing.as_ref().map(at_end));
        // both may end outside of the same
        let is_other = |second: &Facing| first.is_none_or(|first| first.triangle != second.triangle);
        Faced { first, second: second.filter(is_other), ..*faced }
    }

    /// Adds a contact of nodes with weights, along a normal with a gap (m), if it ends nearer than `within` (m): as far
    /// outside (m) as that; with a spring, which asks for nothing else, as far as it is. Only then it is asked for
    /// friction and slip (m).
    #[inline(always)] // likewise
    fn add(
        &self,
        batch: &mut Vec<Contact>,
        parts: Parts,
        (normal, gap): (DVec3, f64),
        resists: impl FnOnce() -> (f64, DVec3),
        (spring, outside, within): (Option<ContactSpring>, f64, f64),
        of: Met,
    ) {
        let step = parts.step(self.steps);
        let (gap, ends) = match spring {
            None => (gap, gap + normal.dot(step)),
            Some(spring) => {
                let outwards = normal.dot(parts.step(self.earlier));
                (self.work_factor * spring.gap(outside, outwards), outside)
            }
        };
        if ends < within {
            let mut contact = Contact::new(parts, (normal, gap, step), resists());
            (contact.springs, contact.point) = (spring.is_some(), of.point);
            (contact.of_point, contact.outside) = (of.of_point, of.outside);
            batch.push(contact);
        }
    }
}

/// How deep a point may be inside (m) of what it faces, one face or the two walls of a corner: as deep as it is found
/// there and no motion has brought it, by and by less. A point that was not seen before (at the start, laid bare, at a
/// corner that comes round) is not thrown out in a step. One that touches went outwards as far as it did in the last
/// step, and not as far as was foreseen: tools may have held what it touches.
///
/// Of walls that change places it is not known which was which. So what has faced two, and what has touched nothing, is
/// taken to have gone as far as any motion may have brought it; and of two, one of which it has touched, that one is
/// the one of which motion tells more.
pub(super) fn allowed<T: Scalar>(touch: &[T], faced: &[Outside], in_step: &InStep) -> f64 {
    let [before, last] = [touch[3].to_f64(), touch[5].to_f64()];
    let PointState { did, in_corner } = PointState::of(touch[4].to_f64());
    let lowest = faced.iter().map(|outside| outside.now).fold(f64::INFINITY, f64::min);
    let unexpected = |outside: &Outside| outside.now - (last + outside.since);
    let deeper = match (did, faced) {
        (Did::Free, _) => lowest,
        (Did::Sticks | Did::Slides, [one]) if !in_corner => unexpected(one),
        (Did::Sticks | Did::Slides, [one, other]) if !in_corner => {
            let is_one = unexpected(one).abs() <= unexpected(other).abs();
            let (old, new) = if is_one { (one, other) } else { (other, one) };
            // behind the line where both meet it is behind the other as far as in the one, or less
            unexpected(old).min((new.now - new.went) - (old.now - old.went).min(0.0))
        }
        _ => lowest - (last - 2.0 * in_step.largest),
    };
    (before + deeper.min(0.0) + in_step.settling).min(0.0).max(lowest.min(0.0))
}

/// Finds what points face, and the contacts of a step, of nodes whose steps are foreseen; notes what points face, and
/// how far they are outside of it.
pub(super) fn gather<T: Scalar>(
    contacts: &mut SurfaceContacts,
    gathered: &mut Gathered,
    (clock, reach, cpu): (&Clock, f64, &Cpu),
    bodies: &mut [BodySlices<'_, T>],
) {
    let Gathered { set: ContactSet { batches, steps, earlier, .. }, slots, seen, facing, .. } = gathered;
    let work_factor = IntegrationCoefficients::<f64>::of(clock).work_factor;
    let nodes = Nodes { slots, steps, earlier, work_factor };
    let of_bodies = &*bodies;
    turns::update(contacts, of_bodies, cpu);
    face(contacts, reach, cpu, batches.iter_mut().zip(&mut *seen), |contacts, point, faced, (batch, seen)| {
        let at_end = faced.is_beside().then(|| nodes.faced_at_end(contacts, point, faced));
        let faced = at_end.as_ref().unwrap_or(faced);
        let Some(first) = faced.tip.as_ref().or(faced.first.as_ref()) else { return };
        let kept = contacts.kept(point);
        let touch = of_bodies[kept.body].kept(kept);
        let of = &contacts.surface.points[point as usize];
        let in_step = contacts.in_step(of, first, clock);
        let sight = nodes.sight(contacts, of, first);
        // as it is kept
        let allowed = |faced: &[Outside]| T::from_f64(allowed(touch, faced, &in_step)).to_f64();
        let mut meet = |sight: Sight<'_>, allowed: f64| {
            nodes.meet((contacts, of_bodies), (sight, touch), (point, allowed), batch);
        };
        let second = faced.second.as_ref().filter(|_| faced.tip.is_none());
        let other = second.map(|second| nodes.sight(contacts, of, second));
        let in_corner = other.is_some();
        let (outside, allowed) = match &other {
            Some(other) => (sight.outside.now.min(other.outside.now), allowed(&[sight.outside, other.outside])),
            None => (sight.outside.now, allowed(&[sight.outside])),
        };
        seen.push(Seen { point, outside, allowed, in_corner });
        meet(sight, allowed);
        if let Some(other) = other {
            meet(other, allowed);
        }
    });
    for &Seen { point, outside, allowed, in_corner } in seen.iter().flatten() {
        let kept = contacts.kept(point);
        let touch = bodies[kept.body].kept_mut(kept);
        set_vector(touch, 0, DVec3::ZERO);
        let state = PointState { did: Did::Faces, in_corner }.number();
        touch[3..6].iter_mut().zip([allowed, state, outside]).for_each(|(of, number)| *of = T::from_f64(number));
        facing.push(point);
    }
    crossings::find(contacts, reach);
    let (surface, Some(last)) = (&contacts.surface, batches.last_mut()) else { return };
    for (pair, crossing) in &surface.crossings.found {
        let [one, other] = pair.map(|edge| surface.crossings.edges[edge as usize]);
        let Some(meeting) = contacts.crossing(one.body, other.body) else { continue };
        let Meeting { friction, thickness, spring, .. } = meeting;
        let outside = crossing.gap - thickness;
        // nothing is known of how it got there, nor of how it slipped
        let gap = outside.max(-meeting.settling(clock));
        let [of_one, of_other] = &crossing.weights;
        // nodes are the first of the points
        let met = Met { point: one.nodes[0], of_point: false, outside };
        nodes.add(
            last,
            nodes.between([(&one.nodes, of_one), (&other.nodes, of_other)]),
            (crossing.normal, gap),
            || (friction[1], DVec3::ZERO),
            (spring, outside, 0.0),
            met,
        );
    }
}

/// Something that a point faces, and how it is to that.
struct Sight<'a> {
    facing: &'a Facing,
    /// The point's nodes against those of the face.
    parts: Parts,
    outside: Outside,
}

impl Nodes<'_> {
    #[inline(always)] // likewise
    fn sight<'a>(&self, contacts: &SurfaceContacts, point: &Point, facing: &'a Facing) -> Sight<'a> {
        let parts = self.parts(&contacts.surface, point, facing);
        let went = facing.normal.dot(parts.step(self.earlier));
        Sight { facing, parts, outside: Outside { now: contacts.gap(point, facing), since: went, went } }
    }

    /// The contact of a point with something that it faces, with what is kept of it.
    #[inline(always)] // likewise
    fn meet<T: Scalar>(
        &self,
        (contacts, bodies): (&SurfaceContacts, &[BodySlices<'_, T>]),
        (Sight { facing, parts, outside }, touch): (Sight<'_>, &[T]),
        (number, allowed): (u32, f64),
        batch: &mut Vec<Contact>,
    ) {
        let surface = &contacts.surface;
        let point = &surface.points[number as usize];
        let Some(meeting) = contacts.meeting(point.body, surface.triangles.bodies[facing.triangle as usize]) else {
            return;
        };
        let Meeting { friction, spring, edge, .. } = meeting;
        let resists = || {
            let did = PointState::of(touch[4].to_f64()).did;
            let turned = contacts.turned(&meeting, (point, facing), bodies);
            // what touched nothing and does not slip is held by the static coefficient
            let still = || {
                let before = parts.step(self.earlier) - turned;
                (before - facing.normal * facing.normal.dot(before)).length() <= STILL * edge
            };
            let is_held = did == Did::Sticks || did != Did::Slides && friction[0] != friction[1] && still();
            (friction[usize::from(!is_held)], vector_at(touch, 0) - turned)
        };
        let within = if point.triangle.is_some() { SHARES * edge } else { 0.0 };
        let gap = (outside.now - allowed).max(-OUT * edge);
        self.add(
            batch,
            parts,
            (facing.normal, gap),
            resists,
            (spring, outside.now - allowed, within),
            Met { point: number, of_point: true, outside: outside.now },
        );
    }
}

#[cfg(test)]
mod tests;
