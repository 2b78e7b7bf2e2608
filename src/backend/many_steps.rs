//! Small bodies take all steps of a submission in one dispatch of one workgroup: which do, and why others do not.
//! `shaders/many_steps.wgsl` is the kernel.

use super::Buffers;
use super::kernel::Kernel;
use super::node_stage::{self, Frame, NodeStage};
use super::patch_lists::{BATCH_GROUPS, WEBGPU_WORKGROUP_MEMORY, workgroup_memory};
use super::step::record_size;
use crate::components::{Authoring, Block, Label, Patches, Signals};
use crate::math::LANES;
use crate::shader;
use bevy_ecs::prelude::*;

/// Elements of the largest body that takes many steps in a dispatch: about a patch of tetrahedra, which one workgroup
/// sums in any case (docs/performance.md).
pub const MOST_ELEMENTS: usize = 1024;

/// Invocations of the largest workgroup: a core's registers are then all in use. More elements take turns.
const MOST_INVOCATIONS: usize = 512;

/// How the steps of a body get to the GPU.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Dispatched {
    /// The body.
    pub body: String,
    /// Whether all steps of a submission are one dispatch, of one workgroup.
    pub many_steps: bool,
    /// Why, or why not.
    pub because: String,
    /// How many nodes move in the kernel that sums the forces of the patch they are inside, the only one that has them.
    pub interior: u32,
    /// Why so many.
    pub interior_because: String,
}

impl Dispatched {
    fn new(body: String, many_steps: bool, because: String) -> Self {
        Self { body, many_steps, because, interior: 0, interior_because: String::new() }
    }
}

/// Of all bodies, where none takes many steps in a dispatch.
pub fn step_by_step(because: &str, world: &mut World) -> Vec<Dispatched> {
    let of_body = |(_, body)| Dispatched::new(body, false, because.to_owned());
    bodies(world).into_iter().map(of_body).collect()
}

/// The kernels of bodies of at most so many elements: takes what they put together out of `elements`, all kernels of
/// the element forces, and `stages`, all else that a step does.
pub fn take_small_bodies(
    most_elements: usize,
    elements: &mut Vec<Kernel>,
    stages: &mut Vec<NodeStage>,
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> (Vec<Kernel>, Vec<Dispatched>) {
    let (mut kernels, mut dispatched) = (Vec::new(), Vec::new());
    for (body, name) in bodies(world) {
        let is_of_body = |kernel: &Kernel| block_of(kernel, world).is_some_and(|(_, block)| block.body == body);
        let blocks: Vec<&Kernel> = elements.iter().filter(|kernel| is_of_body(kernel)).collect();
        let kernel = width(&blocks, most_elements, world, buffers).and_then(|width| {
            let step = whole_step(&blocks, body, stages, world);
            let step: Vec<&NodeStage> = step.iter().collect();
            let most = buffers.most_buffers();
            let pass = node_stage::together(&step, Frame::many_steps(width), most, buffers)?;
            Ok(node_stage::many_steps(pass, &step, width, buffers))
        });
        let (many_steps, because) = match kernel {
            Ok(kernel) => {
                elements.retain(|kernel| !is_of_body(kernel));
                stages.retain(|stage| stage.body() != body);
                let width = kernel.threads;
                kernels.push(kernel);
                (true, format!("one workgroup of {width} has room for it"))
            }
            Err(reason) => (false, reason),
        };
        dispatched.push(Dispatched::new(name, many_steps, because));
    }
    (kernels, dispatched)
}

/// All that a step does with a body: `blocks` are the kernels of its element forces.
fn whole_step(blocks: &[&Kernel], body: Entity, stages: &[NodeStage], world: &World) -> Vec<NodeStage> {
    let elements = blocks.iter().map(|kernel| NodeStage::of_patch((*kernel).clone(), body, world));
    elements.chain(stages.iter().filter(|stage| stage.body() == body).cloned()).collect()
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

/// The block that a kernel works on.
pub(super) fn block_of<'a>(kernel: &Kernel, world: &'a World) -> Option<(Entity, &'a Block)> {
    let entity = kernel.block?;
    Some((entity, world.get::<Block>(entity)?))
}

/// All bodies by name.
pub(super) fn bodies(world: &mut World) -> Vec<(Entity, String)> {
    let mut query = world.query_filtered::<(Entity, Option<&Label>), With<Authoring>>();
    let named =
        |(body, label): (Entity, Option<&Label>)| (body, label.map_or_else(|| body.to_string(), |l| l.0.clone()));
    let mut bodies: Vec<_> = query.iter(world).map(named).collect();
    bodies.sort_by(|(_, one), (_, other)| one.cmp(other));
    bodies
}
