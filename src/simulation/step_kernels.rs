//! The kernels of a step on a GPU, as its plan says.

use super::plan::Plan;
use crate::backend::Buffers;
use crate::backend::dispatch::{self, Dispatched, ElementsThenNodes};
use crate::backend::kernel::Kernel;
use crate::backend::many_steps::MOST_ELEMENTS;
use crate::backend::node_stage::NodeStage;
use crate::systems::{OnDevice, System};
use bevy_ecs::prelude::*;

/// The kernels of each pass of a plan, whose `systems` stand as in the plan, and how each body is taken through them:
/// as the plan says, or as it is decided here where no GPU runs it. A kernel that sums forces and moves nodes is among
/// those of the pass that moves the nodes.
pub(super) fn step_kernels(
    plan: &Plan,
    systems: &[&System],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> (Vec<Vec<Kernel>>, Vec<Dispatched>) {
    let (mut kernels, mut stages) = described(plan, systems, world, buffers);
    let is_decided = plan.dispatched.is_some();
    let mut dispatched = match &plan.dispatched {
        Some(dispatched) => dispatched.clone(),
        None => decided(plan, &kernels, &stages, world, buffers),
    };
    if let Ok([elements, nodes]) = plan.elements_then_nodes() {
        let step = ElementsThenNodes { elements: &kernels[elements], stages: &stages[nodes] };
        let (alone, moving, left) = dispatch::grouped(&dispatched, step, world, buffers);
        (kernels[elements], kernels[nodes], stages[nodes]) = (alone, moving, left);
    }
    for (place, ((kernels, stages), pass)) in kernels.iter_mut().zip(&stages).zip(plan.passes(true)).enumerate() {
        if !is_decided {
            let fuse = pass.systems.len() > 1;
            dispatch::decide_node_kernels(&mut dispatched, place, stages, fuse, buffers);
        }
        kernels.extend(dispatch::node_kernels(&dispatched, place, stages, buffers));
    }
    (kernels, dispatched)
}

/// Kernels and stages as systems describe them, pass by pass.
fn described(
    plan: &Plan,
    systems: &[&System],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> (Vec<Vec<Kernel>>, Vec<Vec<NodeStage>>) {
    let (mut kernels, mut stages) = (Vec::new(), Vec::new());
    for pass in plan.passes(true) {
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
    (kernels, stages)
}

/// How a GPU would take each body through a plan.
fn decided(
    plan: &Plan,
    kernels: &[Vec<Kernel>],
    stages: &[Vec<NodeStage>],
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> Vec<Dispatched> {
    let (whole, part) = (plan.nothing_but_elements_then_nodes(), plan.elements_then_nodes());
    let [not_whole, not_part] = [whole, part].map(|places| places.err().unwrap_or_default());
    let mut dispatched = dispatch::pass_by_pass(not_whole, not_part, world);
    let of = |[elements, nodes]: [usize; 2]| ElementsThenNodes { elements: &kernels[elements], stages: &stages[nodes] };
    if let Ok(places) = whole {
        dispatch::decide_many_steps(MOST_ELEMENTS, &mut dispatched, of(places), world, buffers);
    }
    if let Ok(places) = part {
        dispatch::decide_interior_nodes(&mut dispatched, of(places), world, buffers);
    }
    dispatched
}
