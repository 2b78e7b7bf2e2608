//! `element_forces`: what deformed elements exert on their corners. The kernel is put together from
//! `shaders/element_forces.wgsl`, the element's file, one file an effect of the material, and `patches.wgsl` or `two_pass.wgsl`.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::{BlockKernels, CornersAt};
use crate::backend::cpu::{BlockColumns, BlockLaw, Cpu, run_block, run_block_fast};
use crate::backend::kernel::Kernel;
use crate::backend::patch_lists::pack;
use crate::backend::step::{step_number, with_step};
use crate::components::*;
use crate::evaluation::{ElementState, node_count, with_element};
use crate::math::SimdScalar;
use crate::scene::schema::Inversion;
use crate::shader;
use bevy_ecs::prelude::*;

/// Displacements to element forces, block by block.
pub fn system() -> System {
    System::built_in(
        "element_forces",
        Phase::ElementForces,
        "strain, stress and nodal forces of every element",
        "bodies",
        |world| super::registry::count::<Block>(world, "element block", "element blocks"),
        element_forces,
    )
    .on_device(kernels)
}

/// What a run does not change of a block, but by removing elements.
type Fixed<'a> =
    (&'a Connectivity, &'a RestShape, Option<&'a FibreDirection>, Option<&'a NodalVolumeChange>, Option<&'a Patches>);

type BlockQuery<'a> = (
    &'a Block,
    Fixed<'a>,
    Option<&'a mut ViscousMemory>,
    &'a BlockLaw<f64>,
    Option<&'a BlockLaw<f32>>,
    &'a mut FirstInverted,
    Option<&'a OnInversion>,
    Option<&'a mut RemovalStep>,
);

fn element_forces(
    cpu: Res<Cpu>,
    clock: Res<Clock>,
    mut blocks: Query<BlockQuery>,
    mut bodies: Query<(&Authoring, &Displacement, &mut ElementForce)>,
) {
    for (authoring, displacement, mut force) in &mut bodies {
        for &entity in &authoring.blocks {
            let Ok((block, columns, memory, law, rounded, mut inverted, policy, removal)) = blocks.get_mut(entity)
            else {
                continue;
            };
            let (connectivity, shape, ..) = columns;
            let memory = memory.map(|m| &mut m.into_inner().0);
            let go = policy.is_some_and(|policy| policy.0 == Inversion::Remove);
            let patch = patch_groups(block.kind);
            let found = match (&mut force.0, rounded) {
                (Reals::F32(force), Some(law)) => {
                    let columns = of_kernel(block, columns, memory, displacement, go, force);
                    with_element!(block.kind, E => run_block_fast::<E>(&cpu, columns, law, patch))
                }
                (Reals::F64(force), _) => {
                    let columns = of_kernel(block, columns, memory, displacement, go, force);
                    with_element!(block.kind, E => run_block::<E, f64>(&cpu, columns, law, patch))
                }
                (Reals::F32(_), None) => false,
            };
            let is_inverted =
                |row: &usize| ElementState::of(block.kind, *row, connectivity, shape, displacement, law).is_inverted();
            match (policy, removal) {
                _ if !found => {}
                (Some(OnInversion(Inversion::Remove)), Some(mut removal)) => {
                    let gone = (0..block.count).filter(is_inverted);
                    gone.for_each(|row| remove(row, clock.step + 1, &mut removal));
                }
                // rounding may hide from f64 what the kernel saw
                _ if inverted[0] == u32::MAX => {
                    inverted[0] = (0..block.count).find(is_inverted).map_or(0, |row| row as u32);
                    inverted[1] = step_number(&clock);
                }
                _ => {}
            }
        }
    }
}

/// The columns as the kernel takes them.
fn of_kernel<'a, T: SimdScalar>(
    block: &Block,
    (connectivity, shape, fibres, means, patches): Fixed<'a>,
    memory: Option<&'a mut Reals>,
    displacement: &'a Displacement,
    inverted_go: bool,
    force: &'a mut [T],
) -> BlockColumns<'a, T> {
    BlockColumns {
        displacement: displacement.slice(),
        connectivity,
        rest_shape: shape.slice(),
        simple: block.simple,
        fibre_direction: fibres.map(|f| f.slice()),
        nodal_volume_change: means.map_or(&[], |means| means.slice()),
        memory: memory.map_or(&mut [], |m| m.slice_mut()),
        force: &mut force[block.force_offset..block.force_offset + block.force_length],
        patches,
        inverted_go,
    }
}

/// An element, which exerts nothing any more, goes before `step`.
fn remove(row: usize, step: u64, removal: &mut RemovalStep) {
    removal[row] = removal[row].min(u32::try_from(step).unwrap_or(u32::MAX));
}

/// One kernel for each block, of the fragments that its element type, its material and the scheme call for.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for block in BlockKernels::of_world(world, buffers) {
        // patches that no workgroup can sum are not there in a run on a GPU
        let packed = world.get::<Patches>(block.entity).and_then(|patches| pack(&block.block, patches).ok());
        let (kernel, corners) = match packed {
            Some(packed) => (block.patch_kernel("element_forces", &packed, buffers), CornersAt::Patch),
            None => (two_pass(&block), CornersAt::Columns),
        };
        let kernel = kernel
            .fragment(shader!("element_forces"))
            .bind(RestShape::NAME, buffers.column(block.entity, RestShape::NAME))
            .bind(ElementForce::NAME, buffers.column(block.block.body, ElementForce::NAME));
        let kernel = match world.get::<OnInversion>(block.entity) {
            Some(OnInversion(Inversion::Remove)) => kernel
                .fragment(shader!("remove_inverted"))
                .bind(RemovalStep::NAME, buffers.column(block.entity, RemovalStep::NAME)),
            _ => kernel
                .fragment(shader!("note_inverted"))
                .bind(FirstInverted::NAME, buffers.column(block.entity, FirstInverted::NAME)),
        };
        kernels.push(block.with_stress(with_step(kernel, world), corners, buffers));
    }
    kernels
}

fn two_pass(block: &BlockKernels) -> Kernel {
    let mut text = String::from("fn write_forces(element: u32, forces: array<vec3<f32>, NODES>) {\n");
    for corner in 0..node_count(block.block.kind) {
        text += &format!("    write_force(element, {corner}u, forces[{corner}]);\n");
    }
    let generated = block.generated("corners", text + "}\n");
    block.kernel("element_forces").fragment(shader!("two_pass")).fragment(generated)
}
