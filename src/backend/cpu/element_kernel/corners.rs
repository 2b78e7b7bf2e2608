//! Displacements of the corners of a group of elements, side by side.

use crate::elements::{Element, MOST_NODES};
use crate::math::{LANES, SimdScalar};
use pulp::Simd;

/// Vectors of a group's nodes, brought side by side.
#[inline(always)]
pub(in crate::backend::cpu) fn group_vectors<E: Element, T: SimdScalar>(
    nodes: &[u32],
    column: &[T],
) -> [[[T; LANES]; 3]; MOST_NODES] {
    let mut vectors = [[[T::default(); LANES]; 3]; MOST_NODES];
    for corner in 0..E::NODES {
        for lane in 0..LANES {
            let row = 3 * nodes[corner * LANES + lane] as usize;
            let vector = &column[row..row + 3];
            for i in 0..3 {
                vectors[corner][i][lane] = vector[i];
            }
        }
    }
    vectors
}

/// A register full of nodal vectors, from lane `at` on.
#[inline(always)]
pub(in crate::backend::cpu) fn corner_registers<E: Element, T: SimdScalar, S: Simd>(
    simd: S,
    vectors: &[[[T; LANES]; 3]; MOST_NODES],
    at: usize,
) -> [[T::Vector<S>; 3]; MOST_NODES] {
    let mut u = [[T::splat(simd, T::default()); 3]; MOST_NODES];
    for corner in 0..E::NODES {
        for i in 0..3 {
            u[corner][i] = T::load(simd, &vectors[corner][i][at..]);
        }
    }
    u
}
