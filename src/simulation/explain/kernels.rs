//! Kernels as they are put together, without a GPU.

use super::buffers::{Counter, Sizes};
use super::{Bound, Buffer, KernelInUse, Piece};
use crate::backend::Buffers;
use crate::backend::device::Device;
use crate::backend::dispatch::Dispatched;
use crate::backend::gpu::GpuError;
use crate::backend::kernel::{BindingKind, Kernel};
use crate::error::Error;
use crate::simulation::plan::{Over, Plan};
use crate::simulation::step_kernels::step_kernels;
use crate::systems::System;
use bevy_ecs::prelude::*;

/// What runs on a GPU in a step.
#[derive(Default)]
pub struct OnGpu {
    /// The kernels, in order.
    pub kernels: Vec<KernelInUse>,
    /// The buffers that they bind.
    pub buffers: Vec<Buffer>,
    /// How each body's steps are dispatched.
    pub dispatched: Vec<Dispatched>,
}

/// What a GPU runs for a plan, whose `systems` stand as in the plan.
pub fn describe(plan: &Plan, systems: &[&System], sizes: &Sizes, world: &mut World) -> Result<OnGpu, Error> {
    let limits = world.get_resource::<Device>().map(Device::limits);
    let mut counter = Counter::new(sizes, limits);
    let (kernels, dispatched) = step_kernels(plan, systems, world, &mut counter);
    let mut described = Vec::new();
    for (kernels, pass) in kernels.iter().zip(plan.passes(true)) {
        for kernel in kernels {
            let systems = match pass.over == Over::Nodes && !kernel.systems.is_empty() {
                true => kernel.systems.iter().map(ToString::to_string).collect(),
                false => vec![plan.systems[pass.systems[0]].name.clone()],
            };
            let times = pass.repeat.as_ref().filter(|_| kernel.repeated).map_or(1, |repeat| repeat.times);
            described.push(KernelInUse { times, ..in_use(systems, kernel, &mut counter)? });
        }
    }
    Ok(OnGpu { kernels: described, buffers: counter.buffers, dispatched })
}

fn in_use(systems: Vec<String>, kernel: &Kernel, counter: &mut Counter<'_>) -> Result<KernelInUse, Error> {
    let composed = counter.compose(kernel).map_err(GpuError::from)?;
    let entry = composed.entry(kernel.entry);
    let fragments: Vec<Piece> = kernel
        .all_fragments()
        .into_iter()
        .map(|fragment| Piece { path: fragment.path.clone(), lines: fragment.text.lines().count() })
        .collect();
    let bindings = kernel.bindings.iter().map(|(variable, id)| {
        let buffer = counter.get(*id);
        Bound {
            variable: (*variable).to_string(),
            access: match composed.binding(variable.as_ref()).map(|binding| binding.kind) {
                Some(BindingKind::ReadWrite) => "read_write",
                Some(BindingKind::Read) => "read",
                Some(BindingKind::Uniform) | None => "uniform",
            },
            buffer: buffer.map_or_else(String::new, Buffer::full_name),
            bytes: buffer.map_or(0, |buffer| buffer.bytes),
        }
    });
    Ok(KernelInUse {
        label: kernel.label.clone(),
        system: systems.join(" + "),
        systems,
        entry: kernel.entry,
        times: 1,
        threads: kernel.threads,
        workgroup: entry.map_or(1, |entry| entry.workgroup_size.iter().product()),
        workgroup_memory: entry.map_or(0, |entry| entry.workgroup_memory),
        storage_buffers: entry.map_or(0, |entry| composed.storage_buffers(entry)),
        lines: fragments.iter().map(|piece| piece.lines).sum(),
        bindings: bindings.collect(),
        listing: kernel.listing(),
        fragments,
    })
}

impl Buffer {
    /// What it is and what it belongs to.
    fn full_name(&self) -> String {
        match self.of.as_str() {
            "" => self.name.clone(),
            of => format!("{} of {of}", self.name),
        }
    }
}
