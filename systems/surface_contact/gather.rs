//! The contacts of a step: which points end too near what they face, and where nodes would go.

use super::body_slices::{BodySlices, set_vector, vector_at};
use super::depth::{Outside, allowed, stiffness};
use super::faced::face;
use super::{Meeting, Surface, SurfaceContacts, crossings, turns};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Beginning, Contact, ContactSet, Faced, Facing, Parts, Point};
use crate::math::Scalar;
use crate::systems::tool_contact::STILL;
use glam::{DVec3, DVec4};
use smallvec::SmallVec;

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
    /// [`Contact::stiffness`].
    stiffness: Option<f64>,
    /// [`Contact::lets_out`].
    lets_out: f64,
    /// [`Contact::beside`].
    beside: f64,
}

/// What is known of a point that may be inside.
#[derive(Clone, Copy)]
struct Inside {
    /// How deep it may be (m), as [`allowed`] says.
    allowed: f64,
    /// How far that has come out in this step (m).
    settles: f64,
    /// [`Contact::stiffness`].
    stiffness: Option<f64>,
    /// [`Contact::beside`].
    beside: f64,
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
            (contact.stiffness, contact.lets_out, contact.beside) = (of.stiffness, of.lets_out, of.beside);
            batch.push(contact);
        }
    }
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
        let second = faced.second.as_ref().filter(|_| faced.tip.is_none());
        let other = second.map(|second| nodes.sight(contacts, of, second));
        let in_corner = other.is_some();
        let faced: SmallVec<[Outside; 2]> =
            [Some(&sight), other.as_ref()].into_iter().flatten().map(|sight| sight.outside).collect();
        let (allowed, settles) = allowed(touch, &faced, &in_step);
        // as it is kept
        let allowed = T::from_f64(allowed).to_f64();
        let stiffness = stiffness(touch, &faced, allowed);
        let outside = faced.iter().map(|outside| outside.now).fold(f64::INFINITY, f64::min);
        seen.push(Seen { point, outside, allowed, in_corner });
        // walls that meet at less than 90° push into each other
        let beside = other.as_ref().map_or(1.0, |other| 1.0 + sight.facing.normal.dot(other.facing.normal).min(0.0));
        let stiffness = clock.relaxation.is_none().then_some(stiffness);
        let inside = Inside { allowed, settles, stiffness, beside };
        let mut meet = |sight: Sight<'_>| {
            nodes.meet((contacts, of_bodies), (sight, touch), (point, inside), batch);
        };
        meet(sight);
        if let Some(other) = other {
            meet(other);
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
        let met = Met { point: one.nodes[0], of_point: false, outside, stiffness: None, lets_out: 0.0, beside: 1.0 };
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
        (number, inside): (u32, Inside),
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
        let Inside { allowed, settles, stiffness, beside } = inside;
        // what goes in takes energy, and may be let out as far
        let lets_out = settles.max(-outside.went);
        let outside_allowed = outside.now - allowed;
        let gap = outside_allowed.max(-OUT * edge);
        self.add(
            batch,
            parts,
            (facing.normal, gap),
            resists,
            (spring, outside_allowed, within),
            Met { point: number, of_point: true, outside: outside.now, stiffness, lets_out, beside },
        );
    }
}
