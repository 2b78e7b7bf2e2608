//! `gather`: sums element forces at the nodes. `shaders/gather.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::components::*;
use crate::math::{LANES, Scalar};
use bevy_ecs::prelude::*;

/// Each node sums its own corners in a fixed order: the same bits for any number of threads, and no atomics. Also clears
/// the external forces, to which the loads of this step then add.
pub fn system() -> System {
    System::built_in(
        "gather",
        Phase::Gather,
        "sums element forces at the nodes",
        "bodies",
        |world| super::registry::count::<Corners>(world, "body with elements").map(|s| s.replace("bodys", "bodies")),
        gather,
    )
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

fn sum_corners<T: Scalar>(cpu: &Cpu, corners: &Corners, element_force: &[T], internal: &mut [T]) {
    let tasks = internal.chunks_mut(3 * ROWS_A_TASK).enumerate();
    cpu.for_each(tasks, |(task, rows)| {
        for (row, force) in rows.chunks_exact_mut(3).enumerate() {
            let node = task * ROWS_A_TASK + row;
            let mut sum = [T::default(); 3];
            for &corner in &corners.corners[corners.starts[node] as usize..corners.starts[node + 1] as usize] {
                let from = &element_force[corner as usize..corner as usize + 2 * LANES + 1];
                for i in 0..3 {
                    sum[i] += from[i * LANES];
                }
            }
            force.copy_from_slice(&sum);
        }
    });
}
