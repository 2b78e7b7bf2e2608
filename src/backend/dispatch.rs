//! How a GPU takes bodies through a step: all steps of a submission in one dispatch, nodes inside patches with their
//! patch, or pass by pass. It is decided once, of kernels and stages as systems describe them, and is data: who makes
//! the kernels follows it, and `explain` prints it.

use super::Buffers;
use super::kernel::Kernel;
use super::node_stage::{NodeStage, rows_of};
use super::{many_steps, patch_step};
use crate::components::{Authoring, Block, Label};
use bevy_ecs::prelude::*;

/// How a body is taken through a step.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Dispatched {
    #[serde(skip)]
    entity: Entity,
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
    /// Invocations of the workgroup that takes all steps; 0 where none does.
    #[serde(skip)]
    workgroup: usize,
}

/// Of all bodies, by name: none takes many steps in a dispatch, and no nodes move with their patch; and why.
pub fn step_by_step(because: &str, interior_because: &str, world: &mut World) -> Vec<Dispatched> {
    let mut query = world.query_filtered::<(Entity, Option<&Label>), With<Authoring>>();
    let of_body = |(entity, label): (Entity, Option<&Label>)| Dispatched {
        entity,
        body: label.map_or_else(|| entity.to_string(), |label| label.0.clone()),
        many_steps: false,
        because: because.to_owned(),
        interior: 0,
        interior_because: interior_because.to_owned(),
        workgroup: 0,
    };
    let mut bodies: Vec<Dispatched> = query.iter(world).map(of_body).collect();
    bodies.sort_by(|one, other| one.body.cmp(&other.body));
    bodies
}

/// Decides which bodies of at most so many elements take all steps of a submission in one dispatch. `elements` are the
/// kernels of the element forces, and `stages` all else that a step does.
pub fn decide_many_steps(
    most_elements: usize,
    dispatched: &mut [Dispatched],
    (elements, stages): (&[Kernel], &[NodeStage]),
    world: &World,
    buffers: &mut dyn Buffers,
) {
    for body in dispatched {
        match many_steps::workgroup_of(body.entity, most_elements, (elements, stages), world, buffers) {
            Ok(workgroup) => {
                (body.many_steps, body.workgroup) = (true, workgroup);
                body.because = format!("one workgroup of {workgroup} has room for it");
                body.interior_because = "all nodes move in the dispatch of all steps".into();
            }
            Err(reason) => body.because = reason,
        }
    }
}

/// Decides of which of the other bodies the nodes inside patches move with their patch. `elements` are the kernels of
/// the element forces, and `stages` the one pass over the nodes that follows.
pub fn decide_interior_nodes(
    dispatched: &mut [Dispatched],
    (elements, stages): (&[Kernel], &[NodeStage]),
    world: &World,
    buffers: &mut dyn Buffers,
) {
    for body in dispatched.iter_mut().filter(|body| !body.many_steps) {
        match patch_step::first_interface(body.entity, (elements, stages), world, buffers) {
            Ok(first) => (body.interior, body.interior_because) = (first, "no other patch has them".into()),
            Err(reason) => body.interior_because = reason,
        }
    }
}

/// Kernels of element forces that do nothing but find them; and those that move nodes, too: of bodies that take many
/// steps, then of patches with nodes inside. `stages` are the pass over the nodes that follows.
pub fn grouped(
    dispatched: &[Dispatched],
    (elements, stages): (&[Kernel], &[NodeStage]),
    world: &World,
    buffers: &mut dyn Buffers,
) -> [Vec<Kernel>; 2] {
    let of_small = |body: &Dispatched, buffers: &mut dyn Buffers| {
        many_steps::kernel_of(body.entity, body.workgroup, (elements, stages), world, buffers)
    };
    let small = dispatched.iter().filter(|body| body.many_steps);
    let mut moving: Vec<Kernel> = small.map(|body| of_small(body, buffers)).collect();
    for body in dispatched.iter().filter(|body| body.interior > 0) {
        moving.extend(patch_step::kernels_of(body.entity, (elements, stages), world, buffers));
    }
    let alone = |kernel: &&Kernel| {
        let takes_all = |body: &Dispatched| body.many_steps && block_of(kernel, world).is_some_and(|(_, of)| of.body == body.entity);
        let moves = |other: &Kernel| other.block.is_some() && other.block == kernel.block;
        !dispatched.iter().any(takes_all) && !moving.iter().any(moves)
    };
    let alone = elements.iter().filter(alone).cloned().collect();
    [alone, moving]
}

/// What of stages these kernels leave to do.
pub fn left_to_nodes(dispatched: &[Dispatched], stages: &[NodeStage], world: &World) -> Vec<NodeStage> {
    let left = |stage: &NodeStage| match dispatched.iter().find(|body| body.entity == stage.body()) {
        Some(body) if body.many_steps => None,
        Some(body) if body.interior > 0 => stage.within(body.interior..rows_of(body.entity, world)),
        _ => Some(stage.clone()),
    };
    stages.iter().filter_map(left).collect()
}

/// The block that a kernel works on.
pub(super) fn block_of<'a>(kernel: &Kernel, world: &'a World) -> Option<(Entity, &'a Block)> {
    let entity = kernel.block?;
    Some((entity, world.get::<Block>(entity)?))
}

/// The kernels of a body's element forces.
pub(super) fn blocks_of<'a>(body: Entity, elements: &'a [Kernel], world: &World) -> Vec<&'a Kernel> {
    let is_of_body = |kernel: &&Kernel| block_of(kernel, world).is_some_and(|(_, block)| block.body == body);
    elements.iter().filter(is_of_body).collect()
}
