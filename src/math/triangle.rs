//! Places on triangles.

use super::Real;
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

    /// Whether the nearest place to `y` stays on the same side or corner, as long as no two of the corners and `y` move
    /// against each other by more than a distance m. Products of vectors from a corner change by no more than the sum
    /// of what one of them alone does to them, with lengths that are as large as they may become. What is across a side
    /// of length e, P, changes by s = m/e at most, the sine of the angle that the side turns by, and so o · P w by m (|P
    /// o| + |P w| + s (|o| + |w|) + m) + s |o| |w|.
    pub fn keeps_part(&self, y: DVec3, corners: [DVec3; 3], moved: f64) -> bool {
        if self.part == 0 {
            return false;
        }
        let [a, b, c] = [2, 0, 1].map(|next| corners[(self.part + next) % 3]);
        let (along, inwards, off) = (b - a, c - a, y - a);
        let [e, w, o] = [along, inwards, off].map(|vector| vector.length());
        let (ahead, in_it) = (along.dot(off), inwards.dot(off));
        if self.part > 3 {
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

/// Where triangles are nearest to places, several side by side.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<R> {
    /// As [`OnTriangle::at`].
    pub at: [R; 3],
    /// As [`OnTriangle::weights`].
    pub weights: [R; 3],
    /// As [`OnTriangle::part`].
    pub part: R,
    /// How far that is (m).
    pub distance: R,
    /// The unit normal of the triangle, of one without area no number.
    pub normal: [R; 3],
    /// How far that is along the normal (m).
    pub gap: R,
}

impl<R: Real> Nearest<R> {
    /// The same as [`OnTriangle::nearest`] of each, in the same arithmetic, bit by bit but for signs of zeros: all
    /// regions are computed, and the first is taken that it is in.
    #[inline(always)]
    pub fn of(y: [R; 3], [a, b, c]: [[R; 3]; 3]) -> Self {
        let [zero, one] = [y[0].constant(0.0), y[0].constant(1.0)];
        let (ab, ac) = (minus(b, a), minus(c, a));
        let (ay, by, cy) = (minus(y, a), minus(y, b), minus(y, c));
        let (d1, d2, d3, d4, d5, d6) = (dot(ab, ay), dot(ac, ay), dot(ab, by), dot(ac, by), dot(ab, cy), dot(ac, cy));
        let (off_ab, off_ca, off_bc) = (d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4);
        let all = off_ab + off_bc + off_ca;
        // what b and c have of it, from the last region to the first
        let (mut v, mut w, mut part) = (off_ca / all, off_ab / all, zero);
        let along_bc = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        let on_bc = at_most_zero(off_bc, at_least_zero(d4 - d3, at_least_zero(d5 - d6, one)));
        take(on_bc, [one - along_bc, along_bc], 2.0, (&mut v, &mut w, &mut part));
        let on_ca = at_most_zero(off_ca, at_least_zero(d2, at_most_zero(d6, one)));
        take(on_ca, [zero, d2 / (d2 - d6)], 3.0, (&mut v, &mut w, &mut part));
        let on_ab = at_most_zero(off_ab, at_least_zero(d1, at_most_zero(d3, one)));
        take(on_ab, [d1 / (d1 - d3), zero], 1.0, (&mut v, &mut w, &mut part));
        take(at_least_zero(d6, at_least_zero(d6 - d5, one)), [zero, one], 6.0, (&mut v, &mut w, &mut part));
        take(at_least_zero(d3, at_least_zero(d3 - d4, one)), [one, zero], 5.0, (&mut v, &mut w, &mut part));
        take(at_most_zero(d1, at_most_zero(d2, one)), [zero, zero], 4.0, (&mut v, &mut w, &mut part));
        // beside a, what a has is found from the others
        let (mut u, mut at) = (one - v - w, plus(plus(a, times(ab, v)), times(ac, w)));
        let is_on_bc = at_most_zero((part - one - one).abs(), one);
        u = is_on_bc.if_positive(zero, u);
        let bc = plus(b, times(minus(c, b), w));
        for axis in 0..3 {
            at[axis] = is_on_bc.if_positive(bc[axis], at[axis]);
            at[axis] = (part - part.constant(4.5)).if_positive(b[axis], at[axis]);
            at[axis] = (part - part.constant(5.5)).if_positive(c[axis], at[axis]);
        }
        let across = [ab[1] * ac[2] - ac[1] * ab[2], ab[2] * ac[0] - ac[2] * ab[0], ab[0] * ac[1] - ac[0] * ab[1]];
        let normal = times(across, one / dot(across, across).sqrt());
        let off = minus(y, at);
        Self { at, weights: [u, v, w], part, distance: dot(off, off).sqrt(), normal, gap: dot(off, normal) }
    }
}

/// Takes what b and c have of the nearest place in a region, where `is` is above 0.
#[inline(always)]
fn take<R: Real>(is: R, [of_b, of_c]: [R; 2], number: f64, (v, w, part): (&mut R, &mut R, &mut R)) {
    *v = is.if_positive(of_b, *v);
    *w = is.if_positive(of_c, *w);
    *part = is.if_positive(is.constant(number), *part);
}

/// `then` where a number is 0 or less, else 0.
#[inline(always)]
fn at_most_zero<R: Real>(number: R, then: R) -> R {
    number.if_positive(number.constant(0.0), then)
}

/// `then` where a number is 0 or more, else 0.
#[inline(always)]
fn at_least_zero<R: Real>(number: R, then: R) -> R {
    at_most_zero(-number, then)
}

#[inline(always)]
fn plus<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn minus<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn times<R: Real>(a: [R; 3], b: R) -> [R; 3] {
    [a[0] * b, a[1] * b, a[2] * b]
}

/// a · b, each product and sum rounded.
#[inline(always)]
fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
