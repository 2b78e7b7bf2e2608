//! Sums over all axes, the same for any number of threads: of blocks of so many numbers, added pair by pair.

use super::vectors::with_numbers;
use crate::backend::cpu::Cpu;
use crate::components::Reals;
use crate::math::Scalar;
use crate::simulation::frequency::dot as dot_of_block;

/// Numbers of a block.
const BLOCK: usize = 3072;
/// Blocks from which on threads share them: below that they take longer to call than to add.
const WORTH_SHARING: usize = 64;

/// What adds up, on the threads of a run.
pub(super) struct Sums(Cpu);

impl Sums {
    pub fn on(cpu: &Cpu) -> Self {
        Self(cpu.twin())
    }

    /// These threads.
    pub fn cpu(&self) -> &Cpu {
        &self.0
    }

    /// a·b.
    pub fn dot(&self, a: &Reals, b: &Reals) -> f64 {
        with_numbers!(a, T => self.dot_of(a.slice::<T>(), b.slice::<T>()))
    }

    fn dot_of<T: Scalar>(&self, a: &[T], b: &[T]) -> f64 {
        let blocks = a.len().div_ceil(BLOCK);
        let of = |block: usize| {
            let range = block * BLOCK..a.len().min((block + 1) * BLOCK);
            dot_of_block(&a[range.clone()], &b[range])
        };
        if blocks < WORTH_SHARING {
            return pairwise(0, blocks, &of);
        }
        let sums = self.0.map(blocks, of);
        pairwise(0, blocks, &|block| sums[block])
    }

    /// ‖a‖.
    pub fn norm(&self, a: &Reals) -> f64 {
        self.dot(a, a).sqrt()
    }
}

fn pairwise(first: usize, count: usize, of: &impl Fn(usize) -> f64) -> f64 {
    match count {
        0 => 0.0,
        1 => of(first),
        _ => {
            let half = count / 2;
            pairwise(first, half, of) + pairwise(first + half, count - half, of)
        }
    }
}

#[cfg(test)]
mod tests;
