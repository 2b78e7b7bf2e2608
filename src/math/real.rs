//! The number types that pointwise physics is written over.

use super::{elementary, trigonometry};
use glam::DVec3;
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
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;

    /// A constant of the same kind as this number (a vector register's kind is known at run time only).
    fn constant(self, value: f64) -> Self;
    /// self · factor + summand, in one rounding where the machine can.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// The larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// x^(−1/3) for x > 0, to 2 ulp. A cube root written as a real power is slow and not the same on every device;
    /// this is integer arithmetic for a first guess (3.5 %) and Newton steps, each of which squares the error.
    fn inverse_cbrt(self) -> Self;
    /// The smaller of two numbers.
    fn min(self, other: Self) -> Self;
    /// √x for x ≥ 0, rounded correctly.
    fn sqrt(self) -> Self;
    /// `then` where this number is above 0, `otherwise` elsewhere. Both are computed.
    fn if_positive(self, then: Self, otherwise: Self) -> Self;
    /// 2^k for a whole number k, −126 to 127 (f32) or −1022 to 1023 (f64): its bits.
    fn power_of_two(self) -> Self;
    /// (m, k) with x = m·2^k, m in [√½, √2), k whole, for a normal x > 0: its bits.
    fn mantissa_and_exponent(self) -> (Self, Self);

    /// Does a task out of line, with the instructions that this kind of number has: compiled once for the kind of
    /// number, not once more at each place.
    fn outlined<T: Task<Self>>(self, task: T) -> T::Output;

    /// |x|.
    #[inline(always)]
    fn abs(self) -> Self {
        self.max(-self)
    }
    /// The nearest whole number, for |x| below 0.25/[`EPSILON`](Real::EPSILON).
    #[inline(always)]
    fn round(self) -> Self {
        // so large a number has no digits left for a fraction
        let large = self.constant(1.5 / Self::EPSILON);
        (self + large) - large
    }
    /// e^x to 2 ulp. Beyond ±87 (f32) or ±708 (f64) it stays at the value there: nothing overflows, nothing is NaN.
    #[inline(always)]
    fn exp(self) -> Self {
        elementary::exp(self)
    }
    /// e^x − 1 to 3 ulp, also for small x; limits as for [`exp`](Real::exp).
    #[inline(always)]
    fn exp_m1(self) -> Self {
        elementary::exp_m1(self)
    }
    /// ln x to 2 ulp for normal x > 0; finite and wrong elsewhere.
    #[inline(always)]
    fn ln(self) -> Self {
        elementary::ln(self)
    }
    /// sin x to 1.5 ε, for |x| up to 1e4 (f32) or 1e6 (f64); infinite and no numbers give none.
    #[inline(always)]
    fn sin(self) -> Self {
        trigonometry::sin(self)
    }
    /// cos x; likewise.
    #[inline(always)]
    fn cos(self) -> Self {
        trigonometry::cos(self)
    }
    /// ln(1 + x) to 3 ulp, also for small x, for normal 1 + x > 0; finite and wrong elsewhere.
    #[inline(always)]
    fn ln_1p(self) -> Self {
        elementary::ln_1p(self)
    }
}

/// Something large to compute with a kind of number: see [`Real::outlined`].
pub trait Task<R> {
    /// What comes of it.
    type Output;
    /// Does it; must be inlined.
    fn run(self) -> Self::Output;
}

/// One number: `f32` or `f64`.
pub trait Scalar: Real + PartialOrd + Default + bytemuck::Pod {
    /// Rounds to this type.
    fn from_f64(value: f64) -> Self;
    /// Widens.
    fn to_f64(self) -> f64;
}

/// The vector that begins with a number of a column, in f64.
#[inline(always)] // with the instructions of whoever asks
pub(crate) fn vector_at<T: Scalar>(all: &[T], at: usize) -> DVec3 {
    DVec3::new(all[at].to_f64(), all[at + 1].to_f64(), all[at + 2].to_f64())
}

/// Newton steps for y = x^(−1/3): the error e of a guess becomes 2e².
#[inline(always)]
pub fn refine_inverse_cbrt<R: Real>(x: R, guess: R, steps: usize) -> R {
    let third = x * x.constant(-1.0 / 3.0);
    let mut y = guess;
    for _ in 0..steps {
        // two products at a time: what waits for the root waits for a chain of these
        y = y * (y * y).mul_add(y * third, x.constant(4.0 / 3.0));
    }
    y
}

/// First guesses are bits(x^(−1/3)) ≈ constant − bits(x)/3, good to 3.5 %.
pub(super) const GUESS_F32: u32 = 0x54a2_fa8c;
pub(super) const GUESS_F64: u64 = 0x553e_f0ff_289d_d796;
pub(super) const STEPS_F32: usize = 3;
pub(super) const STEPS_F64: usize = 4;

/// Bits of √½, and of 1, between which a mantissa's exponent turns over.
pub(super) const ROOT_HALF_F32: u32 = 0x3f35_04f3;
pub(super) const ROOT_HALF_F64: u64 = 0x3fe6_a09e_667f_3bcd;
pub(super) const ONE_F32: u32 = 1_f32.to_bits();
pub(super) const ONE_F64: u64 = 1_f64.to_bits();

macro_rules! scalar {
    ($scalar:ty, $bits:ty, $guess:expr, $steps:expr, $root_half:expr, $one:expr) => {
        impl Real for $scalar {
            const EPSILON: f64 = <$scalar>::EPSILON as f64;

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
            #[inline(never)]
            fn outlined<T: Task<Self>>(self, task: T) -> T::Output {
                task.run()
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn if_positive(self, then: Self, otherwise: Self) -> Self {
                if self > 0.0 { then } else { otherwise }
            }
            #[inline(always)]
            fn power_of_two(self) -> Self {
                // k + bias in the last bits of a large number, moved to where the exponent stands
                const PLACES: u32 = <$scalar>::MANTISSA_DIGITS - 1;
                let large = 1.5 / <$scalar>::EPSILON + (<$scalar>::MAX_EXP - 1) as $scalar;
                <$scalar>::from_bits((self + large).to_bits() << PLACES)
            }
            #[inline(always)]
            fn mantissa_and_exponent(self) -> (Self, Self) {
                const PLACES: u32 = <$scalar>::MANTISSA_DIGITS - 1;
                let shifted = self.to_bits().wrapping_add($one - $root_half);
                let exponent = (shifted >> PLACES) as $scalar - (<$scalar>::MAX_EXP - 1) as $scalar;
                let places: $bits = (1 << PLACES) - 1;
                (<$scalar>::from_bits((shifted & places) + $root_half), exponent)
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

scalar!(f32, u32, GUESS_F32, STEPS_F32, ROOT_HALF_F32, ONE_F32);
scalar!(f64, u64, GUESS_F64, STEPS_F64, ROOT_HALF_F64, ONE_F64);

#[cfg(test)]
mod tests;
