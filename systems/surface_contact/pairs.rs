//! Which points may touch what in an implicit step, found as it begins.

use super::body_slices::{BodySlices, vector_at};
use super::gather::{Outside, allowed};
use super::meet::SignedNodes;
use super::{Meeting, SurfaceContacts, crossings, faced, turns};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{Facing, Point};
use crate::math::Scalar;
use glam::DVec3;
use smallvec::SmallVec;

/// Which of what a point may meet: what is kept of a step to the next differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What {
    /// Its first face: it is kept how it got there, and how far it has slipped.
    First,
    /// Another one, which knows how far the point has slipped.
    Second,
    /// An edge that crosses one, of which nothing is kept.
    Crossing,
}

/// A point and what it faces in a step. Weights and normal are those at its beginning, as in explicit steps: what a
/// point faces would change all at once where it comes round a corner, and of some steps there were no end.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub meeting: Meeting,
    pub point: u32,
    pub what: What,
    pub normal: DVec3,
    /// Nodes with signed weights.
    pub nodes: SignedNodes,
    /// How many of these, the first, are the point's: of the face's, too, some weights may be positive.
    pub points: usize,
    /// How deep it may be inside (m, 0 or negative): as deep as it is found where it was not before.
    pub allowed: f64,
    /// What is missing to the gap (m) beside the places of the nodes along the normal.
    pub offset: f64,
    /// How far a `thickness` has turned with the face (m), of free nodes in the step before: it is not slip.
    pub turned: DVec3,
}

impl Pair {
    /// The point's nodes and their weights.
    pub fn of_point(&self) -> &[(u32, f64)] {
        &self.nodes[..self.points]
    }

    /// How far the point is outside of where it may be (m), where nodes are.
    pub fn gap(&self, places: &[DVec3]) -> f64 {
        let along = |&(node, weight): &(u32, f64)| weight * self.normal.dot(places[node as usize]);
        self.offset + self.nodes.iter().map(along).sum::<f64>()
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
        let sights = both.iter().filter_map(|facing| {
            let meeting = contacts.meeting(point.body, surface.triangles.bodies[facing.triangle as usize])?;
            let went = facing.normal.dot(goes_on(point, facing));
            // how far it is outside was noted at the end of that
            Some((facing, meeting, Outside { now: contacts.gap(point, facing), since: 0.0, went }))
        });
        let sights: SmallVec<[(&Facing, Meeting, Outside); 2]> = sights.collect();
        let Some(first) = sights.first() else { continue };
        let faced: SmallVec<[Outside; 2]> = sights.iter().map(|&(.., outside)| outside).collect();
        let kept = contacts.kept(number);
        let allowed = allowed(bodies[kept.body].kept(kept), &faced, &contacts.in_step(point, first.0, clock));
        for (&(facing, meeting, outside), what) in sights.iter().zip([What::First, What::Second]) {
            let (nodes, points) = surface.between(point, facing);
            // on the way to rest nobody knows it before nodes are where they will be
            let turned = match clock.relaxation {
                None => contacts.turned(&meeting, (point, facing), bodies),
                Some(_) => DVec3::ZERO,
            };
            let (point, normal) = (number, facing.normal);
            add(Pair { meeting, point, what, normal, nodes, points, allowed, offset: 0.0, turned }, outside.now);
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
            what: What::Crossing,
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
