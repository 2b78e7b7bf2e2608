//! What stays so of a triangle and a point as long as nodes hardly move.

use super::TURNED_AWAY;
use crate::contact::surfaces::{OF_ANGLES, Placed, Point, Surfaces};
use glam::DVec3;
use smallvec::SmallVec;
use std::f64::consts::FRAC_PI_2;

impl Surfaces {
    /// Whether a triangle stays turned away from a point, a node, and whether it may have a rim, as long as no two
    /// nodes move against each other by more than a distance (m).
    #[inline(never)] // all points would make room for what few need
    pub(super) fn ask(&self, (now, point): (Placed<'_>, &Point), triangle: u32, moved: f64) -> [bool; 2] {
        let is_turned_away = point.triangle.is_none() && self.stays_turned_away(now, point.nodes[0], triangle, moved);
        [is_turned_away, self.may_have_rim(now, triangle, moved)]
    }

    /// By how much the unit normal of a triangle with sides a, b and area A changes at most, as long as no two nodes
    /// move against each other by more than a distance m: 2 m (a + b + m)/2A.
    pub(in crate::contact) fn turns(&self, now: Placed<'_>, triangle: u32, moved: f64) -> f64 {
        let [a, b, c] = self.corners(now.places, triangle);
        let (one, other) = (b - a, c - a);
        2.0 * moved * (one.length() + other.length() + moved) / one.cross(other).length()
    }

    /// Whether a triangle stays turned away from all triangles around a node, or from its own normal, likewise.
    fn stays_turned_away(&self, now: Placed<'_>, node: u32, triangle: u32, moved: f64) -> bool {
        let of = |triangle: u32| (self.normal_now(now, triangle), self.turns(now, triangle, moved));
        let (normal, turn) = of(triangle);
        let cosine = |(own, of_own): &(DVec3, f64)| own.dot(normal) + of_own + turn + of_own * turn;
        let around: SmallVec<[(DVec3, f64); 8]> = self.around(node).iter().map(|&own| of(own)).collect();
        around.iter().all(|of_own| cosine(of_own) < 0.0)
            || cosine(&self.turns_of_node(now, node, &around, moved)) < TURNED_AWAY
    }

    /// The unit normal of a node, and by how much it changes at most, likewise: of triangles around it with these
    /// normals n and by how much they turn. The sum N of a n, a the angles, changes by E = Σ δa + (a + δa) δn at most,
    /// where a turns by no more than its sides of lengths b and c do, δa = π/2 m (1/b + 1/c), and what is as long as
    /// one turns by 2 E/|N|; with what angles are known to.
    fn turns_of_node(&self, now: Placed<'_>, node: u32, around: &[(DVec3, f64)], moved: f64) -> (DVec3, f64) {
        let (mut sum, mut change) = (DVec3::ZERO, 0.0);
        for (&triangle, &(normal, turn)) in self.around(node).iter().zip(around) {
            let (angle, [b, c]) = self.angle_at(now.places, triangle, node);
            // what is shorter may turn anywhere
            let of_angle = if moved < f64::min(b, c) { FRAC_PI_2 * moved * (1.0 / b + 1.0 / c) } else { f64::INFINITY };
            sum += normal * angle;
            change += of_angle + (angle + of_angle) * turn;
        }
        (sum.normalize_or_zero(), 2.0 * change / sum.length() + OF_ANGLES)
    }
}
