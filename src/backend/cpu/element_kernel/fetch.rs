//! What a kernel needs next, asked of memory before it is needed: of columns that are read in pieces of some kilobytes
//! the core finds out too late what comes next.

use super::PatchForces;
use crate::elements::Element;
use crate::materials::Elastic;
use crate::math::{LANES, SimdScalar};
use prefetch_index::prefetch_index;

/// Bytes of rest shapes up to which a block is taken to lie in some cache, where asking beforehand costs a hundredth
/// and gains nothing.
pub(super) const IN_CACHE: usize = 8 << 20;

/// How many groups of elements beforehand: 2 to 8 are alike (docs/performance.md).
pub(super) const AHEAD: usize = 3;

/// Bytes that come at once.
const LINE: usize = 64;

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> PatchForces<'_, E, T, L, EFFECTS> {
    /// Asks for what a group of elements reads one after the other. It may be one of the next patch's, or none.
    #[inline(always)]
    pub(super) fn fetch(&self, group: usize) {
        ask(self.rest_shape, group * E::ROWS, E::ROWS);
        match &self.patch_local {
            Some(patch_local) => ask(patch_local.corners, group * E::NODES, E::NODES),
            None => ask(self.connectivity, group * E::NODES, E::NODES),
        }
        let numbers = self.memory_rows * LANES;
        ask(&*self.memory, group * numbers, numbers);
    }
}

/// Asks for so many numbers of a column.
#[inline(always)]
fn ask<X>(column: &[X], first: usize, numbers: usize) {
    for byte in (0..numbers * size_of::<X>()).step_by(LINE) {
        prefetch_index(column, first + byte / size_of::<X>());
    }
}
