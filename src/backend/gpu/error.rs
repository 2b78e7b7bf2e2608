//! What can go wrong on a GPU, as values: nothing here panics or ends the process.

use crate::backend::kernel::KernelError;

/// Why there is no GPU to run on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoGpu {
    /// This sinew was built without the feature `gpu`.
    #[error("no GPU: this sinew was built without its feature `gpu`; the CPU backend needs none")]
    NotBuilt,
    /// No driver showed a device.
    #[error(
        "no GPU found: no Vulkan, Metal or DX12 driver shows a device. Install your vendor's driver, or \
         mesa-vulkan-drivers for a software device (Debian, Ubuntu); the CPU backend needs neither"
    )]
    NoDriver,
    /// A page whose browser has no way to wait for a device, or that did not say how (`gpu::wait_by`).
    #[error(
        "no GPU: this browser cannot wait for one, for which it needs JavaScript Promise Integration (Chromium from 137 \
         on); the CPU backend needs none"
    )]
    MayNotWait,
    /// There are devices, and none is what was asked for.
    #[error("no GPU matches {wanted}; there is {}", found.join(", "))]
    NoMatch {
        /// What was asked for.
        wanted: String,
        /// Every device there is.
        found: Vec<String>,
    },
    /// The device was found and could not be opened.
    #[error("the GPU {adapter} could not be opened: {reason}")]
    Refused {
        /// The device.
        adapter: String,
        /// What its driver says.
        reason: String,
    },
    /// A program's device that allows less than kernels need.
    #[error(
        "the program's device of {adapter} was opened with {allowed} {what} buffers a shader, of {wanted} that kernels \
         need and it has: open it with sinew::Host::device_descriptor(&adapter)"
    )]
    TooSmall {
        /// The device.
        adapter: String,
        /// Which buffers.
        what: &'static str,
        /// How many of them it allows.
        allowed: u32,
        /// How many are needed, and could be had.
        wanted: u32,
    },
}

/// What went wrong on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
pub enum GpuError {
    /// The kernel itself is wrong.
    #[error(transparent)]
    Kernel(Box<KernelError>),
    /// More than the device takes, found before it was asked.
    #[error("`{label}`: {wanted} {unit} wanted, {adapter} allows {limit} ({limit_name})")]
    OverLimit {
        /// Buffer or kernel.
        label: String,
        /// Amount wanted.
        wanted: u64,
        /// What is counted: bytes, storage buffers, invocations ...
        unit: &'static str,
        /// Amount allowed.
        limit: u64,
        /// WebGPU's name of the limit.
        limit_name: &'static str,
        /// The device.
        adapter: String,
    },
    /// The device's memory is full.
    #[error("out of GPU memory: buffer `{label}` of {bytes} bytes, with {used} bytes in other buffers")]
    OutOfMemory {
        /// The buffer.
        label: String,
        /// Bytes wanted.
        bytes: u64,
        /// Bytes in buffers of this device before.
        used: u64,
    },
    /// A range outside a buffer, or not on a 4-byte boundary.
    #[error("buffer `{label}` has {size} bytes; cannot {action} {bytes} bytes at {offset}{}", aligned(*offset, *bytes))]
    Range {
        /// The buffer.
        label: String,
        /// Upload or download.
        action: &'static str,
        /// First byte.
        offset: u64,
        /// Bytes asked for.
        bytes: u64,
        /// Bytes of the buffer.
        size: u64,
    },
    /// A buffer does not fit the variable it is bound to.
    #[error("kernel `{kernel}`: buffer `{buffer}` cannot be bound to `{variable}`: {problem}")]
    Unfit {
        /// The kernel.
        kernel: String,
        /// The buffer.
        buffer: String,
        /// The WGSL variable.
        variable: String,
        /// What does not fit.
        problem: String,
    },
    /// The step records do not fit the kernels or the count.
    #[error("step records: {0}")]
    Records(String),
    /// An id of another device, or of something freed.
    #[error("{0} is not one of this GPU's, or was freed")]
    Unknown(String),
    /// The device went away: unplugged, driver reset, a submission over the time-out.
    #[error("the GPU was lost: {0}")]
    Lost(String),
    /// A submission did not end.
    #[error("the GPU did not finish within {0} s")]
    TimedOut(u64),
    /// The device has no clock that kernels can be timed with.
    #[error("{0} has no time stamps (timestamp-query): kernels cannot be timed on it")]
    NoTimeStamps(String),
    /// wgpu or the driver refused something that this layer did not foresee.
    #[error("GPU error in {during}: {message}")]
    Device {
        /// What was being done.
        during: String,
        /// wgpu's text.
        message: String,
    },
}

impl From<KernelError> for GpuError {
    fn from(error: KernelError) -> Self {
        Self::Kernel(Box::new(error))
    }
}

fn aligned(offset: u64, bytes: u64) -> &'static str {
    if offset.is_multiple_of(4) && bytes.is_multiple_of(4) { "" } else { " (offset and bytes must be multiples of 4)" }
}
