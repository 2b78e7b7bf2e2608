//! The kernels of a step on a GPU, as its plan says.

use super::plan::Plan;
use crate::backend::Buffers;
use crate::backend::kernel::Kernel;
use crate::backend::many_steps::{Dispatched, MOST_ELEMENTS, step_by_step, take_small_bodies};
use crate::backend::node_stage::{NodeStage, node_kernels};
use crate::backend::patch_step::take_interior_nodes;
use crate::systems::{OnDevice, System};
use bevy_ecs::prelude::*;

/// The kernels of each pass of a plan, whose `systems` stand as in the plan, and how each body's steps are dispatched.
/// A kernel that sums forces and moves nodes is among those of the pass that moves the nodes.
pub(super) fn step_kernels(
    plan: &Plan,
    systems: &[&System],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> (Vec<Vec<Kernel>>, Vec<Dispatched>) {
    let mut kernels: Vec<Vec<Kernel>> = Vec::new();
    let mut stages: Vec<Vec<NodeStage>> = Vec::new();
    let passes = plan.passes(true);
    for pass in passes {
        let (mut of_pass, mut to_nodes) = (Vec::new(), Vec::new());
        for &place in &pass.systems {
            match &systems[place].device {
                OnDevice::None => {}
                _ if !plan.systems[place].on_device => {}
                OnDevice::Kernels(describe) => of_pass.extend(describe(world, buffers)),
                OnDevice::Stages(describe) => to_nodes.extend(describe(world, buffers)),
            }
        }
        kernels.push(of_pass);
        stages.push(to_nodes);
    }
    let mut dispatched = match plan.nothing_but_elements_then_nodes() {
        Ok([elements, nodes]) => {
            let (small, how) =
                take_small_bodies(MOST_ELEMENTS, &mut kernels[elements], &mut stages[nodes], world, buffers);
            kernels[nodes] = small;
            how
        }
        Err(reason) => step_by_step(reason, world),
    };
    match plan.elements_then_nodes() {
        Ok([elements, nodes]) => {
            let (elements, stages) = (&mut kernels[elements], &mut stages[nodes]);
            let inner = take_interior_nodes(elements, stages, &mut dispatched, world, buffers);
            kernels[nodes].extend(inner);
        }
        Err(reason) => dispatched.iter_mut().for_each(|body| reason.clone_into(&mut body.interior_because)),
    }
    for ((kernels, stages), pass) in kernels.iter_mut().zip(stages).zip(passes) {
        kernels.extend(node_kernels(stages, pass.systems.len() > 1, buffers));
    }
    (kernels, dispatched)
}
