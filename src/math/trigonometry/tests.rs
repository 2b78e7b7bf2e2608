use super::super::{LANES, SimdScalar};
use super::*;
use pulp::{Simd, WithSimd};

struct InRegisters<'a, T>(&'a [T]);

impl<T: SimdScalar> WithSimd for InRegisters<'_, T> {
    type Output = Vec<[T; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<[T; 2]> {
        let mut all = Vec::new();
        for numbers in self.0.chunks(T::width::<S>()) {
            let x = T::load_part(simd, numbers);
            let both = [x.sin(), x.cos()].map(|found| {
                let mut lanes = [T::default(); LANES];
                T::store(found, &mut lanes);
                lanes
            });
            all.extend((0..numbers.len()).map(|lane| [both[0][lane], both[1][lane]]));
        }
        all
    }
}

/// Worst errors of both, in ε.
fn worst<T: SimdScalar>(largest: f64) -> f64 {
    let numbers: Vec<T> = (-20_000..=20_000).map(|i| T::from_f64(f64::from(i) / 20_000.0 * largest)).collect();
    let lanes = pulp::Arch::new().dispatch(InRegisters(&numbers));
    let mut worst = 0.0_f64;
    for (x, lanes) in numbers.iter().zip(lanes) {
        let exact = [x.to_f64().sin(), x.to_f64().cos()];
        for (found, exact) in [x.sin(), x.cos()].into_iter().chain(lanes).zip(exact.into_iter().cycle()) {
            worst = worst.max((found.to_f64() - exact).abs() / T::EPSILON);
        }
    }
    worst
}

#[test]
fn sine_and_cosine_are_right_to_a_few_units_of_rounding() {
    let found = [worst::<f32>(2.0), worst::<f32>(1e4), worst::<f64>(2.0), worst::<f64>(1e6)];
    println!("{found:.2?} ε");
    assert!(found.iter().all(|error| *error < 1.5), "{found:?}");
    assert_eq!((Real::sin(0.0_f64), Real::cos(0.0_f64), Real::sin(0.0_f32)), (0.0, 1.0, 0.0));
    assert!(Real::sin(f64::INFINITY).is_nan() && Real::cos(f32::NAN).is_nan());
}
