//! How a GPU takes bodies through a step: all steps of a submission in one dispatch, nodes inside patches with their
//! patch, or pass by pass. It is decided once, of the kernels and stages that systems describe, and is data: kernels
//! are made as it says, and `explain` prints it.

use super::Buffers;
use super::kernel::Kernel;
use super::node_stage::{self, NodeStage, rows_of};
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
    /// The kernels of its nodes, pass by pass: who shares them, and why no more do.
    pub node_kernels: Vec<NodeKernel>,
    /// Invocations of the workgroup that takes all steps; 0 where none does.
    #[serde(skip)]
    workgroup: usize,
}

/// A kernel of a body's nodes.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct NodeKernel {
    /// The pass of the plan that it is of.
    #[serde(skip)]
    pass: usize,
    /// How many stages are in it.
    #[serde(skip)]
    stages: usize,
    /// The systems that they are of.
    pub systems: Vec<String>,
    /// Why the next one is in another kernel; empty behind the last of a pass.
    pub because: String,
}

/// What bodies are taken through: the kernels of element forces, and what the pass of the nodes that follows does.
#[derive(Clone, Copy)]
pub struct ElementsThenNodes<'a> {
    /// Kernels, of any block.
    pub elements: &'a [Kernel],
    /// Stages, of any body, in their order.
    pub stages: &'a [NodeStage],
}

impl<'a> ElementsThenNodes<'a> {
    /// The kernels of a body's element forces.
    pub(super) fn blocks_of(self, body: Entity, world: &World) -> Vec<&'a Kernel> {
        self.elements.iter().filter(|kernel| body_of(kernel, world) == Some(body)).collect()
    }

    /// What is done to a body's nodes.
    pub(super) fn stages_of(self, body: Entity) -> Vec<&'a NodeStage> {
        self.stages.iter().filter(|stage| stage.body() == body).collect()
    }
}

/// The block that a kernel works on.
pub(super) fn block_of<'a>(kernel: &Kernel, world: &'a World) -> Option<(Entity, &'a Block)> {
    let entity = kernel.block?;
    Some((entity, world.get::<Block>(entity)?))
}

fn body_of(kernel: &Kernel, world: &World) -> Option<Entity> {
    Some(block_of(kernel, world)?.1.body)
}

/// Of all bodies, by name: none takes many steps in a dispatch, and no nodes move with their patch; and why not.
pub fn pass_by_pass(because: &str, interior_because: &str, world: &mut World) -> Vec<Dispatched> {
    let mut query = world.query_filtered::<(Entity, Option<&Label>), With<Authoring>>();
    let of_body = |(entity, label): (Entity, Option<&Label>)| Dispatched {
        entity,
        body: label.map_or_else(|| entity.to_string(), |label| label.0.clone()),
        many_steps: false,
        because: because.to_owned(),
        interior: 0,
        interior_because: interior_because.to_owned(),
        node_kernels: Vec::new(),
        workgroup: 0,
    };
    let mut bodies: Vec<Dispatched> = query.iter(world).map(of_body).collect();
    bodies.sort_by(|one, other| one.body.cmp(&other.body));
    bodies
}

/// Decides which bodies of at most so many elements take all steps of a submission in one dispatch, where `step` is all
/// that a step does.
pub fn decide_many_steps(
    most_elements: usize,
    dispatched: &mut [Dispatched],
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) {
    for body in dispatched {
        match many_steps::workgroup_of(body.entity, most_elements, step, world, buffers) {
            Ok(workgroup) => {
                (body.many_steps, body.workgroup) = (true, workgroup);
                body.because = format!("one workgroup of {workgroup} has room for it");
                body.interior_because = "all nodes move in the dispatch of all steps".into();
            }
            Err(reason) => body.because = reason,
        }
    }
}

/// Decides of which of the other bodies the nodes inside patches move with their patch.
pub fn decide_interior_nodes(
    dispatched: &mut [Dispatched],
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) {
    for body in dispatched.iter_mut().filter(|body| !body.many_steps) {
        match patch_step::first_interface(body.entity, step, world, buffers) {
            Ok(first) => (body.interior, body.interior_because) = (first, "no other patch has them".into()),
            Err(reason) => body.interior_because = reason,
        }
    }
}

/// Makes what was decided of a step: the kernels of forces alone; those that find forces and move nodes, of bodies that
/// take many steps before those of patches; and what is left to do to nodes.
pub fn grouped(
    dispatched: &[Dispatched],
    step: ElementsThenNodes<'_>,
    world: &World,
    buffers: &mut dyn Buffers,
) -> (Vec<Kernel>, Vec<Kernel>, Vec<NodeStage>) {
    let mut moving: Vec<Kernel> = Vec::new();
    for body in dispatched.iter().filter(|body| body.many_steps) {
        moving.push(many_steps::kernel_of(body.entity, body.workgroup, step, world, buffers));
    }
    for body in dispatched.iter().filter(|body| body.interior > 0) {
        moving.extend(patch_step::kernels_of(body.entity, step, world, buffers));
    }
    let of = |body: Option<Entity>| dispatched.iter().find(|dispatched| Some(dispatched.entity) == body);
    let is_alone = |kernel: &&Kernel| {
        let moves_nodes = |other: &Kernel| other.block.is_some() && other.block == kernel.block;
        !of(body_of(kernel, world)).is_some_and(|body| body.many_steps) && !moving.iter().any(moves_nodes)
    };
    let alone = step.elements.iter().filter(is_alone).cloned().collect();
    let left = |stage: &NodeStage| match of(Some(stage.body())) {
        Some(body) if body.many_steps => None,
        Some(body) if body.interior > 0 => stage.within(body.interior..rows_of(body.entity, world)),
        _ => Some(stage.clone()),
    };
    let left = step.stages.iter().filter_map(left).collect();
    (alone, moving, left)
}

/// Decides which kernels the nodes of each body have in a pass, whose `stages` are what [`grouped`] leaves: with `fuse`
/// as few as can be, else one a stage.
pub fn decide_node_kernels(
    dispatched: &mut [Dispatched],
    pass: usize,
    stages: &[NodeStage],
    fuse: bool,
    buffers: &mut dyn Buffers,
) {
    for of_body in node_stage::by_body(stages) {
        let Some(body) = dispatched.iter_mut().find(|body| body.entity == of_body[0].body()) else { continue };
        let mut rest = of_body.as_slice();
        for node_stage::Shared { stages, because } in node_stage::split(&of_body, fuse, buffers) {
            let (first, others) = rest.split_at(stages);
            let mut systems: Vec<String> = first.iter().map(|stage| stage.system().to_owned()).collect();
            systems.dedup();
            body.node_kernels.push(NodeKernel { pass, stages, systems, because });
            rest = others;
        }
    }
}

/// The kernels of nodes in a pass, as it was decided.
pub fn node_kernels(
    dispatched: &[Dispatched],
    pass: usize,
    stages: &[NodeStage],
    buffers: &mut dyn Buffers,
) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for of_body in node_stage::by_body(stages) {
        let body = dispatched.iter().find(|body| body.entity == of_body[0].body());
        let of_pass = body.into_iter().flat_map(|body| &body.node_kernels).filter(|kernel| kernel.pass == pass);
        kernels.extend(node_stage::kernels_of(&of_body, of_pass.map(|kernel| kernel.stages), buffers));
    }
    kernels
}
