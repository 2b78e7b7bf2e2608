//! Places on triangles.

use glam::DVec3;

/// A place on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnTriangle {
    /// Where it is.
    pub at: DVec3,
    /// What each corner has of it: at least 0, together 1.
    pub weights: [f64; 3],
    /// Which part of the triangle: 0 its inside, 1 to 3 the sides from each corner to the next, 4 to 6 the corners.
    pub part: usize,
}

impl OnTriangle {
    /// The place nearest to another one, by the seven regions about the triangle.
    #[inline(always)] // it is handed back in memory otherwise, which takes as long
    pub fn nearest(y: DVec3, [a, b, c]: [DVec3; 3]) -> Self {
        let corner = |corner: usize| {
            let mut weights = [0.0; 3];
            weights[corner] = 1.0;
            Self { at: [a, b, c][corner], weights, part: 4 + corner }
        };
        let (ab, ac, ay) = (b - a, c - a, y - a);
        let (d1, d2) = (ab.dot(ay), ac.dot(ay));
        if d1 <= 0.0 && d2 <= 0.0 {
            return corner(0);
        }
        let by = y - b;
        let (d3, d4) = (ab.dot(by), ac.dot(by));
        if d3 >= 0.0 && d4 <= d3 {
            return corner(1);
        }
        let cy = y - c;
        let (d5, d6) = (ab.dot(cy), ac.dot(cy));
        if d6 >= 0.0 && d5 <= d6 {
            return corner(2);
        }
        let off_ab = d1 * d4 - d3 * d2;
        if off_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            let t = d1 / (d1 - d3);
            return Self { at: a + ab * t, weights: [1.0 - t, t, 0.0], part: 1 };
        }
        let off_ca = d5 * d2 - d1 * d6;
        if off_ca <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            let t = d2 / (d2 - d6);
            return Self { at: a + ac * t, weights: [1.0 - t, 0.0, t], part: 3 };
        }
        let off_bc = d3 * d6 - d5 * d4;
        if off_bc <= 0.0 && d4 >= d3 && d5 >= d6 {
            let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            return Self { at: b + (c - b) * t, weights: [0.0, 1.0 - t, t], part: 2 };
        }
        let all = off_ab + off_bc + off_ca;
        let (v, w) = (off_ca / all, off_ab / all);
        Self { at: a + ab * v + ac * w, weights: [1.0 - v - w, v, w], part: 0 }
    }

    /// What each corner has of a place in the triangle's plane, also beyond its sides: there some have less than
    /// nothing, so that forces act along one line on what bears and what is borne. Together 1; of a triangle without
    /// area no numbers.
    pub fn weights_in_plane(at: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
        let across = (b - a).cross(c - a);
        let of = |from: DVec3, to: DVec3| (from - at).cross(to - at).dot(across) / across.length_squared();
        let (of_b, of_c) = (of(c, a), of(a, b));
        [1.0 - of_b - of_c, of_b, of_c]
    }

    /// Whether the nearest place to `y` stays on the same side or corner, as long as no two of the corners and `y` move
    /// against each other by more than a distance m. Products of vectors from a corner change by no more than the sum
    /// of what one of them alone does to them, with lengths that are as large as they may become. What is across a side
    /// of length e, P, changes by s = m/e at most, the sine of the angle that the side turns by, and so o · P w by
    /// m (|P o| + |P w| + s (|o| + |w|) + m) + s |o| |w|.
    pub fn keeps_part(&self, y: DVec3, corners: [DVec3; 3], moved: f64) -> bool {
        Self::stays_nearest(y, corners, self.part, moved)
    }

    /// The same of a part that the nearest place is on.
    pub fn stays_nearest(y: DVec3, corners: [DVec3; 3], part: usize, moved: f64) -> bool {
        if part == 0 {
            return false;
        }
        let [a, b, c] = [2, 0, 1].map(|next| corners[(part + next) % 3]);
        let (along, inwards, off) = (b - a, c - a, y - a);
        let [e, w, o] = [along, inwards, off].map(|vector| vector.length());
        let (ahead, in_it) = (along.dot(off), inwards.dot(off));
        if part > 3 {
            return ahead < -moved * (e + o + moved) && in_it < -moved * (w + o + moved);
        }
        let turned = moved / e;
        if turned.is_nan() || turned >= 1.0 {
            return false;
        }
        let across = |vector: DVec3| vector - along * (along.dot(vector) / (e * e));
        let (off_across, in_across) = (across(off), across(inwards));
        let lengths = off_across.length() + in_across.length() + turned * (o + w) + moved;
        ahead > moved * (e + o + moved)
            && along.dot(y - b) < -moved * (e + (y - b).length() + moved)
            && off_across.dot(in_across) < -(moved * lengths + turned * o * w)
    }
}

#[cfg(test)]
mod tests;
