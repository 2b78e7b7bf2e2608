//! What stands for a GPU in a sinew without the feature `gpu`: there is none, so nothing of it is ever called.

use bytemuck::{AnyBitPattern, NoUninit};

use super::{AdapterReport, BufferKind, Choice, GpuError, GpuLimits, KernelTime, Memory, NoGpu, SmallerLimits};
use crate::backend::kernel::{BufferId, Composed, Kernel, KernelError, KernelId};
use std::sync::Arc;

/// A program's device, of which there is none.
#[derive(Clone, Debug)]
pub enum Host {}

/// A buffer, of which there is none.
#[derive(Clone, Debug)]
pub enum Buffer {}

/// A GPU, of which there is none.
pub enum Gpu {}

impl AdapterReport {
    /// Every device there is: none.
    pub fn all() -> Vec<Self> {
        Vec::new()
    }
}

impl Gpu {
    /// Says that there is none.
    ///
    /// # Errors
    /// [`NoGpu::NotBuilt`], always.
    pub fn open(_: &Choice) -> Result<Self, NoGpu> {
        Err(NoGpu::NotBuilt)
    }

    /// Is never called.
    ///
    /// # Errors
    /// None: there is no device to call it with.
    pub fn adopt(host: Host, _: &Choice) -> Result<Self, NoGpu> {
        match host {}
    }
}

/// Methods that cannot be called.
#[allow(missing_docs, reason = "as those of the same names with the feature `gpu`")]
impl Gpu {
    pub fn report(&self) -> &AdapterReport {
        match *self {}
    }

    pub fn destroy(&mut self) {
        match *self {}
    }

    pub fn keep_to(&mut self, _: SmallerLimits) {
        match *self {}
    }

    pub fn limits(&self) -> GpuLimits {
        match *self {}
    }

    pub fn wait(&mut self) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn create(&mut self, _: &str, _: u64, _: BufferKind) -> Result<BufferId, GpuError> {
        match *self {}
    }

    pub fn create_with<T: NoUninit>(&mut self, _: &str, _: &[T], _: BufferKind) -> Result<BufferId, GpuError> {
        match *self {}
    }

    pub fn free(&mut self, _: BufferId) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn upload(&mut self, _: BufferId, _: u64, _: &[u8]) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn download(&mut self, _: &[BufferId]) -> Result<Vec<Vec<u8>>, GpuError> {
        match *self {}
    }

    pub fn download_ranges(&mut self, _: &[(BufferId, u64, u64)]) -> Result<Vec<Vec<u8>>, GpuError> {
        match *self {}
    }

    pub fn download_rows<T: AnyBitPattern>(&mut self, _: BufferId) -> Result<Vec<T>, GpuError> {
        match *self {}
    }

    pub fn lend(&self, _: BufferId) -> Option<Buffer> {
        match *self {}
    }

    pub fn memory(&self) -> Vec<Memory> {
        match *self {}
    }

    pub fn memory_total(&self) -> u64 {
        match *self {}
    }

    pub fn prepare(&mut self, _: &Kernel) -> Result<KernelId, GpuError> {
        match *self {}
    }

    pub fn compose(&mut self, _: &Kernel) -> Result<Arc<Composed>, KernelError> {
        match *self {}
    }

    pub fn set_threads(&mut self, _: KernelId, _: u32) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn run(&mut self, _: &[KernelId], _: &[u8], _: usize, _: u32) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn run_once(&mut self, _: &[KernelId]) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn submissions(&self) -> u64 {
        match *self {}
    }

    pub fn dispatches(&self) -> u64 {
        match *self {}
    }

    pub fn time_kernels(&mut self, _: bool) -> Result<(), GpuError> {
        match *self {}
    }

    pub fn kernel_times(&self) -> Vec<KernelTime> {
        match *self {}
    }
}
