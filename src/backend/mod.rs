//! Where kernels run.

pub mod gpu;
pub mod kernel;
pub mod cpu;
