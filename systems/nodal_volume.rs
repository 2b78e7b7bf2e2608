//! `nodal_volume`: how much the volume around each node has changed. `shaders/nodal_volume.wgsl` and
//! `shaders/nodal_mean.wgsl` are its twins.

use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::cpu::{BlockLaw, Cpu, ROWS_A_TASK, run_volumes};
use crate::backend::kernel::{Fragment, Kernel, Uniform, uniform};
use crate::components::*;
use crate::elements::Tet4NodalPressure;
use crate::error::{Error, missing};
use crate::math::{LANES, Scalar, SimdScalar};
use crate::shader;
use bevy_ecs::prelude::*;

/// Means of θ over the elements around each node, by rest volume: what elements with averaged nodal pressure take their
/// pressure from. Each node sums its own elements in a fixed order: the same bits for any number of threads.
pub fn system() -> System {
    System::built_in(
        "nodal_volume",
        Phase::NodalMeans,
        "means of the change of volume around nodes",
        "elements with averaged nodal pressure",
        |world| super::registry::count::<NodalVolumeChange>(world, "element block", "element blocks"),
        nodal_volume,
    )
    .on_device(kernels)
}

type BlockQuery<'a> = (
    &'a Block,
    &'a Connectivity,
    &'a RestShape,
    &'a BlockCorners,
    &'a BlockLaw<f64>,
    Option<&'a BlockLaw<f32>>,
    &'a mut ElementVolume,
    &'a mut NodalVolumeChange,
);

fn nodal_volume(cpu: Res<Cpu>, mut blocks: Query<BlockQuery>, bodies: Query<&Displacement>) -> Result<(), Error> {
    for (block, connectivity, shape, corners, law, rounded, mut volumes, mut means) in &mut blocks {
        let Ok(displacement) = bodies.get(block.body) else {
            return Err(missing("a column of a body"));
        };
        match (&mut volumes.0, &mut means.0, rounded) {
            (Reals::F32(volumes), Reals::F32(means), Some(law)) => {
                means_of(
                    &cpu,
                    block,
                    (connectivity, shape.slice(), corners, displacement.slice()),
                    law,
                    volumes,
                    means,
                );
            }
            (Reals::F64(volumes), Reals::F64(means), _) => {
                means_of(
                    &cpu,
                    block,
                    (connectivity, shape.slice(), corners, displacement.slice()),
                    law,
                    volumes,
                    means,
                );
            }
            _ => {}
        }
    }
    Ok(())
}

/// θ of all nodes of a block, from displacements of its body's nodes (m).
pub(crate) fn means_of<T: SimdScalar>(
    cpu: &Cpu,
    block: &Block,
    (connectivity, shape, corners, u): (&Connectivity, &[T], &BlockCorners, &[T]),
    law: &BlockLaw<T>,
    volumes: &mut [T],
    means: &mut [T],
) {
    let groups = patch_groups(block.kind);
    run_volumes::<Tet4NodalPressure, T>(cpu, law, u, connectivity, shape, groups, volumes);
    let tasks = means.chunks_mut(ROWS_A_TASK).enumerate();
    cpu.for_each(tasks, |(task, rows)| {
        for (row, mean) in rows.iter_mut().enumerate() {
            *mean = mean_around(task * ROWS_A_TASK + row, corners, volumes);
        }
    });
}

/// Mean over a node's elements; 0 where all are gone or of another block.
fn mean_around<T: Scalar>(node: usize, corners: &BlockCorners, volumes: &[T]) -> T {
    let (mut volume, mut change) = (T::default(), T::default());
    for &element in &corners.elements[corners.starts[node] as usize..corners.starts[node + 1] as usize] {
        let at = element as usize / LANES * 2 * LANES + element as usize % LANES;
        volume += volumes[at];
        change += volumes[at + LANES];
    }
    if volume > T::default() { change / volume } else { T::default() }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Nodes {
    count: u32,
}
uniform!(Nodes { count });

/// Two kernels for each block: a thread an element, then a thread a node.
pub(super) fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for block in BlockKernels::of_world(world, buffers) {
        // elements of other kinds have none
        let Some(corners) = world.get::<BlockCorners>(block.entity) else { continue };
        let column = |buffers: &mut dyn Buffers, name| buffers.column(block.entity, name);
        kernels.push(
            block
                .kernel("element_volumes")
                .fragment(shader!("nodal_volume"))
                .bind(RestShape::NAME, column(buffers, RestShape::NAME))
                .bind(ElementVolume::NAME, column(buffers, ElementVolume::NAME)),
        );
        let nodes = Nodes { count: corners.starts.len().saturating_sub(1) as u32 };
        kernels.push(
            Kernel::new("nodal_means", "nodal_means")
                .fragment(shader!("nodal_mean"))
                .fragment(shader!("row"))
                .fragment(Fragment::new("generated: lanes", format!("const LANES: u32 = {LANES}u;\n")))
                .bind_uniform::<Nodes>("nodes", buffers.uniform("nodal_means".into(), &nodes.bytes()))
                .bind("starts", buffers.constants("starts of elements".into(), bytemuck::cast_slice(&corners.starts)))
                .bind("elements", buffers.constants("elements".into(), bytemuck::cast_slice(&corners.elements)))
                .bind(ElementVolume::NAME, column(buffers, ElementVolume::NAME))
                .bind(NodalVolumeChange::NAME, column(buffers, NodalVolumeChange::NAME))
                .threads(nodes.count),
        );
    }
    kernels
}
