//! The device of a program that has one already, and goes on drawing with it.

use wgpu::{Adapter, Device, DeviceDescriptor, Features, Limits, Queue};

use super::waiting::can_wait;
use super::{AdapterReport, Choice, Gpu, NoGpu};
use crate::backend::kernel::MostBuffers;

pub use wgpu::Buffer;

/// A device of wgpu 30 that a program opened itself, that of its window for instance, for a simulation to compute on:
/// [`Options::host`](crate::Options::host). What is computed need not leave it to be drawn
/// ([`Simulation::gpu_column`](crate::Simulation::gpu_column)).
///
/// It stays the program's own. Its handlers of errors and of its loss are left as they are and hear nothing of what the
/// simulation does wrong, which is the simulation's error; the simulation waits for its own submissions only, and aims
/// at 8 ms of work in each of them, so that a window goes on moving.
#[derive(Clone, Debug)]
pub struct Host {
    /// What the device was opened of.
    pub adapter: Adapter,
    /// The device.
    pub device: Device,
    /// Its queue.
    pub queue: Queue,
}

impl Host {
    /// How to open a device that a simulation can compute on: all that the adapter allows.
    pub fn device_descriptor(adapter: &Adapter) -> DeviceDescriptor<'static> {
        DeviceDescriptor {
            label: Some("sinew"),
            required_features: adapter.features() & Features::TIMESTAMP_QUERY,
            required_limits: adapter.limits(),
            ..DeviceDescriptor::default()
        }
    }
}

impl Gpu {
    /// Takes over a program's device, which stays the program's own: see [`Host`].
    ///
    /// # Errors
    /// [`NoGpu::MayNotWait`] in a page that did not say how it waits; [`NoGpu::TooSmall`]: it was opened with fewer
    /// buffers a kernel than kernels have, though its adapter has more;
    /// [`NoGpu::NoMatch`]: it is not what the choice takes.
    pub fn adopt(host: Host, choice: &Choice) -> Result<Self, NoGpu> {
        if !can_wait() {
            return Err(NoGpu::MayNotWait);
        }
        let report = AdapterReport::of(&host.adapter);
        if !choice.takes(&report) {
            return Err(NoGpu::NoMatch { wanted: choice.to_string(), found: vec![report.to_string()] });
        }
        match too_few(&host.device.limits(), &host.adapter.limits()) {
            None => Ok(Self::on(host.device, host.queue, report, true)),
            Some((what, allowed, wanted)) => {
                Err(NoGpu::TooSmall { adapter: report.to_string(), what, allowed, wanted })
            }
        }
    }
}

/// Of which buffers a device allows a kernel fewer than it needs and its adapter has: what, allowed, wanted.
fn too_few(device: &Limits, adapter: &Limits) -> Option<(&'static str, u32, u32)> {
    let most = MostBuffers::DESKTOP;
    let of =
        |limits: &Limits| [limits.max_storage_buffers_per_shader_stage, limits.max_uniform_buffers_per_shader_stage];
    let needed = [most.storage as u32, most.uniform as u32];
    let names = ["storage", "uniform"];
    let all = names.into_iter().zip(of(device)).zip(of(adapter).into_iter().zip(needed));
    let all = all.map(|((name, allowed), (there, needed))| (name, allowed, there.min(needed)));
    all.into_iter().find(|(_, allowed, wanted)| allowed < wanted)
}

#[cfg(test)]
mod tests;
