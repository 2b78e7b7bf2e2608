//! What a system is on the host, and what on a GPU.

use super::node_pass::{NodePass, node_pass};
use super::node_system::NodeRows;
use crate::backend::Buffers;
use crate::backend::kernel::Kernel;
use crate::backend::node_stage::{DescribeStages, node_kernels};
use crate::error::Error;
use bevy_ecs::prelude::*;

/// A system on the host: what the CPU backend runs, and what custom systems are on both backends.
pub type HostSystem = Box<dyn System<In = (), Out = Result<(), Error>>>;

/// What a system is on the host.
pub enum OnHost {
    /// A system by itself.
    System(Box<dyn Fn() -> HostSystem + Send + Sync>),
    /// Something to each node, in passes that it may share with its neighbours in the step.
    Nodes(NodeRows),
    /// A system by itself that finds the forces of elements patch by patch: nodes inside a patch may move with it.
    Elements(Box<dyn Fn() -> HostSystem + Send + Sync>),
}

impl OnHost {
    /// The system of a name, by itself in a pass if it is one of nodes.
    pub fn alone(&self, name: &str, world: &mut World) -> HostSystem {
        match self {
            OnHost::System(make) | OnHost::Elements(make) => make(),
            OnHost::Nodes(rows) => {
                let pass = NodePass::new([(name, *rows)], world);
                node_pass(pass, world)
            }
        }
    }

    /// What it does to each node, if that is what it does.
    pub fn nodes(&self) -> Option<NodeRows> {
        match self {
            OnHost::Nodes(rows) => Some(*rows),
            OnHost::System(_) | OnHost::Elements(_) => None,
        }
    }
}

/// Describes the kernels of a system for a world, bound to buffers.
pub type DescribeKernels = fn(&mut World, &mut dyn Buffers) -> Vec<Kernel>;

/// What a system does on a GPU.
#[derive(Clone)]
pub enum OnDevice {
    /// Nothing: it runs on the host.
    None,
    /// Kernels of its own.
    Kernels(DescribeKernels),
    /// Something to each node, in kernels that it may share with its neighbours in the step.
    Stages(DescribeStages),
}

impl OnDevice {
    /// Whether there is anything.
    pub fn is_some(&self) -> bool {
        !matches!(self, OnDevice::None)
    }

    /// The kernels of one system by itself.
    pub fn kernels(&self, world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
        match self {
            OnDevice::None => Vec::new(),
            OnDevice::Kernels(kernels) => kernels(world, buffers),
            OnDevice::Stages(stages) => node_kernels(stages(world, buffers), false, buffers),
        }
    }
}
