//! Where kernels run: on the host's cores, or on a GPU.

pub mod cpu;
