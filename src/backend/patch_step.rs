//! Nodes inside a patch move in the kernel that sums the patch's forces: of which bodies, and why not of others.
//! `shaders/patch_step.wgsl` is the kernel.

use super::Buffers;
use super::dispatch::{ElementsThenNodes, block_of};
use super::kernel::Kernel;
use super::node_stage::{self, Frame, NodeStage};
use super::patch_lists::{BATCH_GROUPS, WEBGPU_WORKGROUP_MEMORY, workgroup_memory};
use crate::components::{Corners, GROUP_ROWS, Label, Patches};
use crate::math::LANES;
use crate::shader;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// The first row of a body that is inside no patch, where those before it may move with their patches; or why they may
/// not.
pub(super) fn first_interface(
    body: Entity,
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) -> Result<u32, String> {
    let (blocks, of_nodes) = (step.blocks_of(body, world), step.stages_of(body));
    if blocks.is_empty() || !of_nodes.iter().any(|stage| stage.sums_forces()) {
        return Err("it has no elements".into());
    }
    if blocks.iter().any(|kernel| !kernel.fragments.contains(&shader!("patches"))) {
        return Err("its forces are not summed by patches".into());
    }
    let first_interface = world.get::<Corners>(body).map_or(0, |corners| corners.first_interface) as u32;
    if first_interface == 0 {
        return Err(format!("no patch has {GROUP_ROWS} nodes that no other has"));
    }
    // of all nodes: those that stay may look at those that move
    node_stage::together(&of_nodes, Frame::node_pass(), node_stage::MOST_SHARED, buffers)?;
    for kernel in blocks {
        let Some(stages) = step_of_block(kernel, body, &of_nodes, world)? else { continue };
        let stages: Vec<&NodeStage> = stages.iter().collect();
        node_stage::together(&stages, Frame::patch_step(), buffers.most_buffers(), buffers)?;
    }
    Ok(first_interface)
}

/// The kernels of a body whose nodes inside patches move with them: of each of its blocks that has such nodes.
pub(super) fn kernels_of(
    body: Entity,
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) -> Vec<Kernel> {
    let of_nodes = step.stages_of(body);
    let mut kernels = Vec::new();
    for kernel in step.blocks_of(body, world) {
        let Ok(Some(stages)) = step_of_block(kernel, body, &of_nodes, world) else { continue };
        let together = node_stage::patch_step(&stages.iter().collect::<Vec<_>>(), kernel.threads, buffers);
        let label = kernel.block.and_then(|block| world.get::<Label>(block));
        let label = label.map_or_else(|| together.label.clone(), |block| format!("{} of {}", together.label, block.0));
        kernels.push(Kernel { label, block: kernel.block, ..together });
    }
    kernels
}

/// What a step does with the nodes inside the patches of a kernel's block, if there are any; or why a workgroup has no
/// room for it.
fn step_of_block(
    kernel: &Kernel,
    body: Entity,
    of_nodes: &[&NodeStage],
    world: &World,
) -> Result<Option<Vec<NodeStage>>, String> {
    let Some(interior) = interior_rows(kernel, world)? else { return Ok(None) };
    let forces = NodeStage::of_patch(kernel.clone(), body, world).within(interior.clone());
    let nodes = of_nodes.iter().filter_map(|stage| stage.within(interior.clone())).map(NodeStage::in_patch);
    Ok(Some(forces.into_iter().chain(nodes).collect()))
}

/// The rows inside the patches of a kernel's block, if there are any; or why a workgroup has no room for what is done
/// with them.
fn interior_rows(kernel: &Kernel, world: &World) -> Result<Option<Range<u32>>, String> {
    let patches = kernel.block.and_then(|block| world.get::<Patches>(block));
    let (Some((_, block)), Some(patches)) = (block_of(kernel, world), patches) else { return Ok(None) };
    let Some(first) = patches.interior.iter().position(|&interior| interior > 0) else { return Ok(None) };
    // a number an invocation for what the guards count
    let memory = workgroup_memory(block.kind, patches) + 4 * BATCH_GROUPS * LANES;
    if memory > WEBGPU_WORKGROUP_MEMORY {
        return Err(format!(
            "it would need {memory} bytes of a workgroup's memory, and {WEBGPU_WORKGROUP_MEMORY} may be"
        ));
    }
    let first = patches.nodes[patches.starts[first] as usize];
    Ok(Some(first..first + patches.interior.iter().sum::<u32>()))
}
