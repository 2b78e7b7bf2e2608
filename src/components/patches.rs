//! Patches: neighbouring elements whose nodes fit into a core's cache or a GPU workgroup's memory.

use super::GROUP_ROWS;
use bevy_ecs::prelude::*;

/// How the forces of elements are summed at the nodes. Results differ by rounding only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Patch by patch in cache or in a workgroup's memory, then over the patches that share a node: a tenth to a third
    /// of the traffic with memory.
    #[default]
    Patches,
    /// Every element writes the forces on its corners, every node sums them: the paper's two kernels. To compare with,
    /// and what a GPU runs of a mesh whose patches do not fit a workgroup.
    TwoPass,
}

/// The nodes of each of a block's patches, which are [`patch_groups`](super::patch_groups) groups of elements one after
/// the other. A patch's forces are summed at its own nodes, and [`ElementForce`](super::ElementForce) has a vector for
/// each of them; what patches share is summed by the gather.
#[derive(Component, Clone, Debug, Default)]
pub struct Patches {
    /// Where each patch's nodes begin; one number more than patches.
    pub starts: Vec<u32>,
    /// Rows of the body's node columns, ascending in each patch.
    pub nodes: Vec<u32>,
    /// How many of each patch's nodes, its first ones, are in no other patch and stand one after the other, from patch
    /// to patch of all blocks of the body: those that can move as soon as the patch's forces are known.
    pub interior: Vec<u32>,
    /// How many of these, their last ones, can do so only in steps in which nothing acts on surfaces
    /// ([`SurfaceSleep`](super::SurfaceSleep)), and else wait until all patches are done. Of either sort a patch has
    /// none or at least [`GROUP_ROWS`].
    pub deferred: Vec<u32>,
    /// Elements' corners as places among their patch's nodes; laid out as [`Connectivity`](super::Connectivity).
    pub connectivity: Vec<u16>,
}

impl Patches {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// How many nodes inside a patch always move with it, and how many of them may have to wait.
    pub fn inside(&self, patch: usize) -> [usize; 2] {
        let [interior, deferred] = [&self.interior, &self.deferred].map(|all| all[patch] as usize);
        [interior - deferred, deferred]
    }
}

/// How many nodes a patch has that always move with it, and how many that may have to wait, where it has so many that
/// no other patch has: some that nobody waits for, and some of surfaces that may meet others. Fewer than [`GROUP_ROWS`]
/// do not move by themselves: they wait with the others, or move with those that patches share.
pub fn inside_of([free, of_surface]: [usize; 2]) -> [usize; 2] {
    match [free >= GROUP_ROWS, of_surface >= GROUP_ROWS] {
        [true, true] => [free, of_surface],
        [true, false] => [free, 0],
        [false, _] if of_surface > 0 && free + of_surface >= GROUP_ROWS => [0, free + of_surface],
        [false, _] => [0, 0],
    }
}

#[cfg(test)]
mod tests;
