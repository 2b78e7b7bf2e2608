//! Kernels for a law of the user's own in Rust, compiled in the user's crate.

use super::element_kernel::{BlockRun, GENERIC, VECTORS, is_specialised};
use super::{BlockColumns, BlockLaw, Cpu};
use crate::components::Block;
use crate::elements::{Element, with_element_of};
use crate::materials::Elastic;
use bevy_ecs::prelude::*;
use std::fmt;
use std::sync::Arc;

/// The element kernels of one law in f32 and in f64, for all element types, on machines with vector registers. The
/// compiler makes them where [`of`](OwnKernels::of) is called.
#[derive(Component, Clone)]
pub struct OwnKernels(Arc<dyn Run>);

impl OwnKernels {
    /// Of a law over both kinds of numbers.
    pub fn of<L: Elastic<f32> + 'static, M: Elastic<f64> + 'static>(single: L, double: M) -> Self {
        Self(Arc::new(OfLaw { single, double }))
    }

    /// The kernels, to run.
    pub(crate) fn kernels(&self) -> &dyn Run {
        &*self.0
    }
}

/// Laws that were compiled once are the same.
impl PartialEq for OwnKernels {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for OwnKernels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OwnKernels")
    }
}

/// As [`run_block`](super::run_block), with one law.
pub(crate) trait Run: Send + Sync {
    /// In f32.
    fn single(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f32>,
        law: &BlockLaw<f32>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize>;

    /// In f64.
    fn double(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f64>,
        law: &BlockLaw<f64>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize>;
}

struct OfLaw<L, M> {
    single: L,
    double: M,
}

impl<L: Elastic<f32>, M: Elastic<f64>> Run for OfLaw<L, M> {
    fn single(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f32>,
        law: &BlockLaw<f32>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize> {
        with_element_of!(block, E => run_block_of::<E, L>(cpu, columns, law, &self.single, groups_a_patch))
    }

    fn double(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f64>,
        law: &BlockLaw<f64>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize> {
        with_element_of!(block, E => run_block_of_double::<E, M>(cpu, columns, law, &self.double, groups_a_patch))
    }
}

/// As [`run_block`](super::run_block) in f32, with a law that is known when this is compiled, on a machine with vector
/// registers.
fn run_block_of<E: Element, L: Elastic<f32>>(
    cpu: &Cpu,
    columns: BlockColumns<'_, '_, f32>,
    law: &BlockLaw<f32>,
    elastic: &L,
    groups_a_patch: usize,
) -> Vec<usize> {
    let block = BlockRun::<E, f32>::new(cpu, columns, law, groups_a_patch);
    if const { is_specialised::<E>() } && law.is_elastic() {
        return block.run::<_, 0>(elastic);
    }
    block.run::<_, { GENERIC | VECTORS }>(elastic)
}

/// The same in f64, with the kernel that asks for each effect.
fn run_block_of_double<E: Element, L: Elastic<f64>>(
    cpu: &Cpu,
    columns: BlockColumns<'_, '_, f64>,
    law: &BlockLaw<f64>,
    elastic: &L,
    groups_a_patch: usize,
) -> Vec<usize> {
    BlockRun::<E, f64>::new(cpu, columns, law, groups_a_patch).run::<_, { GENERIC | VECTORS }>(elastic)
}
