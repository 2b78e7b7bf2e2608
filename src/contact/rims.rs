//! Rims: where two flanks of a surface meet at an edge, which of them a point faces.

use super::candidates::{NEARER, ON_IT};
use super::facing::{ALIKE, Facing, TURNED_AWAY};
use super::surfaces::{Placed, Point, Surfaces};
use crate::mesh::OnTriangle;
use glam::DVec3;
use smallvec::{SmallVec, smallvec};

/// Flanks of a rim where the cosine between the normals is below this (60°).
pub(super) const RIM: f64 = 0.5;

/// A face lies flush with one of a point's own where the cosine between the normals is below this (8°), and that looks
/// at it where it is below the second (60°).
const FLUSH: f64 = -0.99;
const LOOKS: f64 = -0.5;

/// What ends before a rim lacks less to a plane there than to the rim where it is so much of what it would lack to
/// the plane if it went straight for the rim.
const LESS: f64 = 0.8;

impl Surfaces {
    /// What a point faces that sees a face near its rim: the flank there that it faces more, as a plane that ends at
    /// the rim, where other flanks begin to see it; nothing where the point is farther beyond that than it is outside.
    /// As it is seen where the point is well behind that flank, so that the face is a wall before it. `None` where
    /// nothing of it is in the point's way, or where another face is that sees it, too.
    ///
    /// Without this what slides over a flat surface catches at it: nodes of that are before the slider's front wall,
    /// too, as high above its rim as rounding has it, or what is sunk in. Where the point is at a rim of its own that
    /// looks at both, as at a joint that is slid across, it is the flank that lies flush with one of its own faces; of
    /// two that do neither is in its way, since less than a twentieth of an edge of one is before the other.
    ///
    /// Whether it is at a rim is all that is asked of most: only then is it asked for the point's own normal. `listed`
    /// are the triangles that may be near it, ascending, `reach` is how far off they are looked at, and `edge` the
    /// length of an edge (both m), the smaller of its body's and the face's.
    pub(super) fn flank(
        &self,
        now: Placed<'_>,
        (point, own): (&Point, impl FnOnce() -> DVec3),
        (listed, (reach, edge)): (&[u32], (f64, f64)),
        facing: Facing,
    ) -> Option<Facing> {
        let flanks = self.flanks(now, &facing, edge);
        if flanks.is_empty() {
            return Some(facing);
        }
        let (at, own) = (point.place(now.places), own());
        // of its own body it may be a face beside its own
        if self.bodies[facing.triangle as usize] == point.body && facing.normal.dot(own) >= TURNED_AWAY {
            return None;
        }
        // of its own triangles
        let normals: SmallVec<[DVec3; 8]> = match point.triangle {
            Some(_) => smallvec![own],
            None => self.around(point.nodes[0]).iter().map(|&of_point| self.normal_now(now, of_point)).collect(),
        };
        let least = |normal: DVec3| normals.iter().map(|of_point| of_point.dot(normal)).fold(1.0, f64::min);
        let outside_of = |triangle: u32| {
            let normal = self.normal_now(now, triangle);
            (normal, (at - self.corners(now.places, triangle)[0]).dot(normal))
        };
        let deep = |triangle: u32| -f64::min(ALIKE * edge, self.depths[triangle as usize]);
        let (normal, outside) = outside_of(facing.triangle);
        let (toward, toward_least) = (own.dot(normal), least(normal));
        // the one that it faces most, of equal ones the nearest, how much what it faces least, and those that see it
        let (mut most, mut best, mut nearest_to_it) = (None, f64::INFINITY, f64::NEG_INFINITY);
        let mut seen_by: SmallVec<[u32; 8]> = SmallVec::new();
        if outside > ON_IT * edge {
            seen_by.push(facing.triangle);
        }
        for (other, of_other) in flanks {
            let distance = at.distance(OnTriangle::nearest(at, self.corners(now.places, other)).at);
            // what is as near is in every list
            if distance > f64::max(self.depths[other as usize], reach) || listed.binary_search(&other).is_err() {
                continue;
            }
            let (turned, turned_least) = (own.dot(of_other), least(of_other));
            if outside_of(other).1 > ON_IT * edge {
                seen_by.push(other);
            }
            if turned_least <= FLUSH && toward_least <= LOOKS {
                let outside_of_other = outside_of(other).1;
                if outside_of_other > deep(other) && f64::min(outside, outside_of_other) < ALIKE * edge {
                    return None;
                }
            } else if toward_least > FLUSH || turned_least > LOOKS {
                nearest_to_it = f64::max(nearest_to_it, turned);
                if turned < toward - TURNED_AWAY && turned + distance / edge < best {
                    (most, best) = (Some(other), turned + distance / edge);
                }
            }
        }
        let triangle = match most {
            Some(other) => other,
            // it is the face itself, not the round about its rim
            None if toward < nearest_to_it - TURNED_AWAY => facing.triangle,
            None => return Some(facing),
        };
        let (normal, gap) = outside_of(triangle);
        if gap <= deep(triangle) {
            return Some(facing);
        }
        let (below, corners) = (at - gap * normal, self.corners(now.places, triangle));
        let beyond = below.distance(OnTriangle::nearest(below, corners).at);
        let is_other = triangle != facing.triangle;
        // the wall of a face that leans is behind itself: what no other flank sees is in the body
        if beyond >= ON_IT * edge && seen_by.iter().any(|&other| other != triangle) {
            // farther beyond it is kept off the rim, as by a thickness
            return (!is_other && gap > beyond).then_some(facing);
        }
        // what is behind the wall is before some face of the flank
        let weights = OnTriangle::weights_in_plane(below, corners);
        (!is_other || outside > -ON_IT * edge).then_some(Facing { triangle, weights, at: below, normal, gap, part: 0 })
    }

    /// What a point faces that is before a side or a corner, by where its `step` against that (m) ends, where it would
    /// come nearer to the plane across the way from there than it may, `within` (m). That plane is no wall: what glides
    /// past a rim would end behind it, and be braked and thrown aside where nothing is. What is at the side or corner
    /// is behind the planes of all triangles around it, so that a point that ends outside of any of them is as far off
    /// at least, and faces that one; so it does where it lacks clearly less to that, as what glides over a face that it
    /// has sunk into. What meets the rim itself lacks n · n′ as much to a plane of normal n′ as along its way n, and
    /// goes on facing that: where the way and planes are alike, rounding does not choose.
    ///
    /// Not asked are planes that the point is behind as it is, for it would be thrown out, those of triangles that it
    /// may not meet, and those before which some of what is around the place rises by more than a twentieth.
    pub fn flank_at_end(
        &self,
        places: &[DVec3],
        (point, step, within): (&Point, DVec3, f64),
        facing: Facing,
        may_meet: impl Fn(u32) -> bool,
    ) -> Facing {
        let at = point.place(places);
        let lacks = within - facing.normal.dot(at + step - facing.at);
        if lacks <= 0.0 {
            return facing;
        }
        let mut around: SmallVec<[u32; 8]> = self.around_part(facing.triangle, facing.part as usize).collect();
        around.push(facing.triangle);
        // of planes that are alike the first, whichever triangle has been found
        around.sort_unstable();
        let (mut found, mut least) = (facing, f64::INFINITY);
        for &triangle in &around {
            let (normal, corners) = (self.normal(places, triangle), self.corners(places, triangle));
            let gap = (at - corners[0]).dot(normal);
            let lacks_to_it = within - (gap + step.dot(normal));
            let is_less = lacks_to_it <= f64::max(0.0, LESS * facing.normal.dot(normal) * lacks);
            let is_behind = |corner: DVec3| {
                let off = corner - facing.at;
                off.dot(normal) <= ALIKE * off.length()
            };
            let all_behind = || around.iter().flat_map(|&other| self.corners(places, other)).all(is_behind);
            let is_least = is_less && lacks_to_it < least - (1.0 - NEARER) * lacks;
            if normal != DVec3::ZERO && gap >= 0.0 && is_least && may_meet(triangle) && all_behind() {
                let below = at - gap * normal;
                let weights = OnTriangle::weights_in_plane(below, corners);
                (found, least) = (Facing { triangle, weights, at: below, normal, gap, part: 0 }, lacks_to_it);
            }
        }
        found
    }

    /// Whether a triangle may be at a rim as long as no two nodes move against each other by more than a distance (m).
    pub(super) fn may_have_rim(&self, now: Placed<'_>, triangle: u32, moved: f64) -> bool {
        let of = |triangle: u32| (self.normal_now(now, triangle), self.turns(now, triangle, moved));
        let (normal, turn) = of(triangle);
        self.triangles[triangle as usize].iter().flat_map(|&node| self.around(node)).any(|&other| {
            let (of_other, turn_of_other) = of(other);
            let least = normal.dot(of_other) - (turn + turn_of_other + turn * turn_of_other);
            // a triangle without area has no number
            other != triangle && (least < RIM || least.is_nan())
        })
    }

    /// Whether a place on a triangle is at a rim.
    pub(super) fn is_at_rim(&self, now: Placed<'_>, facing: &Facing, edge: f64) -> bool {
        !self.flanks(now, facing, edge).is_empty()
    }

    /// Whether a place on a triangle is nearer to a side than so far (m), or beyond it.
    #[inline(always)] // with the instructions of whoever asks
    pub(super) fn is_near_side(&self, now: Placed<'_>, facing: &Facing, near: f64) -> bool {
        let &Facing { triangle, weights, .. } = facing;
        let [a, b, c] = self.corners(now.places, triangle);
        let (twice, opposite) = ((b - a).cross(c - a).length_squared(), [c - b, a - c, b - a]);
        let is_near =
            |corner: usize| weights[corner].max(0.0).powi(2) * twice < near * near * opposite[corner].length_squared();
        (0..3).any(is_near)
    }

    /// The triangles, with their normals, that fall off from one at a rim near a place on it.
    #[inline(always)] // with the instructions of whoever asks
    fn flanks(&self, now: Placed<'_>, facing: &Facing, edge: f64) -> SmallVec<[(u32, DVec3); 8]> {
        let &Facing { triangle, at, .. } = facing;
        let (near, mut found) = (ALIKE * edge, SmallVec::new());
        if !self.is_near_side(now, facing, near) {
            return found;
        }
        let [a, b, c] = self.corners(now.places, triangle);
        let (normal, middle) = (self.normal_now(now, triangle), (a + b + c) / 3.0);
        for &node in &self.triangles[triangle as usize] {
            for &other in self.around(node) {
                let of_other = self.normal_now(now, other);
                // itself does not turn off; two nodes have some
                let turns_off = of_other.dot(normal) < RIM && of_other != DVec3::ZERO;
                if !turns_off || found.iter().any(|of| of.0 == other) {
                    continue;
                }
                let corners = self.corners(now.places, other);
                let falls_off = of_other.dot(middle - corners[0]) < 0.0;
                if falls_off && OnTriangle::nearest(at, corners).at.distance(at) < near {
                    found.push((other, of_other));
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests;
