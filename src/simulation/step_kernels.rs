//! The kernels of a step on a GPU.

use crate::backend::Buffers;
use crate::backend::kernel::Kernel;
use crate::backend::many_steps::{Dispatched, MOST_ELEMENTS, step_by_step, take_small_bodies};
use crate::backend::node_stage::{NodeStage, node_kernels};
use crate::systems::{OnDevice, Phase, System};
use bevy_ecs::prelude::*;

/// The kernels of each group of systems that share a pass (those of systems by themselves are groups, too), and how each body's
/// steps are dispatched. A kernel that takes whole steps is among those of the group that moves the nodes.
pub(super) fn step_kernels(
    groups: &[Vec<&System>],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> (Vec<Vec<Kernel>>, Vec<Dispatched>) {
    let mut kernels: Vec<Vec<Kernel>> = Vec::new();
    let mut stages: Vec<Vec<NodeStage>> = Vec::new();
    for group in groups {
        kernels.push(match group[0].device {
            OnDevice::Kernels(describe) => describe(world, buffers),
            OnDevice::None | OnDevice::Stages(_) => Vec::new(),
        });
        stages.push(stages_of(group, world, buffers));
    }
    let dispatched = match elements_then_nodes(groups) {
        Ok([elements, nodes]) => {
            let (small, how) =
                take_small_bodies(MOST_ELEMENTS, &mut kernels[elements], &mut stages[nodes], world, buffers);
            kernels[nodes] = small;
            how
        }
        Err(reason) => step_by_step(&reason, world),
    };
    for ((kernels, stages), group) in kernels.iter_mut().zip(stages).zip(groups) {
        kernels.extend(node_kernels(stages, group.len() > 1, buffers));
    }
    (kernels, dispatched)
}

/// What several systems do to nodes, in their order.
fn stages_of(systems: &[&System], world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let mut stages = Vec::new();
    for system in systems {
        if let OnDevice::Stages(describe) = system.device {
            stages.extend(describe(world, buffers));
        }
    }
    stages
}

/// The places of the two groups where a step is the engine's element forces and one pass over the nodes, and nothing else that
/// changes anything; else what is in the way of taking steps one after the other in a kernel.
fn elements_then_nodes(groups: &[Vec<&System>]) -> Result<[usize; 2], String> {
    let is_forces = |system: &System| system.phase == Phase::ElementForces && system.device.is_some();
    let is_pass = |group: &[&System]| group.len() > 1 && group.iter().any(|system| system.phase == Phase::Integrate);
    let mut found = [None; 2];
    for (place, group) in groups.iter().enumerate().filter(|(_, group)| !group[0].observes) {
        match (is_forces(group[0]), is_pass(group)) {
            (true, _) => found[0] = Some(place),
            (_, true) => found[1] = Some(place),
            _ => return Err(format!("`{}` does not share a pass over the nodes", group[0].name)),
        }
    }
    match found {
        [Some(elements), Some(nodes)] => Ok([elements, nodes]),
        _ => Err("nothing moves the nodes after element forces".into()),
    }
}
