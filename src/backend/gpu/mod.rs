//! The GPU layer: the only place that knows wgpu. It runs [kernels](super::kernel) and knows nothing of physics.
//!
//! ```no_run
//! use sinew::backend::gpu::{BufferKind, Choice, Gpu};
//! use sinew::backend::kernel::{Fragment, Kernel};
//!
//! let mut gpu = Gpu::open(&Choice::Best)?;
//! let x = gpu.create("x", 4 * 1000, BufferKind::Storage)?;
//! gpu.upload(x, 0, bytemuck::cast_slice(&[1.0f32; 1000]))?;
//! let text = "@group(0) @binding(0) var<storage, read_write> x: array<f32>;
//!     @compute @workgroup_size(64) fn twice(@builtin(global_invocation_id) id: vec3<u32>) {
//!         if id.x < arrayLength(&x) { x[id.x] *= 2.0; }
//!     }";
//! let twice = Kernel::new("twice", "twice").fragment(Fragment::new("twice.wgsl", text)).bind("x", x).threads(1000);
//! let twice = gpu.prepare(&twice)?;
//! gpu.run_once(&[twice])?;
//! assert_eq!(gpu.download_rows::<f32>(x)?, [2.0; 1000]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adapter;
mod buffers;
mod device;
mod error;
mod pace;
mod pipelines;
mod quirks;
mod run;
mod testing;
mod timing;

pub use adapter::{AdapterReport, Choice};
pub use buffers::{BufferKind, Memory};
pub use device::{Gpu, GpuLimits, SmallerLimits};
pub use error::{GpuError, NoGpu};
pub use testing::gpu_or_reason;
pub use timing::KernelTime;
