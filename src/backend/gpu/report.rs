//! What is said of devices: which is wanted, what it is, what it allows, what its memory and time go into.

use crate::backend::kernel::MostBuffers;

/// Which device is wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// A discrete GPU, else an integrated one, else a software device.
    #[default]
    Best,
    /// The same without software devices.
    Hardware,
    /// A software device (lavapipe, WARP): for tests.
    Software,
    /// A device whose name contains this, whatever its kind; case is ignored.
    Named(String),
}

impl Choice {
    /// Reads what a user writes: `best`, `hardware`, `software`, or a part of a device's name.
    pub fn parse(text: &str) -> Self {
        match text {
            "best" | "" => Self::Best,
            "hardware" => Self::Hardware,
            "software" => Self::Software,
            name => Self::Named(name.to_owned()),
        }
    }

    /// Whether a device is what is wanted.
    #[cfg(feature = "gpu")]
    pub(super) fn takes(&self, report: &AdapterReport) -> bool {
        match self {
            Self::Best => true,
            Self::Hardware => !report.software,
            Self::Software => report.software,
            Self::Named(name) => report.name.to_lowercase().contains(&name.to_lowercase()),
        }
    }
}

impl std::fmt::Display for Choice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Best => write!(f, "`best`"),
            Self::Hardware => write!(f, "`hardware` (no software device)"),
            Self::Software => write!(f, "`software`"),
            Self::Named(name) => write!(f, "the name `{name}`"),
        }
    }
}

/// What a device says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Name of the device.
    pub name: String,
    /// Driver and its version.
    pub driver: String,
    /// Interface: `Vulkan`, `Metal` or `Dx12`.
    pub interface: String,
    /// Whether the device is a program on the CPU: right for tests, no measure of speed.
    pub software: bool,
    /// `discrete`, `integrated`, `virtual`, `software` or `unknown`.
    pub kind: &'static str,
}

impl std::fmt::Display for AdapterReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({}, {}", self.name, self.kind, self.interface)?;
        // a browser tells of none
        if !self.driver.is_empty() {
            write!(f, ", {}", self.driver)?;
        }
        f.write_str(")")
    }
}

/// What the device allows, as far as the engine cares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GpuLimits {
    /// Bytes of one storage binding.
    pub storage_binding: u64,
    /// Bytes of one uniform binding.
    pub uniform_binding: u64,
    /// Bytes of one buffer.
    pub buffer: u64,
    /// Buffers of one kernel.
    pub buffers: MostBuffers,
    /// Bytes of workgroup memory.
    pub workgroup_memory: u32,
    /// Invocations of a workgroup.
    pub workgroup_size: u32,
    /// Whether kernels can be timed.
    pub time_stamps: bool,
}

/// Less than a device allows, as on a smaller one: for trying out what a program does there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SmallerLimits {
    /// Bytes of one storage binding.
    pub storage_binding: Option<u64>,
    /// Workgroups in one dimension of a dispatch.
    pub workgroups: Option<u32>,
}

/// What a buffer is bound as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BufferKind {
    /// `var<storage, ...>`
    Storage,
    /// `var<uniform>`
    Uniform,
}

/// Memory of the buffers with one label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The label.
    pub label: String,
    /// Bytes in all.
    pub bytes: u64,
    /// Number of buffers.
    pub count: usize,
}

/// Time spent in the kernels of one label.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KernelTime {
    /// The kernels' label.
    pub label: String,
    /// Time on the GPU (ns), all dispatches together.
    pub nanoseconds: f64,
    /// Number of dispatches.
    pub dispatches: u64,
}
