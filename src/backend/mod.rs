//! Where kernels run: on the host's cores, or on a GPU.

pub(crate) mod block_kernel;
pub mod cpu;
pub mod device;
pub mod dispatch;
pub(crate) mod face_kernel;
pub mod gpu;
pub mod kernel;
mod law_kernel;
pub mod many_steps;
pub mod node_stage;
pub mod patch_lists;
pub mod patch_step;
pub mod step;
pub mod user_law;

use bevy_ecs::prelude::*;
use kernel::BufferId;
use std::sync::Arc;

/// What systems bind their kernels to. The GPU backend makes device buffers, `explain` only counts them.
pub trait Buffers {
    /// The buffer of an entity's column, by the column's name; made, and filled from the host, at the first call.
    fn column(&mut self, entity: Entity, name: &'static str) -> BufferId;
    /// A read-only storage buffer of constants.
    fn constants(&mut self, label: String, bytes: &[u8]) -> BufferId;
    /// Whether kernels will run with these buffers, and not only be described.
    fn are_of_device(&self) -> bool {
        true
    }
    /// How many buffers a kernel may use.
    fn most_buffers(&self) -> kernel::MostBuffers {
        kernel::MostBuffers::DESKTOP
    }
    /// How many invocations a workgroup may have.
    fn workgroup_invocations(&self) -> usize {
        kernel::DESKTOP_WORKGROUP
    }
    /// A kernel put together: once, where what hands out the buffers remembers it.
    ///
    /// # Errors
    /// Those of [`kernel::Composer::compose`].
    fn compose(&mut self, kernel: &kernel::Kernel) -> Result<Arc<kernel::Composed>, kernel::KernelError> {
        kernel::Composer::default().compose(kernel)
    }
    /// A uniform buffer of parameters.
    fn uniform(&mut self, label: String, bytes: &[u8]) -> BufferId;
}
