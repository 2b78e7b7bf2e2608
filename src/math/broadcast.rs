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
mod tests;
