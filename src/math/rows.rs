//! Rows of four patch-local numbers, in a core's cache, and registers filled from them and added to them: one row a
//! lane.

use super::SimdScalar;
use bytemuck::allocation::zeroed_box;
use pulp::Simd;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};

/// As many rows as a `u16` can name, so that no index is ever out of bounds. Only those in use are ever touched.
pub const MOST_LOCAL_ROWS: usize = 1 << 16;

/// Rows of four numbers: a vector and one more.
pub type Rows<T> = [[T; 4]; MOST_LOCAL_ROWS];

/// What a thread computes a patch with.
pub struct Scratch<T: SimdScalar> {
    /// Read: displacements.
    pub read: Box<Rows<T>>,
    /// Added to: forces. The fourth number of a row has no meaning.
    pub sums: Box<Rows<T>>,
}

impl<T: SimdScalar> Default for Scratch<T> {
    fn default() -> Self {
        Self { read: zeroed_box(), sums: zeroed_box() }
    }
}

/// Columns of the rows `at`, a row a lane: instructions of each machine where there are better ones than one number at
/// a time.
#[inline(always)]
pub(super) fn load_f32s<S: Simd>(simd: S, rows: &Rows<f32>, at: &[u16]) -> [S::f32s; 4] {
    #[cfg(target_arch = "x86_64")]
    {
        if let (Some(v4), Some(at)) = (coerced::<S, V4>(simd), at.first_chunk()) {
            return bytemuck::cast(x86::columns_512(v4, rows, at));
        }
        if let (Some(v3), Some(at)) = (coerced::<S, V3>(simd), at.first_chunk()) {
            return bytemuck::cast(x86::columns_256(v3, rows, at));
        }
    }
    let mut columns = [simd.splat_f32s(0.0); 4];
    for (column, values) in columns.iter_mut().enumerate() {
        let lanes: &mut [f32] = bytemuck::cast_slice_mut(std::slice::from_mut(values));
        for (lane, &row) in lanes.iter_mut().zip(at) {
            *lane = rows[row as usize][column];
        }
    }
    columns
}

/// Adds vectors to the rows `at`, one lane after the other.
#[inline(always)]
pub(super) fn add_f32s<S: Simd>(simd: S, rows: &mut Rows<f32>, at: &[u16], vectors: [S::f32s; 3]) {
    #[cfg(target_arch = "x86_64")]
    {
        if let (Some(v4), Some(at)) = (coerced::<S, V4>(simd), at.first_chunk()) {
            return x86::add_512(v4, rows, at, bytemuck::cast(vectors));
        }
        if let (Some(v3), Some(at)) = (coerced::<S, V3>(simd), at.first_chunk()) {
            return x86::add_256(v3, rows, at, bytemuck::cast(vectors));
        }
    }
    let _ = simd;
    for (column, values) in vectors.iter().enumerate() {
        let lanes: &[f32] = bytemuck::cast_slice(std::slice::from_ref(values));
        for (lane, &row) in lanes.iter().zip(at) {
            rows[row as usize][column] += lane;
        }
    }
}

/// As [`load_f32s`].
#[inline(always)]
pub(super) fn load_f64s<S: Simd>(simd: S, rows: &Rows<f64>, at: &[u16]) -> [S::f64s; 4] {
    let mut columns = [simd.splat_f64s(0.0); 4];
    for (column, values) in columns.iter_mut().enumerate() {
        let lanes: &mut [f64] = bytemuck::cast_slice_mut(std::slice::from_mut(values));
        for (lane, &row) in lanes.iter_mut().zip(at) {
            *lane = rows[row as usize][column];
        }
    }
    columns
}

/// As [`add_f32s`].
#[inline(always)]
pub(super) fn add_f64s<S: Simd>(_: S, rows: &mut Rows<f64>, at: &[u16], vectors: [S::f64s; 3]) {
    for (column, values) in vectors.iter().enumerate() {
        let lanes: &[f64] = bytemuck::cast_slice(std::slice::from_ref(values));
        for (lane, &row) in lanes.iter().zip(at) {
            rows[row as usize][column] += lane;
        }
    }
}

/// The instruction set `Q` where `S` is that.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn coerced<S: Simd, Q: Copy + 'static>(simd: S) -> Option<Q> {
    (&simd as &dyn std::any::Any).downcast_ref::<Q>().copied()
}

/// Transposes of four lanes at a time, in all quarters of a register at once. Macros, for closures do not get the
/// instructions.
#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::Rows;
    use pulp::x86::{V3, V4};
    use std::arch::x86_64::{__m128, __m256, __m512};

    macro_rules! row {
        ($rows:ident, $at:ident, $lane:expr) => {
            bytemuck::cast::<[f32; 4], __m128>($rows[$at[$lane] as usize])
        };
    }

    macro_rules! add {
        ($sse:expr, $rows:ident, $at:ident, $lane:expr, $vector:expr) => {{
            let row = &mut $rows[$at[$lane] as usize];
            *row = bytemuck::cast($sse._mm_add_ps(bytemuck::cast(*row), $vector));
        }};
    }

    #[inline(always)]
    pub fn columns_512(v4: V4, rows: &Rows<f32>, at: &[u16; 16]) -> [__m512; 4] {
        let v = v4.avx512f;
        macro_rules! quarters {
            ($lane:expr) => {{
                let first = v._mm512_castps128_ps512(row!(rows, at, $lane));
                let second = v._mm512_insertf32x4::<1>(first, row!(rows, at, $lane + 4));
                let third = v._mm512_insertf32x4::<2>(second, row!(rows, at, $lane + 8));
                v._mm512_insertf32x4::<3>(third, row!(rows, at, $lane + 12))
            }};
        }
        let (a, b, c, d) = (quarters!(0), quarters!(1), quarters!(2), quarters!(3));
        let (low_ab, low_cd) = (v._mm512_unpacklo_ps(a, b), v._mm512_unpacklo_ps(c, d));
        let (high_ab, high_cd) = (v._mm512_unpackhi_ps(a, b), v._mm512_unpackhi_ps(c, d));
        [
            v._mm512_shuffle_ps::<0x44>(low_ab, low_cd),
            v._mm512_shuffle_ps::<0xee>(low_ab, low_cd),
            v._mm512_shuffle_ps::<0x44>(high_ab, high_cd),
            v._mm512_shuffle_ps::<0xee>(high_ab, high_cd),
        ]
    }

    #[inline(always)]
    pub fn add_512(v4: V4, rows: &mut Rows<f32>, at: &[u16; 16], [x, y, z]: [__m512; 3]) {
        let v = v4.avx512f;
        // the fourth number of a sum is never read: anything may come there
        let (low, high) = (v._mm512_unpacklo_ps(x, y), v._mm512_unpackhi_ps(x, y));
        let lanes = [
            v._mm512_shuffle_ps::<0x04>(low, z),
            v._mm512_shuffle_ps::<0x1e>(low, z),
            v._mm512_shuffle_ps::<0x24>(high, z),
            v._mm512_shuffle_ps::<0x3e>(high, z),
        ];
        for lane in 0..4 {
            add!(v4.sse, rows, at, lane, v._mm512_castps512_ps128(lanes[lane]));
            add!(v4.sse, rows, at, lane + 4, v._mm512_extractf32x4_ps::<1>(lanes[lane]));
            add!(v4.sse, rows, at, lane + 8, v._mm512_extractf32x4_ps::<2>(lanes[lane]));
            add!(v4.sse, rows, at, lane + 12, v._mm512_extractf32x4_ps::<3>(lanes[lane]));
        }
    }

    #[inline(always)]
    pub fn columns_256(v3: V3, rows: &Rows<f32>, at: &[u16; 8]) -> [__m256; 4] {
        let v = v3.avx;
        macro_rules! halves {
            ($lane:expr) => {{
                let first = v._mm256_castps128_ps256(row!(rows, at, $lane));
                v._mm256_insertf128_ps::<1>(first, row!(rows, at, $lane + 4))
            }};
        }
        let (a, b, c, d) = (halves!(0), halves!(1), halves!(2), halves!(3));
        let (low_ab, low_cd) = (v._mm256_unpacklo_ps(a, b), v._mm256_unpacklo_ps(c, d));
        let (high_ab, high_cd) = (v._mm256_unpackhi_ps(a, b), v._mm256_unpackhi_ps(c, d));
        [
            v._mm256_shuffle_ps::<0x44>(low_ab, low_cd),
            v._mm256_shuffle_ps::<0xee>(low_ab, low_cd),
            v._mm256_shuffle_ps::<0x44>(high_ab, high_cd),
            v._mm256_shuffle_ps::<0xee>(high_ab, high_cd),
        ]
    }

    #[inline(always)]
    pub fn add_256(v3: V3, rows: &mut Rows<f32>, at: &[u16; 8], [x, y, z]: [__m256; 3]) {
        let v = v3.avx;
        // the fourth number of a sum is never read: anything may come there
        let (low, high) = (v._mm256_unpacklo_ps(x, y), v._mm256_unpackhi_ps(x, y));
        let lanes = [
            v._mm256_shuffle_ps::<0x04>(low, z),
            v._mm256_shuffle_ps::<0x1e>(low, z),
            v._mm256_shuffle_ps::<0x24>(high, z),
            v._mm256_shuffle_ps::<0x3e>(high, z),
        ];
        for lane in 0..4 {
            add!(v3.sse, rows, at, lane, v._mm256_castps256_ps128(lanes[lane]));
            add!(v3.sse, rows, at, lane + 4, v._mm256_extractf128_ps::<1>(lanes[lane]));
        }
    }
}

#[cfg(test)]
mod tests;
