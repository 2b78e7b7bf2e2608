//! Code of kernels that is the same for all kinds of elements, and rarely runs or takes its time: once for all of them.

use super::LawCopies;
use crate::materials::Elastic;
use crate::math::SimdScalar;
use pulp::{Simd, WithSimd};

/// Runs a task by the instructions of `simd` in a function that is neither inlined nor made again for every caller, as
/// those are that `pulp` makes of `vectorize`.
#[inline(never)]
pub(super) fn in_one_place<S: Simd, O: WithSimd>(simd: S, task: O) -> O::Output {
    simd.vectorize(task)
}

/// [`LawCopies::elastic`].
pub(super) struct ElasticOfCopies<'a, T: SimdScalar, L, S: Simd> {
    pub(super) simd: S,
    pub(super) copies: &'a LawCopies<T>,
    pub(super) kind: &'a L,
    pub(super) group: usize,
    pub(super) at: usize,
}

impl<T: SimdScalar, L: Elastic<T>, S: Simd> WithSimd for ElasticOfCopies<'_, T, L, S> {
    type Output = L::Of<T::Vector<S>>;

    #[inline(always)]
    fn with_simd<Q: Simd>(self, _: Q) -> Self::Output {
        self.copies.elastic(self.simd, self.kind, self.group, self.at)
    }
}
