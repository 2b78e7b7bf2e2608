//! Kernels as they are put together, without a GPU.

use super::buffers::{Counter, Sizes};
use super::{Bound, Buffer, KernelInUse, Piece};
use crate::backend::gpu::GpuError;
use crate::backend::kernel::{BindingKind, Kernel, compose};
use crate::backend::node_stage::node_kernels;
use crate::error::Error;
use crate::simulation::build::stages_of;
use crate::systems::{OnDevice, System};
use bevy_ecs::prelude::*;

/// The kernels of all systems, which stand in their order, and the buffers that they bind.
pub fn describe(
    systems: &[&System],
    fuse: bool,
    sizes: &Sizes,
    world: &mut World,
) -> Result<(Vec<KernelInUse>, Vec<Buffer>), Error> {
    let mut counter = Counter::new(sizes);
    let mut described = Vec::new();
    let mut nodes: Vec<&System> = Vec::new();
    // one more time round, for what is left of systems of nodes at the end
    for system in systems.iter().map(Some).chain([None]) {
        let of_nodes = system.filter(|system| matches!(system.device, OnDevice::Stages(_)) && fuse);
        if let Some(system) = of_nodes {
            nodes.push(system);
            continue;
        }
        let stages = stages_of(nodes.drain(..), world, &mut counter);
        for kernel in node_kernels(stages, true, &mut counter) {
            described.push(in_use(&kernel.label, &kernel, &counter)?);
        }
        let Some(system) = system else { break };
        for kernel in system.device.kernels(world, &mut counter) {
            described.push(in_use(&system.name, &kernel, &counter)?);
        }
    }
    Ok((described, counter.buffers))
}

fn in_use(system: &str, kernel: &Kernel, counter: &Counter<'_>) -> Result<KernelInUse, Error> {
    let composed = compose(&kernel.fragments).map_err(GpuError::from)?;
    let entry = composed.entry(kernel.entry);
    let fragments: Vec<Piece> = kernel
        .fragments
        .iter()
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
        system: system.to_string(),
        entry: kernel.entry,
        threads: kernel.threads,
        workgroup: entry.map_or(1, |entry| entry.workgroup_size.iter().product()),
        workgroup_memory: entry.map_or(0, |entry| entry.workgroup_memory),
        storage_buffers: entry.map_or(0, |entry| composed.storage_buffers(entry)),
        lines: fragments.iter().map(|piece| piece.lines).sum(),
        bindings: bindings.collect(),
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
