//! `observe`: probes, energies, fields and guards, in the steps in which something is due. See
//! [`Observer`](crate::observation::Observer). On a GPU the guards have kernels, `shaders/guard_nodes.wgsl` and
//! `shaders/guard_elements.wgsl`, that run when they are due only.

use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::kernel::{Kernel, Uniform, uniform};
use crate::components::*;
use crate::error::Error;
use crate::observation::Observer;
use crate::shader;
use bevy_ecs::prelude::*;

/// Reads only. On the GPU it brings to the host what is due, and nothing in all other steps.
pub fn system() -> System {
    let observe = System::built_in(
        "observe",
        Phase::Observe,
        "probes, energies, fields and guards, when they are due",
        "every scene",
        |_| Some("guards look for inverted elements and lost numbers".into()),
        observe,
    );
    System { observes: true, ..observe }
}

fn observe(world: &mut World) -> Result<(), Error> {
    let step = world.resource::<Clock>().step;
    world.resource_scope(|world, mut observer: Mut<Observer>| {
        // asked at every step on the CPU; on the GPU only when something is due
        if observer.next_due(step.saturating_sub(1)) == step { observer.observe(world) } else { Ok(()) }
    })
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct GuardNodes {
    count: u32,
}
uniform!(GuardNodes { count });

/// Rows that share a sum of the guards: a workgroup's.
const ROWS_A_SUM: usize = 64;

/// Gives bodies and blocks the columns that the guards' kernels write.
pub fn add_guard_columns(world: &mut World) {
    let bodies: Vec<(Entity, usize)> =
        world.query::<(Entity, &Mass)>().iter(world).map(|(e, m)| (e, m.len())).collect();
    for (body, count) in bodies {
        let middle = MiddleDisplacement(Reals::zeros(Precision::F32, 3 * count));
        world.entity_mut(body).insert((middle, NodeSums(vec![0; 4 * count.div_ceil(ROWS_A_SUM)])));
    }
    let blocks: Vec<(Entity, usize)> =
        world.query::<(Entity, &Block)>().iter(world).map(|(e, b)| (e, b.count)).collect();
    for (block, count) in blocks {
        world.entity_mut(block).insert(ElementSums(vec![0; 4 * count.div_ceil(ROWS_A_SUM)]));
    }
}

/// What the guards look at, summed on the device: nodes, then elements in the middle of the last step.
pub fn guard_kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let bodies: Vec<(Entity, usize)> =
        world.query::<(Entity, &Mass)>().iter(world).map(|(e, m)| (e, m.len())).collect();
    let mut kernels = Vec::new();
    for (body, count) in bodies {
        let nodes = GuardNodes { count: count as u32 };
        let kernel = Kernel::new("guard_nodes", "guard_nodes")
            .fragment(shader!("guard_nodes"))
            .fragment(shader!("row"))
            .bind_uniform::<GuardNodes>("nodes", buffers.uniform("guard_nodes".into(), &nodes.bytes()))
            .threads(nodes.count);
        let columns =
            [Mass::NAME, Displacement::NAME, DisplacementIncrement::NAME, MiddleDisplacement::NAME, NodeSums::NAME];
        kernels.push(columns.iter().fold(kernel, |kernel, &name| kernel.bind(name, buffers.column(body, name))));
    }
    let means = super::nodal_volume::kernels(world, buffers);
    kernels.extend(means.into_iter().map(|kernel| in_the_middle(kernel, world, buffers)));
    for block in BlockKernels::of_world(world, buffers) {
        let kernel = block
            .kernel("guard_elements")
            .fragment(shader!("guard_elements"))
            .bind(RestShape::NAME, buffers.column(block.entity, RestShape::NAME))
            .bind(ElementSums::NAME, buffers.column(block.entity, ElementSums::NAME));
        let kernel = block.with_energy(kernel, buffers);
        kernels.push(in_the_middle(kernel, world, buffers));
    }
    kernels
}

/// The kernel with displacements in the middle of the last step in place of those at its end.
fn in_the_middle(mut kernel: Kernel, world: &mut World, buffers: &mut dyn Buffers) -> Kernel {
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<MiddleDisplacement>>().iter(world).collect();
    for body in bodies {
        let (end, middle) = (buffers.column(body, Displacement::NAME), buffers.column(body, MiddleDisplacement::NAME));
        for (name, buffer) in &mut kernel.bindings {
            if *name == Displacement::NAME && *buffer == end {
                *buffer = middle;
            }
        }
    }
    kernel
}
