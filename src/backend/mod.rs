//! Where kernels run.
