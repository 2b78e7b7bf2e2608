//! The GPU layer: the only place that knows wgpu. It runs [kernels](super::kernel) and knows nothing of physics.
//! Without the feature `gpu` there is no wgpu, and no [`Gpu`] can be opened.
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

mod error;
mod report;
mod testing;

#[cfg(feature = "gpu")]
mod adapter;
#[cfg(feature = "gpu")]
mod buffers;
#[cfg(feature = "gpu")]
mod device;
#[cfg(feature = "gpu")]
mod host;
#[cfg(feature = "gpu")]
mod inbox;
#[cfg(feature = "gpu")]
mod pipelines;
#[cfg(feature = "gpu")]
mod quirks;
#[cfg(feature = "gpu")]
mod run;
#[cfg(feature = "gpu")]
mod submission_throttle;
#[cfg(feature = "gpu")]
mod timing;
#[cfg(feature = "gpu")]
mod waiting;

#[cfg(not(feature = "gpu"))]
mod absent;

#[cfg(not(feature = "gpu"))]
pub use absent::{Buffer, Gpu, Host};
#[cfg(feature = "gpu")]
pub use device::Gpu;
pub use error::{GpuError, NoGpu};
#[cfg(feature = "gpu")]
pub use host::{Buffer, Host};
pub use report::{AdapterReport, BufferKind, Choice, GpuLimits, KernelTime, Memory, SmallerLimits};
pub use testing::gpu_or_reason;
#[cfg(all(feature = "gpu", target_arch = "wasm32"))]
pub use waiting::{Waiting, wait_by};
