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
