//! Nodes inside a patch move in the kernel that sums the patch's forces: of which bodies, and why not of others.
//! `shaders/patch_step.wgsl` is the kernel.

use super::Buffers;
use super::dispatch::{block_of, blocks_of};
use super::kernel::Kernel;
use super::node_stage::{self, Frame, NodeStage};
use super::patch_lists::{BATCH_GROUPS, WEBGPU_WORKGROUP_MEMORY, workgroup_memory};
use crate::components::{Corners, GROUP_ROWS, Label, Patches};
use crate::math::LANES;
use crate::shader;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// The first row of a body that is inside no patch, where those before it may move with their patches; or why they may
/// not. `elements` are the kernels of the element forces, and `stages` the one pass over the nodes that follows.
pub(super) fn first_interface(
    body: Entity,
    (elements, stages): (&[Kernel], &[NodeStage]),
    world: &World,
    buffers: &mut dyn Buffers,
) -> Result<u32, String> {
    let blocks = blocks_of(body, elements, world);
    let of_nodes: Vec<&NodeStage> = stages.iter().filter(|stage| stage.body() == body).collect();
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
    node_stage::may_share(&of_nodes, Frame::node_pass(), node_stage::MOST_SHARED, buffers)?;
    for kernel in blocks {
        let Some(memory) = memory_of(kernel, world) else { continue };
        if memory > WEBGPU_WORKGROUP_MEMORY {
            return Err(format!(
                "it would need {memory} bytes of a workgroup's memory, and {WEBGPU_WORKGROUP_MEMORY} may be"
            ));
        }
        let Some(step) = step_of(kernel, body, &of_nodes, world) else { continue };
        let step: Vec<&NodeStage> = step.iter().collect();
        node_stage::may_share(&step, Frame::patch_step(), buffers.most_buffers(), buffers)?;
    }
    Ok(first_interface)
}

/// The kernels of a body whose nodes inside patches move with their patch: one for each of its blocks that has some.
pub(super) fn kernels_of(
    body: Entity,
    (elements, stages): (&[Kernel], &[NodeStage]),
    world: &World,
    buffers: &mut dyn Buffers,
) -> Vec<Kernel> {
    let of_nodes: Vec<&NodeStage> = stages.iter().filter(|stage| stage.body() == body).collect();
    let mut kernels = Vec::new();
    for kernel in blocks_of(body, elements, world) {
        let Some(step) = step_of(kernel, body, &of_nodes, world) else { continue };
        let together = node_stage::patch_step(&step.iter().collect::<Vec<_>>(), kernel.threads, buffers);
        let label = kernel.block.and_then(|block| world.get::<Label>(block));
        let label = label.map_or_else(|| together.label.clone(), |block| format!("{} of {}", together.label, block.0));
        kernels.push(Kernel { label, block: kernel.block, ..together });
    }
    kernels
}

/// What a step does with the nodes inside the patches of a kernel's block, if there are any: the patch's forces, and
/// the stages of nodes.
fn step_of(kernel: &Kernel, body: Entity, of_nodes: &[&NodeStage], world: &World) -> Option<Vec<NodeStage>> {
    let interior = interior_rows(kernel, world)?;
    let forces = NodeStage::of_patch(kernel.clone(), body, world).within(interior.clone());
    let nodes = of_nodes.iter().filter_map(|stage| stage.within(interior.clone())).map(NodeStage::in_patch);
    Some(forces.into_iter().chain(nodes).collect())
}

/// The rows inside the patches of a kernel's block, if there are any.
fn interior_rows(kernel: &Kernel, world: &World) -> Option<Range<u32>> {
    let patches = world.get::<Patches>(kernel.block?)?;
    let first = patches.interior.iter().position(|&interior| interior > 0)?;
    let first = patches.nodes[patches.starts[first] as usize];
    Some(first..first + patches.interior.iter().sum::<u32>())
}

/// Bytes of a workgroup's memory for a patch of a kernel's block and its nodes, where patches have nodes inside.
fn memory_of(kernel: &Kernel, world: &World) -> Option<usize> {
    interior_rows(kernel, world)?;
    let (entity, block) = block_of(kernel, world)?;
    // a number an invocation for what the guards count
    Some(workgroup_memory(block.kind, world.get::<Patches>(entity)?) + 4 * BATCH_GROUPS * LANES)
}
