//! Registers of nodes' numbers spread over the nodes' components.

#[cfg(target_arch = "x86_64")]
use super::rows::coerced;
use pulp::Simd;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};

/// Each number three times, over three registers: a b c … become a a a b, b b c c, …
#[inline(always)]
pub(super) fn broadcast3_f32s<S: Simd>(simd: S, numbers: S::f32s) -> [S::f32s; 3] {
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(v4) = coerced::<S, V4>(simd) {
            let numbers = bytemuck::cast(numbers);
            let [a, b, c] = const { places::<16>() };
            // no closure: those do not get the instructions
            macro_rules! at {
                ($places:expr) => {
                    v4.avx512f._mm512_permutexvar_ps(bytemuck::cast($places), numbers)
                };
            }
            return bytemuck::cast([at!(a), at!(b), at!(c)]);
        }
        if let Some(v3) = coerced::<S, V3>(simd) {
            let numbers = bytemuck::cast(numbers);
            let [a, b, c] = const { places::<8>() };
            macro_rules! at {
                ($places:expr) => {
                    v3.avx2._mm256_permutevar8x32_ps(numbers, bytemuck::cast($places))
                };
            }
            return bytemuck::cast([at!(a), at!(b), at!(c)]);
        }
    }
    let mut spread = [simd.splat_f32s(0.0); 3];
    spread_out::<f32>(bytemuck::cast_slice(&[numbers]), bytemuck::cast_slice_mut(&mut spread));
    spread
}

/// As [`broadcast3_f32s`].
#[inline(always)]
pub(super) fn broadcast3_f64s<S: Simd>(simd: S, numbers: S::f64s) -> [S::f64s; 3] {
    let mut spread = [simd.splat_f64s(0.0); 3];
    spread_out::<f64>(bytemuck::cast_slice(&[numbers]), bytemuck::cast_slice_mut(&mut spread));
    spread
}

#[inline(always)]
fn spread_out<T: Copy>(numbers: &[T], spread: &mut [T]) {
    for (three, &number) in spread.chunks_exact_mut(3).zip(numbers) {
        three.fill(number);
    }
}

/// Which number comes to each place.
#[cfg(target_arch = "x86_64")]
const fn places<const LANES: usize>() -> [[i32; LANES]; 3] {
    let mut places = [[0; LANES]; 3];
    let mut at = 0;
    while at < 3 * LANES {
        places[at / LANES][at % LANES] = (at / 3) as i32;
        at += 1;
    }
    places
}

#[cfg(test)]
mod tests {
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
                assert!(
                    spread.iter().enumerate().all(|(at, &number)| number == (at / 3) as f64),
                    "{arch:?} {spread:?}"
                );
            }
        }
    }
}
