//! Exponential and logarithm over any [`Real`], without a branch: arithmetic and a few moved bits, so that a register
//! of numbers costs what one does, and the GPU's twin (`shaders/elementary.wgsl`) makes the same digits.

use super::Real;

/// Taylor terms 1/(n+2)! of (e^r − 1 − r)/r²: for |r| ≤ ½ ln 2 six leave an error of 2e-8 of r (f32), twelve of 1e-17.
const EXPONENTIAL: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5040.0,
    1.0 / 40320.0,
    1.0 / 362880.0,
    1.0 / 3628800.0,
    1.0 / 39916800.0,
    1.0 / 479001600.0,
    1.0 / 6227020800.0,
];

const fn is_single<R: Real>() -> bool {
    R::EPSILON > 1e-10
}

/// ln 2 as a sum: the first has so many zeros at its end that its product with an exponent is exact.
#[inline(always)]
fn ln_2<R: Real>(like: R) -> (R, R) {
    let (high, low) = if is_single::<R>() {
        (6.931_381_225_6e-1, 9.058_000_614_5e-6)
    } else {
        (6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10)
    };
    (like.constant(high), like.constant(low))
}

/// 2^k and e^r − 1 with x = k ln 2 + r, |r| ≤ ½ ln 2.
#[inline(always)]
fn reduced<R: Real>(x: R) -> (R, R) {
    let (lowest, highest, terms) = if is_single::<R>() { (-87.0, 88.0, 6) } else { (-708.0, 709.0, 12) };
    let x = x.max(x.constant(lowest)).min(x.constant(highest));
    let k = (x * x.constant(std::f64::consts::LOG2_E)).round();
    let (high, low) = ln_2(x);
    let r = (x - k * high) - k * low;
    let mut q = x.constant(EXPONENTIAL[terms - 1]);
    for n in (0..terms - 1).rev() {
        q = q.mul_add(r, x.constant(EXPONENTIAL[n]));
    }
    (k.power_of_two(), (r * r).mul_add(q, r))
}

#[inline(always)]
pub(super) fn exp<R: Real>(x: R) -> R {
    let (scale, p) = reduced(x);
    scale.mul_add(p, scale)
}

#[inline(always)]
pub(super) fn exp_m1<R: Real>(x: R) -> R {
    let (scale, p) = reduced(x);
    scale.mul_add(p, scale - x.constant(1.0))
}

/// k ln 2 + ln(1 + f), 1 + f in [√½, √2): ln(1 + f) = 2 artanh s, s = f/(2 + f), |s| ≤ .172, by its series in s².
/// Five terms leave an error of 2e-9 of it (f32), eleven of 1e-18.
#[inline(always)]
fn logarithm<R: Real>(k: R, f: R) -> R {
    let terms = if is_single::<R>() { 5 } else { 11 };
    let s = f / (f.constant(2.0) + f);
    let square = s * s;
    let mut q = f.constant(2.0 / (2 * terms - 1) as f64);
    for n in (1..terms - 1).rev() {
        q = q.mul_add(square, f.constant(2.0 / (2 * n + 1) as f64));
    }
    // 2s = f − s f: the leading term without the rounding of s
    let (high, low) = ln_2(f);
    let tail = s * square.mul_add(q, -f);
    k.mul_add(high, f + k.mul_add(low, tail))
}

#[inline(always)]
pub(super) fn ln<R: Real>(x: R) -> R {
    let (mantissa, k) = x.mantissa_and_exponent();
    logarithm(k, mantissa - x.constant(1.0))
}

/// With k = 0, f is x itself: what 1 + x rounds away is never missed, and no compiler can spoil a compensation.
#[inline(always)]
pub(super) fn ln_1p<R: Real>(x: R) -> R {
    let one = x.constant(1.0);
    let (mantissa, k) = (one + x).mantissa_and_exponent();
    let f = (x.constant(0.5) - k.abs()).if_positive(x, mantissa - one);
    logarithm(k, f)
}

#[cfg(test)]
mod tests {
    use super::super::{LANES, Scalar, SimdScalar};
    use super::*;
    use pulp::{Simd, WithSimd};

    /// Every function of a register full of numbers.
    fn all<R: Real>(x: R) -> [R; 10] {
        let y = x.abs();
        let (mantissa, exponent) = y.mantissa_and_exponent();
        let clamped = x.max(x.constant(-100.0)).min(x.constant(100.0));
        [
            x.exp(),
            x.exp_m1(),
            y.ln(),
            y.ln_1p(),
            y.sqrt(),
            y,
            clamped.round().power_of_two(),
            mantissa,
            exponent,
            x.if_positive(y, clamped),
        ]
    }

    struct InRegisters<'a, T>(&'a [T]);

    impl<T: SimdScalar> WithSimd for InRegisters<'_, T> {
        type Output = Vec<[T; 10]>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Vec<[T; 10]> {
            let mut found = vec![[T::default(); 10]; self.0.len()];
            for at in (0..self.0.len() / T::width::<S>()).map(|i| i * T::width::<S>()) {
                let values = all(T::load(simd, &self.0[at..]));
                for (number, value) in values.into_iter().enumerate() {
                    let mut lanes = [T::default(); LANES];
                    T::store(value, &mut lanes);
                    for lane in 0..T::width::<S>() {
                        found[at + lane][number] = lanes[lane];
                    }
                }
            }
            found
        }
    }

    /// Numbers of both signs from 1e-12 to the ends of the range, equally dense in their logarithm.
    fn numbers<T: Scalar>(largest: f64) -> Vec<T> {
        let count = 160_000;
        let size = |i: usize| (1e-12_f64.ln() + (largest / 1e-12).ln() * i as f64 / count as f64).exp();
        (0..count).map(|i| T::from_f64(size(i) * if i % 2 == 0 { 1.0 } else { -1.0 })).collect()
    }

    /// Worst errors of exp, exp_m1, ln, ln_1p in units of ε times the value; `exact` gives values good to far below ε.
    fn worst<T: SimdScalar>(largest: f64, exact: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
        let numbers = numbers::<T>(largest);
        let mut worst = [0.0_f64; 4];
        for (x, lanes) in numbers.iter().zip(pulp::Arch::new().dispatch(InRegisters(&numbers))) {
            for found in [all(*x), lanes] {
                for (i, exact) in exact(x.to_f64()).into_iter().enumerate() {
                    let error = (found[i].to_f64() - exact).abs() / (T::EPSILON * exact.abs().max(f64::MIN_POSITIVE));
                    worst[i] = worst[i].max(error);
                }
            }
            // selection and bits are the same in registers
            let alone = all(*x);
            for i in 4..10 {
                assert_eq!(alone[i].to_f64(), lanes[i].to_f64(), "function {i} of {x:?}");
            }
        }
        worst
    }

    /// An ulp is ε/2 to ε of the value: 2 ulp in these units are 1 to 2.
    #[test]
    fn exponential_and_logarithm_are_right_to_a_few_ulp() {
        let exact = |x: f64| [x.exp(), x.exp_m1(), x.abs().ln(), x.abs().ln_1p()];
        let single = worst::<f32>(86.0, exact);
        // std's own functions are good to one ulp
        let double = worst::<f64>(707.0, exact);
        println!("f32: {single:.2?} ε, f64: {double:.2?} ε");
        for (worst, allowed) in single.into_iter().zip([1.5, 2.0, 1.5, 2.0]) {
            assert!(worst < allowed, "f32: {single:?}");
        }
        for (worst, allowed) in double.into_iter().zip([2.0, 2.5, 2.0, 2.5]) {
            assert!(worst < allowed, "f64: {double:?}");
        }
    }

    #[test]
    fn numbers_beyond_every_range_stay_finite() {
        for x in [f32::MIN, -1e3, -88.5, -1.0, -0.0, 0.0, 89.0, 1e3, f32::MAX] {
            for found in [Real::exp(x), Real::exp_m1(x), Real::ln(x), Real::ln_1p(x)] {
                assert!(found.is_finite(), "{x}: {found}");
            }
        }
        assert_eq!((1e3_f64.exp_m1().is_finite(), Real::exp_m1(1e3_f64).is_finite()), (false, true));
        assert_eq!((Real::exp_m1(0.0_f32), Real::ln_1p(0.0_f32), Real::exp(0.0_f32)), (0.0, 0.0, 1.0));
    }

    #[test]
    fn a_number_is_its_mantissa_times_two_to_its_exponent() {
        for i in 1..20_000 {
            let x = f64::from(i) * 7.3e-3;
            let (mantissa, exponent) = x.mantissa_and_exponent();
            assert_eq!(mantissa * exponent.power_of_two(), x);
            assert!((0.5_f64.sqrt()..2.0_f64.sqrt()).contains(&mantissa), "{mantissa}");
            let (mantissa, exponent) = (x as f32).mantissa_and_exponent();
            assert_eq!(mantissa * exponent.power_of_two(), x as f32);
        }
    }

    #[test]
    fn whole_numbers_are_the_nearest() {
        for i in -4000..4000 {
            let x = f64::from(i) * 0.1237;
            assert_eq!((Real::round(x), f64::from(Real::round(x as f32))), (x.round_ties_even(), x.round_ties_even()));
        }
    }
}
