//! `element_forces`: what deformed elements exert on their corners. The kernel is put together from
//! `shaders/element_forces.wgsl`, the element's file, and one file an effect of the material.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::cpu::{BlockColumns, BlockLaw, Cpu, run_block};
use crate::backend::kernel::Kernel;
use crate::components::*;
use crate::elements::{Element, Hex8, Tet4};
use crate::evaluation::node_count;
use crate::math::{LANES, SimdScalar};
use crate::scene::schema::ElementKind;
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

type BlockQuery<'a> = (
    &'a Block,
    &'a Connectivity,
    &'a RestShape,
    Option<&'a FibreDirection>,
    Option<&'a mut ViscousMemory>,
    AnyOf<(&'a BlockLaw<f32>, &'a BlockLaw<f64>)>,
    &'a mut FirstInverted,
);

fn element_forces(
    cpu: Res<Cpu>,
    mut blocks: Query<BlockQuery>,
    mut bodies: Query<(&Authoring, &Displacement, &mut ElementForce)>,
) {
    for (authoring, displacement, mut force) in &mut bodies {
        for &entity in &authoring.blocks {
            let Ok((block, connectivity, shape, fibres, memory, law, mut inverted)) = blocks.get_mut(entity) else {
                continue;
            };
            let memory = memory.map(|m| &mut m.into_inner().0);
            let found = match (&mut force.0, law) {
                (Reals::F32(force), (Some(law), _)) => {
                    forces_of(&cpu, block, connectivity, shape, fibres, memory, law, displacement, force)
                }
                (Reals::F64(force), (_, Some(law))) => {
                    forces_of(&cpu, block, connectivity, shape, fibres, memory, law, displacement, force)
                }
                _ => false,
            };
            if found && inverted[0] == u32::MAX {
                inverted[0] = first_inverted(block, connectivity, shape, displacement);
            }
        }
    }
}

fn forces_of<T: SimdScalar>(
    cpu: &Cpu,
    block: &Block,
    connectivity: &[u32],
    shape: &RestShape,
    fibres: Option<&FibreDirection>,
    memory: Option<&mut Reals>,
    law: &BlockLaw<T>,
    displacement: &Displacement,
    force: &mut [T],
) -> bool {
    let groups = block.count.div_ceil(LANES);
    let nodes = match block.kind {
        ElementKind::Tet4 => Tet4::NODES,
        ElementKind::Hex8 => Hex8::NODES,
    };
    let columns = BlockColumns {
        displacement: displacement.slice(),
        connectivity,
        rest_shape: shape.slice(),
        fibre_direction: fibres.map(|f| f.slice()),
        memory: memory.map_or(&mut [], |m| m.slice_mut()),
        force: &mut force[block.force_offset..block.force_offset + groups * LANES * 3 * nodes],
    };
    match block.kind {
        ElementKind::Tet4 => run_block::<Tet4, T>(cpu, columns, law, patch_groups(block.kind)),
        ElementKind::Hex8 => run_block::<Hex8, T>(cpu, columns, law, patch_groups(block.kind)),
    }
}

/// The lowest row with J < 0. Only called when the kernel has found one.
fn first_inverted(block: &Block, connectivity: &[u32], shape: &RestShape, displacement: &Displacement) -> u32 {
    let worst = (0..block.count).find(|&row| {
        let state = crate::evaluation::ElementState::of(block.kind, row, connectivity, shape, displacement);
        state.volume > 0.0 && state.kinematics.true_j < 0.0
    });
    // rounding may hide from f64 what the kernel saw
    worst.map_or(0, |row| row as u32)
}

/// One kernel for each block, of the fragments that its element type and its material call for.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for block in BlockKernels::of_world(world, buffers) {
        let nodes = node_count(block.block.kind);
        let mut text = String::from("fn write_forces(element: u32, forces: array<vec3<f32>, NODES>) {\n");
        for corner in 0..nodes {
            text += &format!("    write_force(element, {corner}u, forces[{corner}]);\n");
        }
        let kernel = block
            .kernel("element_forces")
            .fragment(shader!("element_forces"))
            .fragment(block.generated("corners", text + "}\n"))
            .bind(RestShape::NAME, buffers.column(block.entity, RestShape::NAME))
            .bind(ElementForce::NAME, buffers.column(block.block.body, ElementForce::NAME))
            .bind(FirstInverted::NAME, buffers.column(block.entity, FirstInverted::NAME));
        kernels.push(block.with_stress(kernel, buffers));
    }
    kernels
}
