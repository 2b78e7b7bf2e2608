//! Bodies in implicit steps: springs, whose forces are those at the end of the step that is solved for.

use super::body_slices::{BodySlices, Kept, set_vector, vector_at};
use super::gather::{Gathered, SHARES, allowed};
use super::meet::{FACES, SLIDES, STICKS, SignedNodes, forget, push, release};
use super::{Meeting, SurfaceContacts, crossings, faced, turns};
use crate::backend::cpu::{Cpu, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Contact, Facing, Parts, Point};
use crate::error::Error;
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use glam::{DMat3, DVec3};
use smallvec::SmallVec;

/// A point and what it faces in a step. Weights and normal are those at its beginning, as in explicit steps: what a
/// point faces would change all at once where it comes round a corner, and of some steps there were no end.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    meeting: Meeting,
    point: u32,
    /// Whether it is the first face of the point: only there it is kept how it got there, and how far it has slipped.
    first: bool,
    /// Whether edges cross, of which nothing is kept.
    crosses: bool,
    normal: DVec3,
    /// Nodes with signed weights.
    nodes: SignedNodes,
    /// How many of these, the first, are the point's: of the face's, too, some weights may be positive.
    points: usize,
    /// How deep it may be inside (m, 0 or negative): as deep as it is found where it was not before.
    allowed: f64,
    /// What is missing to the gap (m) beside the places of the nodes along the normal.
    offset: f64,
    /// How far a `thickness` has turned with the face (m), of free nodes in the step before: it is not slip.
    turned: DVec3,
}

impl Pair {
    /// The point's nodes and their weights.
    fn of_point(&self) -> &[(u32, f64)] {
        &self.nodes[..self.points]
    }

    /// How far the point is outside of where it may be (m), where nodes are.
    fn gap(&self, places: &[DVec3]) -> f64 {
        let along = |&(node, weight): &(u32, f64)| weight * self.normal.dot(places[node as usize]);
        self.offset + self.nodes.iter().map(along).sum::<f64>()
    }
}

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

/// Finds which points may touch what in the step that begins, of what points face.
pub(super) fn pair<T: Scalar>(
    contacts: &mut SurfaceContacts,
    (clock, cpu): (&Clock, &Cpu),
    reach: f64,
    bodies: &[BodySlices<'_, T>],
) {
    let mut found = std::mem::take(&mut contacts.surface.faced_by_task);
    found.resize_with(found.len().max(faced::tasks(contacts)), Vec::new);
    found.iter_mut().for_each(Vec::clear);
    faced::face(contacts, reach, cpu, found.iter_mut(), |_, point, faced, found| found.push((point, *faced)));
    crossings::find(contacts, reach);
    if clock.relaxation.is_none() {
        turns::update(contacts, bodies, cpu);
    }
    let mut pairs = std::mem::take(&mut contacts.surface.pairs);
    let surface = &contacts.surface;
    let mut add = |pair: Pair, gap: f64| {
        let offset = gap - pair.allowed - pair.gap(&surface.places);
        pairs.push(Pair { offset, ..pair });
    };
    // on the way to rest there is no motion
    let goes_on = |point: &Point, facing: &Facing| -> DVec3 {
        let step = |(node, weight): (u32, f64)| {
            let (body, row) = surface.nodes[node as usize];
            weight * vector_at(bodies[body as usize].step, 3 * row as usize)
        };
        if clock.relaxation.is_some() {
            return DVec3::ZERO;
        }
        surface.between(point, facing).0.into_iter().map(step).sum()
    };
    for &(number, faced) in found.iter().flatten() {
        let point = &surface.points[number as usize];
        let at_end = |facing: &Facing| contacts.faced_at_end(number, facing, true, goes_on);
        let both = [&faced.first, &faced.second].into_iter().flatten().map(at_end);
        let mut both: SmallVec<[Facing; 2]> = both.collect();
        // of walls that are as near rounding chooses which is the first, and what is kept of one would be taken for
        // what is kept of the other; both may end outside of the same
        both.sort_by_key(|facing| facing.triangle);
        both.dedup_by_key(|facing| facing.triangle);
        for (facing, first) in both.iter().zip([true, false]) {
            let body = surface.triangles.bodies[facing.triangle as usize];
            let Some(meeting) = contacts.meeting(point.body, body) else { continue };
            let in_step = contacts.in_step(point, facing, clock);
            let (nodes, points) = surface.between(point, facing);
            let (gap, kept) = (contacts.gap(point, facing), contacts.kept(number));
            let allowed = match (first, &clock.springs) {
                (true, _) => allowed(bodies[kept.body].kept(kept), gap, 0.0, &in_step),
                // at rest all presses, however it got there
                (false, _) if in_step.settling == f64::INFINITY => 0.0,
                (false, Some(springs)) => borne(contacts, (point, facing.normal, gap), (&meeting, springs), bodies),
                (false, None) => 0.0,
            };
            // on the way to rest nobody knows it before nodes are where they will be
            let turned = match clock.relaxation {
                None => contacts.turned(&meeting, (point, facing), bodies),
                Some(_) => DVec3::ZERO,
            };
            let (point, normal) = (number, facing.normal);
            let crosses = false;
            add(Pair { meeting, point, first, crosses, normal, nodes, points, allowed, offset: 0.0, turned }, gap);
        }
    }
    // nothing is known of how edges slipped that cross
    for (pair, crossing) in &surface.crossings.found {
        let [one, other] = pair.map(|edge| surface.crossings.edges[edge as usize]);
        let Some(meeting) = contacts.crossing(one.body, other.body) else { continue };
        let [of_one, of_other] = crossing.weights;
        let of_other = other.nodes.into_iter().zip(of_other).map(|(node, weight)| (node, -weight));
        let nodes = one.nodes.into_iter().zip(of_one).chain(of_other).collect();
        // nodes are the first of the points
        let pair = Pair {
            meeting,
            point: one.nodes[0],
            first: false,
            crosses: true,
            normal: crossing.normal,
            nodes,
            points: one.nodes.len(),
            allowed: 0.0,
            offset: 0.0,
            turned: DVec3::ZERO,
        };
        add(pair, crossing.gap - meeting.thickness);
    }
    (contacts.surface.pairs, contacts.surface.faced_by_task) = (pairs, found);
}

/// How deep a point may be inside of another face (m, 0 or negative), of which nothing is kept of how it got there: as
/// deep as the force along its normal at the end of the last step does not tell of.
fn borne<T: Scalar>(
    contacts: &SurfaceContacts,
    (point, normal, gap): (&Point, DVec3, f64),
    (meeting, springs): (&Meeting, &SolvedSprings),
    bodies: &[BodySlices<'_, T>],
) -> f64 {
    let Some(spring) = meeting.spring else { return 0.0 };
    let on_node = |(node, _): (u32, f64)| {
        let (body, row) = contacts.surface.nodes[node as usize];
        normal.dot(vector_at(bodies[body as usize].force, 3 * row as usize))
    };
    let force: f64 = point.parts().map(on_node).sum();
    let mass = mass_between(contacts, point.parts(), bodies);
    let stiffness = spring.press(springs, mass, 0.0, [0.0, springs.step]).stiffness;
    (gap + force.max(0.0) / stiffness).min(0.0)
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
        if pair.first {
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
    let &Pair { meeting, point, first, crosses, normal, .. } = pair;
    let Some(spring) = meeting.spring else { return };
    let kept = contacts.kept(point);
    let touch = bodies[kept.body].kept(kept);
    let state = touch[4].to_f64();
    // of a second face, too: what has slipped along both is the same
    let kept = if !crosses && state >= STICKS { vector_at(touch, 0) } else { DVec3::ZERO };
    let slip = kept - pair.turned;
    let friction = meeting.friction[usize::from(state == SLIDES)];
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
    (contact.point, contact.is_first, contact.outside) = (point, first, gap + pair.allowed);
    gathered.set.add(contact);
}

/// Notes what points do at the end of a step.
fn note<T: Scalar>(
    contacts: &mut SurfaceContacts,
    gathered: &Gathered,
    pairs: &[Pair],
    bodies: &mut [BodySlices<'_, T>],
) {
    for pair in pairs.iter().filter(|pair| pair.first) {
        let gap = pair.gap(&contacts.surface.places);
        let kept = contacts.kept(pair.point);
        let touch = bodies[kept.body].kept_mut(kept);
        set_vector(touch, 0, DVec3::ZERO);
        let numbers = [pair.allowed, FACES, gap + pair.allowed];
        touch[3..6].iter_mut().zip(numbers).for_each(|(touch, number)| *touch = T::from_f64(number));
    }
    contacts.surface.figures.contacts += gathered.set.count() as u64;
    for contact in gathered.set.contacts() {
        if contact.is_first {
            let kept = contacts.kept(contact.point);
            let touch = bodies[kept.body].kept_mut(kept);
            set_vector(touch, 0, contact.slip);
            touch[4] = T::from_f64(if contact.slides { SLIDES } else { STICKS });
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
