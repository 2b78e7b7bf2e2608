//! `gather`: sums element forces at the nodes. `shaders/gather.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::backend::kernel::{Fragment, Kernel, Uniform, uniform};
use crate::components::*;
use crate::math::{LANES, Scalar};
use crate::shader;
use bevy_ecs::prelude::*;

/// Each node sums its own corners in a fixed order: the same bits for any number of threads, and no atomics. Also clears
/// the external forces, to which the loads of this step then add.
pub fn system() -> System {
    System::built_in(
        "gather",
        Phase::Gather,
        "sums element forces at the nodes",
        "bodies",
        |world| super::registry::count::<Corners>(world, "body with elements", "bodies with elements"),
        gather,
    )
    .on_device(kernels)
}

fn gather(cpu: Res<Cpu>, mut bodies: Query<(&Corners, &ElementForce, &mut InternalForce, Option<&mut ExternalForce>)>) {
    for (corners, element_force, mut internal, external) in &mut bodies {
        match &mut internal.0 {
            Reals::F32(internal) => sum_corners(&cpu, corners, element_force.slice(), internal),
            Reals::F64(internal) => sum_corners(&cpu, corners, element_force.slice(), internal),
        }
        if let Some(mut external) = external {
            external.bytes_mut().fill(0);
        }
    }
}

/// Forces of elements at their corners (N), summed at the nodes.
pub(crate) fn sum_corners<T: Scalar>(cpu: &Cpu, corners: &Corners, element_force: &[T], internal: &mut [T]) {
    if corners.stride == 1 {
        sum_at_stride::<T, 1>(cpu, corners, element_force, internal);
    } else {
        sum_at_stride::<T, LANES>(cpu, corners, element_force, internal);
    }
}

fn sum_at_stride<T: Scalar, const STRIDE: usize>(
    cpu: &Cpu,
    corners: &Corners,
    element_force: &[T],
    internal: &mut [T],
) {
    let tasks = internal.chunks_mut(3 * ROWS_A_TASK).enumerate();
    cpu.for_each(tasks, |(task, rows)| {
        for (row, force) in rows.chunks_exact_mut(3).enumerate() {
            let node = task * ROWS_A_TASK + row;
            let mut sum = [T::default(); 3];
            for &corner in &corners.corners[corners.starts[node] as usize..corners.starts[node + 1] as usize] {
                let from = &element_force[corner as usize..corner as usize + 2 * STRIDE + 1];
                for i in 0..3 {
                    sum[i] += from[i * STRIDE];
                }
            }
            force.copy_from_slice(&sum);
        }
    });
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Gather {
    count: u32,
}
uniform!(Gather { count });

/// One kernel for each body.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let bodies: Vec<(Entity, Corners, bool)> = world
        .query::<(Entity, &Corners, Option<&ExternalForce>)>()
        .iter(world)
        .map(|(body, corners, external)| (body, corners.clone(), external.is_some()))
        .collect();
    let mut kernels = Vec::new();
    for (body, corners, loaded) in bodies {
        let nodes = Gather { count: corners.starts.len().saturating_sub(1) as u32 };
        let kernel = Kernel::new("gather", "gather")
            .fragment(shader!("gather"))
            .fragment(shader!("row"))
            .fragment(Fragment::new("generated: stride", format!("const STRIDE: u32 = {}u;\n", corners.stride)))
            .bind_uniform::<Gather>("nodes", buffers.uniform("gather".into(), &nodes.bytes()))
            .bind("starts", buffers.constants("starts of corners".into(), bytemuck::cast_slice(&corners.starts)))
            .bind("corners", buffers.constants("corners".into(), bytemuck::cast_slice(&corners.corners)))
            .bind(ElementForce::NAME, buffers.column(body, ElementForce::NAME))
            .bind(InternalForce::NAME, buffers.column(body, InternalForce::NAME))
            .threads(nodes.count);
        kernels.push(if loaded {
            let external = buffers.column(body, ExternalForce::NAME);
            kernel.fragment(shader!("loads")).bind(ExternalForce::NAME, external)
        } else {
            kernel.fragment(Fragment::new("generated: no loads", "fn clear_loads(node: u32) {}\n"))
        });
    }
    kernels
}
