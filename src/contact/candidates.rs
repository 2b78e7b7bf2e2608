//! Triangles that may be in a point's way, and how far it is outside of them.

use super::facing::Facing;
use super::shortlist::Stays;
use super::surfaces::{Placed, Surfaces};
use crate::mesh::OnTriangle;
use glam::DVec3;

/// Nearer than this to a triangle is on it, in edges, the smaller of its body's and the point's.
pub(super) const ON_IT: f64 = 1e-3;

/// What is at less than this of another distance is nearer, whatever rounding does.
pub(super) const NEARER: f64 = 1.0 - 1e-6;

/// Triangles that may be near a point, and how far they were when that was found.
#[derive(Clone, Copy, Debug)]
pub struct Listed<'a> {
    /// Their numbers, ascending.
    pub triangles: &'a [u32],
    /// How far each was at least (m).
    pub distances: &'a [f32],
    /// How much nearer anything can have come since (m).
    pub nearer: f64,
    /// Who is farther than this (m) is in nobody's way.
    pub farthest: f64,
}

impl Listed<'_> {
    /// Whether a triangle cannot have come near enough.
    pub(super) fn is_far(&self, place: usize) -> bool {
        self.distance(place) > self.farthest + self.nearer
    }

    /// How far a triangle was at least (m).
    pub(super) fn distance(&self, place: usize) -> f64 {
        f64::from(self.distances[place])
    }
}

/// A triangle, where it is nearest to a point, and how far that is (m).
pub(super) type Nearest = (u32, (OnTriangle, f64));

/// Room for what is found about a point, so that the next one need not ask for memory.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    pub(super) nearest: Vec<Nearest>,
}

/// Where triangles are nearest to a point: of those of its list that are looked at found beforehand.
pub(super) struct Candidates<'a, 'k> {
    surfaces: &'a Surfaces,
    now: Placed<'a>,
    at: DVec3,
    pub(super) listed: Listed<'a>,
    kept: &'k mut Vec<Nearest>,
}

impl<'a, 'k> Candidates<'a, 'k> {
    /// Of surfaces as they are now, with nothing found beforehand.
    #[inline]
    pub(super) fn new(
        (surfaces, now): (&'a Surfaces, Placed<'a>),
        at: DVec3,
        listed: Listed<'a>,
        kept: &'k mut Vec<Nearest>,
    ) -> Self {
        kept.clear();
        Self { surfaces, now, at, listed, kept }
    }

    /// Finds beforehand where a triangle is nearest.
    #[inline]
    pub(super) fn find(&mut self, triangle: u32) {
        let nearest = self.nearest_of(triangle);
        self.kept.push((triangle, nearest));
    }

    /// The same of all in the list; those that cannot be near enough are nowhere.
    pub(super) fn find_listed(&mut self) {
        for (place, &triangle) in self.listed.triangles.iter().enumerate() {
            let nowhere = || (OnTriangle { at: DVec3::ZERO, weights: [0.0; 3], part: 0 }, f64::INFINITY);
            let nearest = if self.listed.is_far(place) { nowhere() } else { self.nearest_of(triangle) };
            self.kept.push((triangle, nearest));
        }
    }

    #[inline(always)]
    fn nearest_of(&self, triangle: u32) -> (OnTriangle, f64) {
        let found = OnTriangle::nearest(self.at, self.surfaces.corners(self.now.places, triangle));
        (found, self.at.distance(found.at))
    }

    /// The nearest place of the triangle that was found as that number, and how far that is (m).
    #[inline]
    pub(super) fn nearest(&self, number: usize) -> &(OnTriangle, f64) {
        &self.kept[number].1
    }

    /// How far a triangle is (m), whether it is in the list or not; infinitely far where it cannot be near enough.
    fn distance(&self, triangle: u32) -> f64 {
        match self.kept.iter().find(|(other, ..)| *other == triangle) {
            Some(&(_, (_, distance))) => distance,
            None => self.nearest_of(triangle).1,
        }
    }

    /// Whether a triangle found beforehand that shares a part of one is nearer than a distance, by so much (both m).
    #[inline]
    fn shows_nearer(&self, triangle: u32, part: usize, (by, distance): (f64, f64)) -> bool {
        self.kept.iter().any(|&(other, (_, of_other))| {
            of_other + by < distance && other != triangle && self.surfaces.shares_part(other, triangle, part)
        })
    }

    /// Whether any triangle that shares a part of one is nearer than a distance, and by so much (both m).
    fn goes_on_nearer(&self, triangle: u32, part: usize, (by, distance): (f64, f64)) -> bool {
        let mut others = self.surfaces.around_part(triangle, part).filter(|&other| other != triangle);
        self.shows_nearer(triangle, part, (by, distance)) || others.any(|other| self.distance(other) + by < distance)
    }

    /// How far the point is outside of a triangle, whose nearest place is known; `None` where another triangle must be
    /// nearer, and of triangles without area. `edge` is the length of an edge (m).
    pub(super) fn outside(&self, triangle: u32, (found, distance): (OnTriangle, f64), edge: f64) -> Option<Facing> {
        let normal = self.surfaces.normal_now(self.now, triangle);
        if normal == DVec3::ZERO || !found.at.is_finite() {
            return None;
        }
        let off = self.at - found.at;
        let OnTriangle { at, weights, part } = found;
        let facing = |part: usize, normal: DVec3, gap: f64| {
            Some(Facing { triangle, weights, at, normal, gap, part: part as u32 })
        };
        // in front or behind of it, or on it, and not beside
        if part == 0 || distance <= ON_IT * edge {
            return facing(0, normal, off.dot(normal));
        }
        // the surface around a place that is nearest is nowhere nearer: not the flat surroundings of a point's own, nor
        // a side that leads round a corner
        if self.goes_on_nearer(triangle, part, (0.0, NEARER * distance)) {
            return None;
        }
        match off.dot(self.surfaces.normal_of_part(self.now, triangle, part)) {
            out if out >= 0.0 => facing(part, off / distance, distance),
            // of a corner that it has sunk into each wall bears it, as above it: the way to where both meet would swing
            // as far as it goes aside; in the wall's plane, so that forces act along one line. What is farther from
            // there than insides go is beyond the body, however near it is to the plane
            _ if distance <= self.surfaces.depths[triangle as usize]
                && self.surfaces.rises_beside(self.now, (triangle, part), (at, normal), edge) =>
            {
                let gap = off.dot(normal);
                let corners = self.surfaces.corners(self.now.places, triangle);
                let weights = OnTriangle::weights_in_plane(self.at - gap * normal, corners);
                Some(Facing { triangle, weights, at, normal, gap, part: 0 })
            }
            _ => facing(0, -off / distance, -distance),
        }
    }

    /// Whether a triangle that is in nobody's way stays so, however far nodes move that a shortlist allows for. `edge`
    /// is the length of an edge (m).
    pub(super) fn stays_away(&self, place: usize, (reach, edge): (f64, f64), stays: Stays) -> bool {
        let Stays { moved, reach: more } = stays;
        if self.listed.is_far(place) {
            return self.listed.distance(place) > self.listed.farthest + more + self.listed.nearer + moved;
        }
        let triangle = self.listed.triangles[place];
        let &(found, distance) = self.nearest(place);
        if distance - moved > f64::max(reach + more, self.surfaces.depths[triangle as usize]) {
            return true;
        }
        // both distances change by no more than that
        distance - moved > ON_IT * edge
            && found.keeps_part(self.at, self.surfaces.corners(self.now.places, triangle), moved)
            && self.goes_on_nearer(triangle, found.part, (moved, NEARER * (distance - moved)))
    }
}
