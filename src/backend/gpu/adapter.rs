//! Which devices there are, and which of them to run on.

use std::sync::OnceLock;

use wgpu::{Adapter, Backends, DeviceType, Instance, InstanceDescriptor};

use super::waiting::{block_on, can_wait};
use super::{AdapterReport, Choice, NoGpu};

impl AdapterReport {
    /// What an adapter is.
    pub(super) fn of(adapter: &Adapter) -> Self {
        let info = adapter.get_info();
        let kind = match info.device_type {
            DeviceType::DiscreteGpu => "discrete",
            DeviceType::IntegratedGpu => "integrated",
            DeviceType::VirtualGpu => "virtual",
            DeviceType::Cpu => "software",
            DeviceType::Other => "unknown",
        };
        // browsers keep to themselves whose it is
        let name = if info.name.is_empty() { "WebGPU".to_owned() } else { info.name };
        Self {
            name,
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            interface: format!("{:?}", info.backend),
            software: info.device_type == DeviceType::Cpu,
            kind,
        }
    }

    /// Low is preferred.
    fn rank(&self) -> usize {
        ["discrete", "virtual", "integrated", "unknown", "software"].iter().position(|k| *k == self.kind).unwrap_or(9)
    }

    /// Every device there is, the preferred first. Empty where there is no driver.
    pub fn all() -> Vec<Self> {
        candidates().into_iter().map(|(_, report)| report).collect()
    }
}

/// What finds devices, one for all of a process: to one that had made dozens the driver of an H200 showed none any
/// more.
fn instance() -> &'static Instance {
    static INSTANCE: OnceLock<Instance> = OnceLock::new();
    INSTANCE.get_or_init(|| {
        let mut descriptor = InstanceDescriptor::new_without_display_handle();
        descriptor.backends = Backends::VULKAN | Backends::METAL | Backends::DX12 | Backends::BROWSER_WEBGPU;
        // validation layers cost time and write to the terminal; this layer checks what it passes on
        descriptor.flags = wgpu::InstanceFlags::empty();
        Instance::new(descriptor)
    })
}

fn candidates() -> Vec<(Adapter, AdapterReport)> {
    let adapters = block_on(instance().enumerate_adapters(Backends::all()));
    let mut found: Vec<_> = adapters.into_iter().map(|a| (AdapterReport::of(&a), a)).map(|(r, a)| (a, r)).collect();
    // stable: the driver's own order decides among equals
    found.sort_by_key(|(_, report)| report.rank());
    found
}

/// The best device that the choice takes.
pub(super) fn choose(choice: &Choice) -> Result<(Adapter, AdapterReport), NoGpu> {
    if !can_wait() {
        return Err(NoGpu::MayNotWait);
    }
    let found = candidates();
    if found.is_empty() {
        return Err(NoGpu::NoDriver);
    }
    let names = found.iter().map(|(_, report)| report.to_string()).collect();
    let taken = found.into_iter().find(|(_, report)| choice.takes(report));
    taken.ok_or_else(|| NoGpu::NoMatch { wanted: choice.to_string(), found: names })
}
