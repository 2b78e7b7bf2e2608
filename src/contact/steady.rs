//! How far surfaces may move before a point faces something else: until then a step looks at one triangle.
//!
//! Distances between a point and a triangle change by no more than the most that their nodes move against each other.
//! Which part of a triangle is nearest changes as slowly, but for turns: a triangle whose corners move by δ against each
//! other turns by about δ over its least height, and a place r away goes by r times that.

use super::facing::{Candidates, Faced, Facing, TURNED_AWAY};
use super::surfaces::{Placed, Point, Surfaces};
use crate::math::OnTriangle;
use glam::DVec3;

/// The most that is foreseen, in least heights of triangles: what is left out of turns is of second order.
const FORESEEN: f64 = 0.05;

/// How far the cosine between surfaces that face one another may change.
const TURN: f64 = 0.4;

/// What rounding takes of a margin at most, and more (edges).
const ROUNDING: f64 = 1e-9;

impl Surfaces {
    /// How far (m) all that is near may move against each other before something else is found that a point faces, than
    /// what was; 0 where that is not easily told: of corners and edges, and where something is near a bound. Until then
    /// [`still_faced`](Self::still_faced) finds what [`faced`](Self::faced) would.
    pub(super) fn steady(
        &self,
        now: Placed<'_>,
        point: &Point,
        candidates: &Candidates<'_>,
        faced: &Faced,
        reach: impl Fn(u32) -> f64,
        edge: f64,
    ) -> f64 {
        let mut least = match (&faced.first, &faced.second) {
            (_, Some(_)) => 0.0,
            (Some(first), None) => self.keeps_its_way(now, point, first),
            (None, None) => f64::INFINITY,
        };
        let ours = faced.first.map(|first| first.triangle);
        for (place, &triangle) in candidates.listed.triangles.iter().enumerate() {
            if least <= ROUNDING * edge {
                return 0.0;
            }
            if Some(triangle) != ours {
                least = least.min(self.stays_out(now, candidates, place, reach(triangle), edge));
            }
        }
        least - ROUNDING * edge
    }

    /// What a point faces that faced the inside of a triangle, as long as it is [steady](Self::steady); `None` where that
    /// has to be found anew.
    pub fn still_faced(&self, places: &[DVec3], point: &Point, triangle: u32, reach: f64) -> Option<Facing> {
        let at = point.place(places);
        let found = OnTriangle::nearest(at, self.corners(places, triangle));
        let normal = self.normal(places, triangle);
        let (gap, depth) = ((at - found.at).dot(normal), self.depths[triangle as usize]);
        let distance = at.distance(found.at);
        let is_near = distance <= reach || distance <= depth;
        let is_in_its_way = found.part == 0 && normal != DVec3::ZERO && is_near && gap >= -depth && gap <= reach;
        is_in_its_way.then_some(Facing { triangle, weights: found.weights, at: found.at, normal, gap })
    }

    /// How far (m) nodes may move until a point that faces the inside of a triangle may look away from it.
    fn keeps_its_way(&self, now: Placed<'_>, point: &Point, first: &Facing) -> f64 {
        let is_inside = first.weights.iter().all(|&weight| weight > 0.0);
        let height = |triangle: u32| least_height(self.corners(now.places, triangle));
        // by how much, for a step of one height, the point's normal changes, and the sum that it is the direction of
        let (own, change, heights) = match point.triangle {
            Some(triangle) => (now.normal(self, triangle), 1.2, height(triangle)),
            None => {
                let around = self.around(point.nodes[0]);
                let sum = self.sum_of_normals(now, point.nodes[0]);
                let heights = around.iter().map(|&triangle| height(triangle)).fold(f64::INFINITY, f64::min);
                // angles of up to 2π in all, and each changes at both of its sides
                let change = 2.0 * (7.0 + 2.2 * around.len() as f64) / sum.length();
                (sum.normalize_or_zero(), change, heights)
            }
        };
        if !is_inside || !(first.normal.dot(own) < TURNED_AWAY - TURN) {
            return 0.0;
        }
        let heights = heights.min(height(first.triangle));
        let turns = TURN / (change + 1.2);
        // what is no number is no bound
        if turns.is_finite() && heights.is_finite() { turns.min(FORESEEN) * heights } else { 0.0 }
    }

    /// How far (m) nodes may move until a triangle of the list may be in the point's way that is not.
    fn stays_out(&self, now: Placed<'_>, candidates: &Candidates<'_>, place: usize, reach: f64, edge: f64) -> f64 {
        let listed = &candidates.listed;
        let triangle = listed.triangles[place];
        let most = reach.max(self.depths[triangle as usize]);
        if listed.is_far(place) {
            return listed.distances[place] - listed.nearer - most;
        }
        let (found, distance) = candidates.nearest(self, now.places, place);
        let far = distance - most;
        if far >= FORESEEN * edge {
            return far;
        }
        let corners = self.corners(now.places, triangle);
        let on_its_part = || until_another_part(candidates.at, corners, found.part);
        let out = match found.part {
            0 if (candidates.at - found.at).dot(now.normal(self, triangle)) > 0.0 => {
                (distance - reach).min(on_its_part())
            }
            0 => 0.0,
            part => {
                let others = self.around_part(triangle, part).filter(|&other| other != triangle);
                let others = others.map(|other| candidates.distance(self, now.places, other));
                let nearest = others.fold(f64::INFINITY, f64::min);
                let closer = 0.5 * ((1.0 - 1e-6) * distance - nearest);
                let apart = distance - 1e-3 * edge;
                if closer.min(apart) > 0.0 { closer.min(apart).min(on_its_part()) } else { 0.0 }
            }
        };
        far.max(out)
    }
}

/// The least height of a triangle (m), 0 of one without area.
fn least_height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).length() / longest.sqrt().max(f64::MIN_POSITIVE)
}

/// How far (m) corners and a place y may move against each other until the nearest place is on another part of the
/// triangle than now, as [`OnTriangle::part`] counts them.
fn until_another_part(y: DVec3, corners: [DVec3; 3], part: usize) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let height = least_height(corners);
    if normal == DVec3::ZERO || height <= 0.0 {
        return 0.0;
    }
    let side = |side: usize| {
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let length = from.distance(to);
        let along = (to - from) / length;
        // how far beyond the side, beyond its end and before its beginning
        let (beyond, at) = (along.cross(normal).dot(y - from), along.dot(y - from));
        [beyond, along.dot(y - to), -at]
    };
    let margin = match part {
        0 => (0..3).map(|place| -side(place)[0]).fold(f64::INFINITY, f64::min),
        1..=3 => {
            let [beyond, after, before] = side(part - 1);
            beyond.min(-after).min(-before)
        }
        corner => side((corner - 4) % 3)[2].min(side((corner - 2) % 3)[1]),
    };
    let farthest = corners.into_iter().map(|corner| corner.distance_squared(y)).fold(0.0, f64::max).sqrt();
    (margin / (1.0 + 3.0 * farthest / height)).clamp(0.0, FORESEEN * height)
}

#[cfg(test)]
mod tests;
