//! The number types that pointwise physics is written over.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number, or several computed side by side.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// A constant of the same kind as this number (a vector register's kind is known at run time only).
    fn constant(self, value: f64) -> Self;
    /// self · factor + summand, in one rounding where the machine can.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// The larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// x^(−1/3) for x > 0, to 2 ulp. A cube root written as a real power is slow and not the same on every device;
    /// this is integer arithmetic for a first guess (3.5 %) and Newton steps, each of which squares the error.
    fn inverse_cbrt(self) -> Self;
}

/// One number: `f32` or `f64`.
pub trait Scalar: Real + PartialOrd + Default + bytemuck::Pod {
    /// Rounds to this type.
    fn from_f64(value: f64) -> Self;
    /// Widens.
    fn to_f64(self) -> f64;
}

/// Newton steps for y = x^(−1/3): the error e of a guess becomes 2e².
#[inline(always)]
pub(super) fn refine_inverse_cbrt<R: Real>(x: R, guess: R, steps: usize) -> R {
    let third = x * x.constant(-1.0 / 3.0);
    let mut y = guess;
    for _ in 0..steps {
        y = y * (y * y * y).mul_add(third, x.constant(4.0 / 3.0));
    }
    y
}

/// First guesses are bits(x^(−1/3)) ≈ constant − bits(x)/3, good to 3.5 %.
pub(super) const GUESS_F32: u32 = 0x54a2_fa8c;
pub(super) const GUESS_F64: u64 = 0x553e_f0ff_289d_d796;
pub(super) const STEPS_F32: usize = 3;
pub(super) const STEPS_F64: usize = 4;

macro_rules! scalar {
    ($scalar:ty, $guess:expr, $steps:expr) => {
        impl Real for $scalar {
            #[inline(always)]
            fn constant(self, value: f64) -> Self {
                value as $scalar
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, summand: Self) -> Self {
                // not the fused one: in software that is a hundred times slower
                self * factor + summand
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn inverse_cbrt(self) -> Self {
                refine_inverse_cbrt(self, <$scalar>::from_bits($guess.wrapping_sub(self.to_bits() / 3)), $steps)
            }
        }

        impl Scalar for $scalar {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $scalar
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }
    };
}

scalar!(f32, GUESS_F32, STEPS_F32);
scalar!(f64, GUESS_F64, STEPS_F64);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_cube_root_is_right_to_a_few_ulp() {
        let (mut worst32, mut worst64) = (0.0_f64, 0.0_f64);
        for i in 1..400_000 {
            let x = i as f64 * 1e-4;
            let x32 = x as f32;
            worst32 = worst32.max((x32.inverse_cbrt() as f64 * (x32 as f64).cbrt() - 1.0).abs());
            worst64 = worst64.max((x.inverse_cbrt() * x.cbrt() - 1.0).abs());
        }
        assert!(worst32 < 2.0 * f32::EPSILON as f64, "f32: {worst32:e}");
        assert!(worst64 < 4.0 * f64::EPSILON, "f64: {worst64:e}");
    }
}
