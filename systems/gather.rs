//! `gather`: sums element forces at the nodes. `shaders/gather.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::stage::Stage;
use super::system::{Phase, System};
use crate::backend::cpu::{Asked, Cpu, NodeColumns, ROWS_A_TASK};
use crate::components::*;
use crate::math::{LANES, Scalar, SimdScalar};
use crate::shader;
use bevy_ecs::prelude::*;

/// Each node sums its own corners in a fixed order: the same bits for any number of threads, and no atomics. Also
/// clears the external forces, to which the loads of this step then add.
pub fn system() -> System {
    System::built_in_nodes::<Corners>("gather", Phase::Gather, "sums element forces at the nodes", "bodies", |world| {
        super::registry::count::<Corners>(world, "body with elements", "bodies with elements")
    })
    .with_twin::<Corners>("gather", shader!("gather"), |_, stage| stage)
}

impl NodeSystem for Corners {
    type Columns = (&'static ElementForce, &'static mut InternalForce, Option<&'static mut ExternalForce>);
    type Prepared = ();
    const SUMS_FORCES: bool = true;

    fn stages(&self, _: Entity, _: &World) -> Vec<Stage> {
        let stage = Stage::default().integers("corners", &in_one(self));
        vec![stage.text("generated: stride", format!("const STRIDE: u32 = {}u;\n", self.stride))]
    }

    fn prepare(&self, _: &Before<'_>) {}

    /// None: the forces of elements are counted element by element.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        nodes.writes(Asked::InternalForce);
        sum_at(self, nodes.element_force, nodes.first, nodes.internal);
        if nodes.external.is_some()
            && let Some(external) = nodes.external_force_mut()
        {
            external.fill(T::default());
        }
    }
}

/// Forces of elements at their corners (N), summed at the nodes.
pub(crate) fn sum_corners<T: Scalar>(cpu: &Cpu, corners: &Corners, element_force: &[T], internal: &mut [T]) {
    let tasks = internal.chunks_mut(3 * ROWS_A_TASK).enumerate();
    cpu.for_each(tasks, |(task, rows)| sum_at(corners, element_force, task * ROWS_A_TASK, rows));
}

/// The sums of the nodes from row `first` on that a column has.
fn sum_at<T: Scalar>(corners: &Corners, element_force: &[T], first: usize, internal: &mut [T]) {
    if corners.stride == 1 {
        sum_at_stride::<T, 1>(corners, element_force, first, internal);
    } else {
        sum_at_stride::<T, LANES>(corners, element_force, first, internal);
    }
}

fn sum_at_stride<T: Scalar, const STRIDE: usize>(
    corners: &Corners,
    element_force: &[T],
    first: usize,
    internal: &mut [T],
) {
    let rows = internal.len() / 3;
    let ends = corners.starts[first..=first + rows].windows(2);
    for (force, ends) in internal.chunks_exact_mut(3).zip(ends) {
        let mut sum = [T::default(); 3];
        for &corner in &corners.corners[ends[0] as usize..ends[1] as usize] {
            let from = &element_force[corner as usize..corner as usize + 2 * STRIDE + 1];
            for i in 0..3 {
                sum[i] += from[i * STRIDE];
            }
        }
        force.copy_from_slice(&sum);
    }
}

/// The corners of each node behind where they begin, and the end: a kernel has few buffers.
fn in_one(corners: &Corners) -> Vec<u32> {
    let first = corners.starts.len() as u32;
    corners.starts.iter().map(|start| first + start).chain(corners.corners.iter().copied()).collect()
}
