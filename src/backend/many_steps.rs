//! Small bodies take all steps of a submission in one dispatch of one workgroup: which do, and why others do not.
//! `shaders/many_steps.wgsl` is the kernel.

use super::Buffers;
use super::dispatch::{ElementsThenNodes, block_of};
use super::kernel::Kernel;
use super::node_stage::{self, Frame, NodeStage};
use super::patch_lists::{BATCH_GROUPS, WEBGPU_WORKGROUP_MEMORY, workgroup_memory};
use super::step::record_size;
use crate::components::{Block, Patches, Signals};
use crate::math::LANES;
use crate::shader;
use bevy_ecs::prelude::*;

/// Elements of the largest body that takes many steps in a dispatch: about a patch of tetrahedra, which one workgroup
/// sums in any case (docs/performance.md).
pub const MOST_ELEMENTS: usize = 1024;

/// Invocations of the largest workgroup: a core's registers are then all in use. More elements take turns.
const MOST_INVOCATIONS: usize = 512;

/// How many invocations the workgroup has that takes all steps of a body of at most so many elements; or why none does.
pub(super) fn workgroup_of(
    body: Entity,
    most_elements: usize,
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) -> Result<usize, String> {
    let width = width(&step.blocks_of(body, world), most_elements, world, buffers)?;
    let stages = whole_step(body, step, world);
    node_stage::together(
        &stages.iter().collect::<Vec<_>>(),
        Frame::many_steps(width),
        buffers.most_buffers(),
        buffers,
    )?;
    Ok(width)
}

/// The kernel that takes all steps of a body in a workgroup of so many invocations.
pub(super) fn kernel_of(
    body: Entity,
    workgroup: usize,
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) -> Kernel {
    let stages = whole_step(body, step, world);
    node_stage::many_steps(&stages.iter().collect::<Vec<_>>(), workgroup, buffers)
}

/// All that a step does with a body.
fn whole_step(body: Entity, step: ElementsThenNodes<'_>, world: &World) -> Vec<NodeStage> {
    let blocks = step.blocks_of(body, world).into_iter();
    let elements = blocks.map(|kernel| NodeStage::of_patch(kernel.clone(), body, world));
    elements.chain(step.stages_of(body).into_iter().cloned()).collect()
}

/// How many invocations the workgroup of a body has, or why many steps in a dispatch are not for it: all by count,
/// before anything is put together.
fn width(blocks: &[&Kernel], most_elements: usize, world: &World, buffers: &dyn Buffers) -> Result<usize, String> {
    const BATCH: usize = BATCH_GROUPS * LANES;
    let parts: Vec<(&Block, &Patches)> = blocks
        .iter()
        .filter_map(|kernel| block_of(kernel, world))
        .filter_map(|(entity, block)| Some((block, world.get::<Patches>(entity)?)))
        .collect();
    if blocks.is_empty() {
        return Err("it has no elements".into());
    }
    if parts.len() < blocks.len() || blocks.iter().any(|kernel| !kernel.fragments.contains(&shader!("patches"))) {
        return Err("its forces are not summed by patches".into());
    }
    let elements: usize = parts.iter().map(|(block, _)| block.count).sum();
    if elements > most_elements {
        return Err(format!(
            "it has {elements} elements, and {most_elements} may be: more are faster in many workgroups"
        ));
    }
    if let Some((_, patches)) = parts.iter().find(|(_, patches)| patches.count() != 1) {
        return Err(format!(
            "elements of a block are in {} patches: they are faster in as many workgroups",
            patches.count()
        ));
    }
    let most = MOST_INVOCATIONS.min(buffers.workgroup_invocations() / BATCH * BATCH).max(BATCH);
    let width = parts.iter().map(|(block, _)| block.count.next_multiple_of(BATCH)).max().unwrap_or(BATCH).min(most);
    // a number an invocation for what the guards count
    let signals = world.get_resource::<Signals>().map_or(0, record_size);
    let memory =
        parts.iter().map(|(block, patches)| workgroup_memory(block.kind, patches)).sum::<usize>() + 4 * width + signals;
    if memory > WEBGPU_WORKGROUP_MEMORY {
        return Err(format!(
            "it would need {memory} bytes of a workgroup's memory, and {WEBGPU_WORKGROUP_MEMORY} may be"
        ));
    }
    Ok(width)
}
