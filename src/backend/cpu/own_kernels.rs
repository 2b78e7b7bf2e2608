//! Kernels for a law of the user's own in Rust, compiled in the user's crate.

use super::element_kernel::run_block_of;
use super::{BlockColumns, BlockLaw, Cpu};
use crate::components::Block;
use crate::elements::with_element_of;
use crate::materials::Elastic;
use bevy_ecs::prelude::*;
use std::fmt;
use std::sync::Arc;

/// The element kernels in f32 of one law, for all element types. The compiler makes them where
/// [`of`](OwnKernels::of) is called.
#[derive(Component, Clone)]
pub struct OwnKernels(Arc<dyn Run>);

impl OwnKernels {
    /// Of a law.
    pub fn of<L: Elastic<f32> + 'static>(law: L) -> Self {
        Self(Arc::new(OfLaw(law)))
    }

    /// As [`run_block`](super::run_block).
    pub(crate) fn run(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f32>,
        law: &BlockLaw<f32>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize> {
        self.0.run(cpu, columns, law, block, groups_a_patch)
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

trait Run: Send + Sync {
    fn run(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f32>,
        law: &BlockLaw<f32>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize>;
}

struct OfLaw<L>(L);

impl<L: Elastic<f32>> Run for OfLaw<L> {
    fn run(
        &self,
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f32>,
        law: &BlockLaw<f32>,
        block: &Block,
        groups_a_patch: usize,
    ) -> Vec<usize> {
        with_element_of!(block, E => run_block_of::<E, L>(cpu, columns, law, &self.0, groups_a_patch))
    }
}
