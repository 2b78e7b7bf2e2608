//! The kernels of a step on a GPU.

use crate::backend::Buffers;
use crate::backend::kernel::Kernel;
use crate::backend::many_steps::{Dispatched, MOST_ELEMENTS, step_by_step, take_small_bodies};
use crate::backend::node_stage::{NodeStage, node_kernels};
use crate::backend::patch_step::take_inner_nodes;
use crate::systems::{OnDevice, Phase, System};
use bevy_ecs::prelude::*;

/// The kernels of each group of systems that share a pass (those of systems by themselves are groups, too), and how
/// each body's steps are dispatched. A kernel that sums forces and moves nodes is among those of the group that moves
/// the nodes.
pub(super) fn step_kernels(
    groups: &[Vec<&System>],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> (Vec<Vec<Kernel>>, Vec<Dispatched>) {
    let mut kernels: Vec<Vec<Kernel>> = Vec::new();
    let mut stages: Vec<Vec<NodeStage>> = Vec::new();
    for group in groups {
        kernels.push(match &group[0].device {
            OnDevice::Kernels(describe) => describe(world, buffers),
            OnDevice::None | OnDevice::Stages(_) => Vec::new(),
        });
        stages.push(stages_of(group, world, buffers));
    }
    let mut dispatched = match nothing_but_elements_then_nodes(groups) {
        Ok([elements, nodes]) => {
            let (small, how) =
                take_small_bodies(MOST_ELEMENTS, &mut kernels[elements], &mut stages[nodes], world, buffers);
            kernels[nodes] = small;
            how
        }
        Err(reason) => step_by_step(&reason, world),
    };
    match elements_then_nodes(groups) {
        Ok([elements, nodes]) => {
            let (elements, stages) = (&mut kernels[elements], &mut stages[nodes]);
            let inner = take_inner_nodes(elements, stages, &mut dispatched, world, buffers);
            kernels[nodes].extend(inner);
        }
        Err(reason) => dispatched.iter_mut().for_each(|body| body.inside_because.clone_from(&reason)),
    }
    for ((kernels, stages), group) in kernels.iter_mut().zip(stages).zip(groups) {
        kernels.extend(node_kernels(stages, group.len() > 1, buffers));
    }
    (kernels, dispatched)
}

/// What several systems do to nodes, in their order.
fn stages_of(systems: &[&System], world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let mut stages = Vec::new();
    for system in systems {
        if let OnDevice::Stages(describe) = &system.device {
            stages.extend(describe(world, buffers));
        }
    }
    stages
}

/// The places of element forces and of the pass over the nodes that follows at once; else what is in the way of moving
/// nodes as soon as the forces on them are known. What only looks does so between steps.
fn elements_then_nodes(groups: &[Vec<&System>]) -> Result<[usize; 2], String> {
    let mut places = (0..groups.len()).filter(|&place| !groups[place][0].observes);
    let elements = places.find(|&place| is_forces(&groups[place])).ok_or("it has no element forces")?;
    match places.next() {
        Some(nodes) if is_pass(&groups[nodes]) => Ok([elements, nodes]),
        Some(other) => Err(apart(&groups[other])),
        None => Err("nothing moves the nodes after element forces".into()),
    }
}

/// The same where a step is nothing else that changes anything; else what is in the way of taking steps one after the
/// other in a kernel.
fn nothing_but_elements_then_nodes(groups: &[Vec<&System>]) -> Result<[usize; 2], String> {
    let changing = groups.iter().filter(|group| !group[0].observes);
    match { changing }.find(|group| !is_forces(group) && !is_pass(group)) {
        Some(other) => Err(apart(other)),
        None => elements_then_nodes(groups),
    }
}

fn is_forces(group: &[&System]) -> bool {
    group[0].phase == Phase::ElementForces && group[0].device.is_some()
}

fn is_pass(group: &[&System]) -> bool {
    group.len() > 1 && group.iter().any(|system| system.phase == Phase::Integrate)
}

fn apart(group: &[&System]) -> String {
    format!("`{}` does not share a pass over the nodes", group[0].name)
}
