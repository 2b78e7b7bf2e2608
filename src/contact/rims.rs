//! Rims: where two flanks of a surface meet at an edge, which of them a point faces.

use super::facing::{ALIKE, Facing, TURNED_AWAY};
use super::surfaces::{Placed, Surfaces};
use crate::mesh::OnTriangle;
use glam::DVec3;

/// Flanks of a rim where the cosine between the normals is below this (60°).
const RIM: f64 = 0.5;

/// A point that may be at a rim.
pub(super) struct AtRim<'a> {
    /// Where it is (m).
    pub at: DVec3,
    /// Its own unit normal.
    pub own: DVec3,
    /// The triangles that may be near it, ascending.
    pub listed: &'a [u32],
    /// The length of an edge (m).
    pub edge: f64,
}

impl Surfaces {
    /// What a point faces that sees a face near its rim: the flank there that it faces more, as far outside of its
    /// plane as it is, or as deep inside; nothing where it is farther beyond the rim than a twentieth of an edge, and
    /// than it is outside. As it is seen where the point is well behind that flank, so that the face is a wall before
    /// it.
    ///
    /// Without this what slides over a flat surface catches at it: nodes of that are before the slider's front wall,
    /// too, as high above its rim as rounding has it, or what is sunk in.
    pub(super) fn flank(
        &self,
        now: Placed<'_>,
        point: &AtRim<'_>,
        facing: Facing,
        reach: impl Fn(u32) -> f64,
    ) -> Option<Facing> {
        let &AtRim { at, own, listed, edge } = point;
        let toward = own.dot(self.normal_now(now, facing.triangle));
        // of the others, the one that it faces most, of equal ones the nearest, and how much what it faces least
        let (mut most, mut least) = (None, f64::NEG_INFINITY);
        let mut best = f64::INFINITY;
        for (other, of_other) in self.flanks(now, &facing, edge) {
            let distance = at.distance(OnTriangle::nearest(at, self.corners(now.places, other)).at);
            let looked_at = distance <= f64::max(reach(other), self.depths[other as usize]);
            if !looked_at || listed.binary_search(&other).is_err() {
                continue;
            }
            let turned = own.dot(of_other);
            least = f64::max(least, turned);
            if turned < toward - TURNED_AWAY && turned + distance / edge < best {
                (most, best) = (Some((other, of_other)), turned + distance / edge);
            }
        }
        let (triangle, normal) = match most {
            Some(other) => other,
            // it is the face itself, not the round about its rim
            None if toward < least - TURNED_AWAY => (facing.triangle, self.normal_now(now, facing.triangle)),
            None => return Some(facing),
        };
        let corners = self.corners(now.places, triangle);
        let gap = (at - corners[0]).dot(normal);
        if gap <= -f64::min(ALIKE * edge, self.depths[triangle as usize]) {
            return Some(facing);
        }
        let below = at - gap * normal;
        let beyond = below.distance(OnTriangle::nearest(below, corners).at);
        if beyond < ALIKE * edge {
            let weights = weights_in_plane(below, corners);
            return Some(Facing { triangle, weights, at: below, normal, gap });
        }
        // farther beyond it is kept off the rim, as by a thickness
        (triangle == facing.triangle && gap > beyond).then_some(facing)
    }

    /// Whether a triangle may be at a rim as long as no two nodes move against each other by more than a distance (m).
    pub(super) fn may_have_rim(&self, now: Placed<'_>, triangle: u32, moved: f64) -> bool {
        let of = |triangle: u32| (self.normal_now(now, triangle), self.turns(now, triangle, moved));
        let (normal, turn) = of(triangle);
        self.triangles[triangle as usize].iter().flat_map(|&node| self.around(node)).any(|&other| {
            let (of_other, turn_of_other) = of(other);
            let (cosine, changes) = (normal.dot(of_other), turn + turn_of_other + turn * turn_of_other);
            // a triangle without area has no number
            other != triangle && !(cosine - changes >= RIM)
        })
    }

    /// Whether a place on a triangle is at a rim.
    pub(super) fn is_at_rim(&self, now: Placed<'_>, facing: &Facing, edge: f64) -> bool {
        self.flanks(now, facing, edge).next().is_some()
    }

    /// The triangles, with their normals, that fall off from one at a rim near a place on it; some of them twice.
    fn flanks<'a>(&'a self, now: Placed<'a>, facing: &Facing, edge: f64) -> impl Iterator<Item = (u32, DVec3)> + 'a {
        let &Facing { triangle, at, weights, .. } = facing;
        let near = ALIKE * edge;
        let [a, b, c] = self.corners(now.places, triangle);
        let (twice, opposite) = ((b - a).cross(c - a).length(), [c - b, a - c, b - a]);
        let is_near_side = (0..3).any(|corner| weights[corner] * twice < near * opposite[corner].length());
        let nodes = if is_near_side { &self.triangles[triangle as usize][..] } else { &[] };
        let (normal, middle) = (self.normal_now(now, triangle), (a + b + c) / 3.0);
        let around = nodes.iter().flat_map(|&node| self.around(node)).filter(move |other| **other != triangle);
        around.filter_map(move |&other| {
            let (of_other, corners) = (self.normal_now(now, other), self.corners(now.places, other));
            let falls_off = of_other.dot(normal) < RIM && of_other.dot(middle - corners[0]) < 0.0;
            let is_near = falls_off && OnTriangle::nearest(at, corners).at.distance(at) < near;
            (is_near && of_other != DVec3::ZERO).then_some((other, of_other))
        })
    }
}

/// What each corner of a triangle has of a place in its plane, also beyond its sides: there some have less than
/// nothing, so that forces act along one line on what bears and what is borne.
fn weights_in_plane(at: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let across = (b - a).cross(c - a);
    let of = |from: DVec3, to: DVec3| (from - at).cross(to - at).dot(across) / across.length_squared();
    let (of_b, of_c) = (of(c, a), of(a, b));
    [1.0 - of_b - of_c, of_b, of_c]
}

#[cfg(test)]
mod tests;
