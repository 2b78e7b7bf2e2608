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
    /// plane as it is, or as deep inside. `None` where that is the face itself, or where the point is well behind the
    /// other flank, so that the face is a wall before it.
    ///
    /// Without this what slides over a flat surface catches at it: nodes of that are before the slider's front wall,
    /// too, as high above its rim as rounding has it, or what is sunk in.
    pub(super) fn flank(
        &self,
        now: Placed<'_>,
        point: &AtRim<'_>,
        facing: &Facing,
        reach: impl Fn(u32) -> f64,
    ) -> Option<Facing> {
        let &AtRim { at, own, listed, edge } = point;
        let triangle = facing.triangle;
        if !self.is_near_side(now.places, facing, edge) {
            return None;
        }
        let (normal, near) = (self.normal_now(now, triangle), ALIKE * edge);
        let [a, b, c] = self.corners(now.places, triangle);
        let (middle, toward) = ((a + b + c) / 3.0, own.dot(normal));
        // of the others, the one that it faces most, and how much the one that it faces least
        let mut most: Option<(f64, u32, DVec3, OnTriangle)> = None;
        let mut least = f64::NEG_INFINITY;
        for other in self.triangles[triangle as usize].iter().flat_map(|&node| self.around(node)).copied() {
            let of_other = self.normal_now(now, other);
            let corners = self.corners(now.places, other);
            let is_flank = of_other.dot(normal) < RIM && of_other.dot(middle - corners[0]) < 0.0;
            if other == triangle || of_other == DVec3::ZERO || !is_flank {
                continue;
            }
            let is_near = OnTriangle::nearest(facing.at, corners).at.distance(facing.at) < near;
            let nearest = OnTriangle::nearest(at, corners);
            let looked_at = at.distance(nearest.at) <= f64::max(reach(other), self.depths[other as usize]);
            if !is_near || !looked_at || listed.binary_search(&other).is_err() {
                continue;
            }
            let turned = own.dot(of_other);
            least = f64::max(least, turned);
            if most.is_none_or(|(known, ..)| turned < known) {
                most = Some((turned, other, of_other, nearest));
            }
        }
        let (triangle, normal, OnTriangle { at: nearest, weights, .. }) = match most {
            Some((turned, other, normal, nearest)) if turned < toward - TURNED_AWAY => (other, normal, nearest),
            // it is the face itself, not the round about its rim
            Some(_) if toward < least - TURNED_AWAY => (triangle, normal, OnTriangle::nearest(at, [a, b, c])),
            _ => return None,
        };
        let gap = (at - nearest).dot(normal);
        let deep = f64::min(near, self.depths[triangle as usize]);
        (gap > -deep).then_some(Facing { triangle, weights, at: nearest, normal, gap })
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

    /// Whether a place on a triangle is so near to one of its sides that a rim may be there.
    pub(super) fn is_near_side(&self, places: &[DVec3], facing: &Facing, edge: f64) -> bool {
        let [a, b, c] = self.corners(places, facing.triangle);
        let twice = (b - a).cross(c - a).length();
        let opposite = [c - b, a - c, b - a];
        (0..3).any(|corner| facing.weights[corner] * twice < ALIKE * edge * opposite[corner].length())
    }
}

#[cfg(test)]
mod tests;
