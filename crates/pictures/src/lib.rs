//! Pictures of what sinew computes, and plots: drawn on the CPU, without a window or a GPU.

pub mod plot;
pub mod render;
