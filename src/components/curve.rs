//! Courses in time: values, and means over a window.

use crate::scene::schema::Curve;

/// 10s³ − 15s⁴ + 6s⁵, from 0 to 1 without a jump of the first two derivatives.
pub(super) fn smooth(s: f64) -> f64 {
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// √(3/5): where Gauss and Legendre's rule of three points has its outer ones; exact for polynomials of the fifth
/// degree.
const OUTER: f64 = 0.774_596_669_241_483_4;

impl Curve {
    /// The factor at a time (s).
    pub fn value(&self, time: f64) -> f64 {
        let share = |start: f64, end: f64| ((time - start) / (end - start)).clamp(0.0, 1.0);
        match self {
            Curve::Step { start, end } => {
                if time >= *start && end.is_none_or(|end| time < end) {
                    1.0
                } else {
                    0.0
                }
            }
            Curve::Ramp { start, end } => share(*start, *end),
            Curve::Smooth { start, end } => smooth(share(*start, *end)),
            Curve::Table(points) => {
                let after = points.partition_point(|&(t, _)| t <= time);
                match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
                    (Some((t0, v0)), Some(&(t1, v1))) => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
                    (Some((_, v)), None) | (None, Some(&(_, v))) => v,
                    (None, None) => 0.0,
                }
            }
            // until somebody sets another
            Curve::Input { initial, .. } => *initial,
        }
    }

    /// The mean of the factor over a window of time (s), to rounding: each piece between two corners is a polynomial of
    /// the fifth degree at most. So a pulse between two steps is not lost, and its impulse does not depend on where
    /// steps lie.
    pub fn mean(&self, (from, to): (f64, f64)) -> f64 {
        let (mut at, mut sum) = (from, 0.0);
        while let Some(corner) = self.corner_after(at).filter(|corner| *corner < to) {
            sum += (corner - at) * self.mean_of_piece(at, corner);
            at = corner;
        }
        // what has no corner is not rounded twice
        if at == from {
            self.mean_of_piece(from, to)
        } else {
            (sum + (to - at) * self.mean_of_piece(at, to)) / (to - from)
        }
    }

    /// The least time between two corners (s), if there are two: what is finer than steps is seen as a mean by loads,
    /// and at the ends of steps by motions.
    pub fn finest(&self) -> Option<f64> {
        let mut corners = std::iter::successors(self.corner_after(f64::NEG_INFINITY), |&at| self.corner_after(at));
        let mut before = corners.next()?;
        corners.map(|at| at - std::mem::replace(&mut before, at)).reduce(f64::min)
    }

    /// How fast the factor changes at most (1/s); jumps count as 0, and inputs by their rate.
    pub fn fastest(&self) -> f64 {
        match self {
            Curve::Step { .. } => 0.0,
            Curve::Ramp { start, end } => 1.0 / (end - start),
            // in the middle
            Curve::Smooth { start, end } => 1.875 / (end - start),
            Curve::Table(points) => {
                let slope = |pair: &[(f64, f64)]| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs();
                points.windows(2).map(slope).fold(0.0, f64::max)
            }
            Curve::Input { rate, .. } => rate.unwrap_or(0.0),
        }
    }

    /// Between which factors it stays; an input between 0 and 1, and what it begins with.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Curve::Step { .. } | Curve::Ramp { .. } | Curve::Smooth { .. } => [0.0, 1.0],
            Curve::Table(points) => {
                let factors = || points.iter().map(|point| point.1);
                match points.is_empty() {
                    true => [0.0, 0.0],
                    false => [factors().fold(f64::INFINITY, f64::min), factors().fold(f64::NEG_INFINITY, f64::max)],
                }
            }
            Curve::Input { initial, .. } => [initial.min(0.0), initial.max(1.0)],
        }
    }

    /// The largest factor from 0 until a time (s), not that of a jump there; of an input the largest of its
    /// [range](Self::range).
    pub fn largest(&self, until: f64) -> f64 {
        let corner_after = |at: f64| self.corner_after(at).filter(|corner| *corner < until);
        let corners = std::iter::successors(Some(0.0), |&at| corner_after(at));
        // between two corners it goes up, down or straight on
        let largest = corners.map(|at| self.value(at)).fold(f64::NEG_INFINITY, f64::max);
        match self {
            Curve::Step { .. } => largest,
            Curve::Input { .. } => self.range()[1],
            _ => largest.max(self.value(until)),
        }
    }

    /// The first time after one (s) at which the curve begins to move, or to move more than twice as fast as ever
    /// before.
    pub fn quickens_after(&self, time: f64) -> Option<f64> {
        match self {
            Curve::Table(points) => {
                let mut fastest = 0.0_f64;
                let quicker = points.windows(2).filter_map(|pair| {
                    let rate = ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs();
                    let quicker = rate > 2.0 * fastest;
                    fastest = fastest.max(rate);
                    quicker.then_some(pair[0].0)
                });
                quicker.into_iter().find(|corner| *corner > time)
            }
            Curve::Step { start, end } => [Some(*start), *end].into_iter().flatten().find(|corner| *corner > time),
            Curve::Ramp { start, .. } | Curve::Smooth { start, .. } => Some(*start).filter(|start| *start > time),
            // who sets it says so
            Curve::Input { .. } => None,
        }
    }

    /// The first time after one at which two pieces of the curve meet (s).
    pub(crate) fn corner_after(&self, time: f64) -> Option<f64> {
        let first = |corners: [Option<f64>; 2]| corners.into_iter().flatten().find(|corner| *corner > time);
        match self {
            Curve::Step { start, end } => first([Some(*start), *end]),
            Curve::Ramp { start, end } | Curve::Smooth { start, end } => first([Some(*start), Some(*end)]),
            Curve::Table(points) => points.get(points.partition_point(|&(t, _)| t <= time)).map(|point| point.0),
            Curve::Input { .. } => None,
        }
    }

    fn mean_of_piece(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        match self {
            Curve::Smooth { .. } => {
                let outer = self.value(middle - OUTER * half) + self.value(middle + OUTER * half);
                (5.0 * outer + 8.0 * self.value(middle)) / 18.0
            }
            _ => self.value(middle),
        }
    }
}

#[cfg(test)]
mod tests;
