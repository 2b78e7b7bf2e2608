//! What vectors lie within: the least and the largest of their components, registers full at a time.

use super::Scalar;
use glam::DVec3;

/// Numbers that are compared side by side: whole registers, and whole vectors.
const SIDE_BY_SIDE: usize = 24;

/// What rounding to f32 takes of a difference at most, and more.
pub const ROUNDING: f64 = 1e-6;

/// The least and the largest of numbers along three axes, axis after axis.
#[derive(Clone, Copy)]
pub struct Extremes<T> {
    low: [T; SIDE_BY_SIDE],
    high: [T; SIDE_BY_SIDE],
}

impl<T: Scalar> Extremes<T> {
    /// Of no vector yet.
    pub fn none() -> Self {
        let far = T::from_f64(f64::from(f32::MAX));
        Self { low: [far; SIDE_BY_SIDE], high: [-far; SIDE_BY_SIDE] }
    }

    /// Sees as many numbers as there are, side by side at most. What is no number is not seen here; it is what guards
    /// look for.
    #[inline(always)]
    fn see(&mut self, numbers: &[T; SIDE_BY_SIDE], count: usize) {
        for i in 0..count {
            self.low[i] = if numbers[i] < self.low[i] { numbers[i] } else { self.low[i] };
            self.high[i] = if numbers[i] > self.high[i] { numbers[i] } else { self.high[i] };
        }
    }

    /// Sees fewer than are seen side by side.
    #[inline(always)]
    fn see_rest(&mut self, now: &[T], then: Option<&[T]>) {
        let (count, mut numbers) = (now.len(), [T::default(); SIDE_BY_SIDE]);
        numbers[..count].copy_from_slice(now);
        if let Some(then) = then {
            for i in 0..count {
                numbers[i] -= then[i];
            }
        }
        self.see(&numbers, count);
    }

    /// The least and the largest along each axis; nothing where nothing was seen.
    pub fn bounds(&self) -> [DVec3; 2] {
        let along = |axis: usize, of: &[T; SIDE_BY_SIDE], better: fn(f64, f64) -> f64| {
            of.iter().skip(axis).step_by(3).map(|number| number.to_f64()).reduce(better).unwrap_or(0.0)
        };
        let low = [0, 1, 2].map(|axis| along(axis, &self.low, f64::min));
        let high = [0, 1, 2].map(|axis| along(axis, &self.high, f64::max));
        if low[0] > high[0] { [DVec3::ZERO; 2] } else { [low.into(), high.into()] }
    }

    /// The largest distance between two vectors that were seen, and a little more.
    pub fn apart(&self) -> f64 {
        let [low, high] = self.bounds();
        (high - low).length() * (1.0 + ROUNDING)
    }

    /// The longest vector that was seen is not longer than this.
    pub fn longest(&self) -> f64 {
        let [low, high] = self.bounds();
        low.abs().max(high.abs()).length() * (1.0 + ROUNDING)
    }
}

/// The task of seeing vectors, three numbers each: as they are now, or how they differ from what they were then.
pub struct See<'a, T> {
    /// What has been seen.
    pub seen: &'a mut Extremes<T>,
    /// The vectors.
    pub now: &'a [T],
    /// As many.
    pub then: Option<&'a [T]>,
}

impl<T: Scalar> pulp::WithSimd for See<'_, T> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        // in registers
        let mut seen = *self.seen;
        let (whole, rest) = self.now.as_chunks::<SIDE_BY_SIDE>();
        match self.then.map(|then| then.as_chunks::<SIDE_BY_SIDE>()) {
            None => {
                for now in whole {
                    seen.see(now, SIDE_BY_SIDE);
                }
                seen.see_rest(rest, None);
            }
            Some((then, rest_then)) => {
                for (now, then) in whole.iter().zip(then) {
                    let mut moved = *now;
                    for i in 0..SIDE_BY_SIDE {
                        moved[i] -= then[i];
                    }
                    seen.see(&moved, SIDE_BY_SIDE);
                }
                seen.see_rest(rest, Some(rest_then));
            }
        }
        *self.seen = seen;
    }
}
