//! Nodes inside a patch move in the kernel that sums the patch's forces: of which bodies, and why not of others.
//! `shaders/patch_step.wgsl` is the kernel.

use super::Buffers;
use super::kernel::Kernel;
use super::many_steps::{Dispatched, block_of, bodies};
use super::node_stage::{self, Frame, NodeStage};
use super::patch_lists::{BATCH_GROUPS, WEBGPU_WORKGROUP_MEMORY, workgroup_memory};
use crate::components::{Corners, GROUP_ROWS, Label, Patches};
use crate::math::LANES;
use crate::shader;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// The kernels of blocks whose patches move the nodes inside them: takes what they put together out of `elements`, all
/// kernels of the element forces, and leaves the other nodes to `stages`, the one pass over the nodes that follows.
/// `dispatched`, all bodies, hears of it.
pub fn take_interior_nodes(
    elements: &mut Vec<Kernel>,
    stages: &mut Vec<NodeStage>,
    dispatched: &mut [Dispatched],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for ((body, _), told) in bodies(world).into_iter().zip(dispatched) {
        if told.many_steps {
            told.interior_because = "all nodes move in the dispatch of all steps".into();
            continue;
        }
        match of_body(body, elements, stages, world, buffers) {
            Ok((taken, first_interface)) => {
                told.interior = first_interface;
                told.interior_because = "no other patch has them".into();
                elements.retain(|kernel| !taken.iter().any(|taken| taken.block == kernel.block));
                let others = |stage: NodeStage| match stage.body() == body {
                    true => stage.within(first_interface..node_stage::rows_of(body, world)),
                    false => Some(stage),
                };
                *stages = std::mem::take(stages).into_iter().filter_map(others).collect();
                kernels.extend(taken);
            }
            Err(reason) => told.interior_because = reason,
        }
    }
    kernels
}

/// The kernels of the body's blocks that have nodes inside their patches, and the first row that is in none.
fn of_body(
    body: Entity,
    elements: &[Kernel],
    stages: &[NodeStage],
    world: &World,
    buffers: &mut dyn Buffers,
) -> Result<(Vec<Kernel>, u32), String> {
    let is_of_body = |kernel: &&Kernel| block_of(kernel, world).is_some_and(|(_, block)| block.body == body);
    let blocks: Vec<&Kernel> = elements.iter().filter(is_of_body).collect();
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
    node_stage::together(&of_nodes, Frame::node_pass(), node_stage::MOST_SHARED, buffers)?;
    let most = buffers.most_buffers();
    let mut steps = Vec::new();
    for kernel in blocks {
        let Some(interior) = interior_rows(kernel, world)? else { continue };
        let forces = NodeStage::of_patch(kernel.clone(), body, world).within(interior.clone());
        let nodes = of_nodes.iter().filter_map(|stage| stage.within(interior.clone())).map(NodeStage::in_patch);
        let step: Vec<NodeStage> = forces.into_iter().chain(nodes).collect();
        let pass = node_stage::together(&step.iter().collect::<Vec<_>>(), Frame::patch_step(), most, buffers)?;
        steps.push((kernel, step, pass));
    }
    let mut put_together = |(kernel, step, pass): (&Kernel, Vec<NodeStage>, _)| {
        let stages: Vec<&NodeStage> = step.iter().collect();
        let together = node_stage::patch_step(pass, &stages, kernel.threads, buffers);
        let label = kernel.block.and_then(|block| world.get::<Label>(block));
        let label = label.map_or_else(|| together.label.clone(), |block| format!("{} of {}", together.label, block.0));
        Kernel { label, block: kernel.block, ..together }
    };
    Ok((steps.into_iter().map(&mut put_together).collect(), first_interface))
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
