use crate::math::{LANES, SimdScalar};
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;

struct Spread<T>(PhantomData<T>);

impl<T: SimdScalar> WithSimd for Spread<T> {
    type Output = Vec<f64>;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
        let numbers: Vec<T> = (0..LANES).map(|i| T::from_f64(i as f64)).collect();
        let mut lanes = [T::default(); 3 * LANES];
        for (k, register) in T::broadcast3(T::load(simd, &numbers)).into_iter().enumerate() {
            T::store(register, &mut lanes[k * T::width::<S>()..]);
        }
        lanes[..3 * T::width::<S>()].iter().map(|number| number.to_f64()).collect()
    }
}

#[test]
fn each_number_comes_three_times() {
    let mut sets = vec![pulp::Arch::Scalar, pulp::Arch::new()];
    #[cfg(target_arch = "x86_64")]
    sets.extend(pulp::x86::V3::try_new().map(pulp::Arch::V3));
    for arch in sets {
        for spread in [arch.dispatch(Spread::<f32>(PhantomData)), arch.dispatch(Spread::<f64>(PhantomData))] {
            assert!(spread.iter().enumerate().all(|(at, &number)| number == (at / 3) as f64), "{arch:?} {spread:?}");
        }
    }
}
