//! `element_forces`: what deformed elements exert on their corners. The kernel is put together from
//! `shaders/element_forces.wgsl`, the element's file, one file an effect of the material, and `patches.wgsl` or
//! `two_pass.wgsl`.

use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::{BlockKernels, CornersAt};
use crate::backend::cpu::{
    BlockColumns, BlockLaw, Cpu, InsidePatch, NodeColumns, PatchInterior, run_block, run_block_fast,
};
use crate::backend::kernel::{Fragment, Kernel};
use crate::backend::patch_lists::pack;
use crate::backend::step::{step_number, with_step};
use crate::components::*;
use crate::elements::Element;
use crate::elements::{node_count, with_element_of};
use crate::error::{Error, missing};
use crate::evaluation::ElementState;
use crate::materials::FLATTEST;
use crate::math::SimdScalar;
use crate::scene::schema::Inversion;
use crate::shader;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;

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
    .of_elements()
    .on_device(kernels)
}

/// What a block has.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct BlockParts {
    block: &'static Block,
    connectivity: &'static Connectivity,
    shape: &'static RestShape,
    fibres: Option<&'static FibreDirection>,
    means: Option<&'static NodalVolumeChange>,
    pub(super) patches: Option<&'static Patches>,
    memory: Option<&'static mut ViscousMemory>,
    law: &'static BlockLaw<f64>,
    rounded: Option<&'static BlockLaw<f32>>,
    inverted: &'static mut FirstInverted,
    policy: Option<&'static OnInversion>,
    removal: Option<&'static mut RemovalStep>,
}

/// The system by itself: where nothing follows for nodes in its pass (`fuse: false`, implicit steps, Newton's method).
/// Else `patch_pass.rs` calls [`BlockPartsItem::run`].
fn element_forces(
    cpu: Res<Cpu>,
    clock: Res<Clock>,
    mut trial: Option<ResMut<TrialForces>>,
    mut blocks: Query<BlockParts>,
    mut bodies: Query<(&Authoring, &Displacement, &mut ElementForce)>,
) -> Result<(), Error> {
    // implicit steps take their forces at their end
    let noted = Clock { step: clock.step.saturating_sub(u64::from(trial.is_some())), ..*clock };
    let trying = trial.as_ref().is_some_and(|trial| trial.trying);
    for (authoring, displacement, mut force) in &mut bodies {
        for &entity in &authoring.blocks {
            let Ok(mut block) = blocks.get_mut(entity) else {
                return Err(missing("a column of a body"));
            };
            let found = match &mut force.0 {
                Reals::F32(force) => block.run::<f32>(&cpu, (displacement.slice(), 0), force, None, trying),
                Reals::F64(force) => block.run::<f64>(&cpu, (displacement.slice(), 0), force, None, trying),
            };
            match trial.as_mut().filter(|trial| trial.trying) {
                Some(trial) => trial.inverted |= !found.is_empty() && block.must_not_invert(),
                None => block.note_inverted(&found, displacement, &noted),
            }
        }
    }
    Ok(())
}

impl BlockPartsItem<'_, '_> {
    /// The body, and where in its element forces those of the block begin.
    pub(super) fn place(&self) -> (Entity, usize) {
        (self.block.body, self.block.force_offset)
    }

    /// Takes the nodes inside each patch, one after the other, from the rows of a body that begin with those.
    pub(super) fn take_inside<'n, T>(
        &self,
        rows: &mut NodeColumns<'n, T>,
    ) -> impl ExactSizeIterator<Item = InsidePatch<'n, T>> {
        let patches = self.patches;
        (0..patches.map_or(0, |patches| patches.interior.len())).map(move |patch| {
            let [free, deferred] = patches.map_or([0; 2], |patches| patches.inside(patch));
            InsidePatch { free: rows.take(free), deferred: rows.take(deferred) }
        })
    }

    /// Whether elements turned inside out are a mistake.
    fn must_not_invert(&self) -> bool {
        self.policy.is_none_or(|policy| policy.0 == Inversion::Stop)
    }

    /// Runs the block's kernel: from displacements (m), from a row of the body on, to element forces (N). Returns the
    /// patches that have elements with J < 0. With `trying` the viscous memory stays as it is.
    pub(super) fn run<'a, T: Precise>(
        &'a mut self,
        cpu: &Cpu,
        (displacement, first_row): (&'a [T], usize),
        force: &'a mut [T],
        interior: Option<PatchInterior<'a, '_, T>>,
        trying: bool,
    ) -> Vec<usize> {
        let block = self.block;
        let viscous = trying && self.memory.is_some();
        let still = viscous.then(|| (self.law.with_still_memory(), self.rounded.map(BlockLaw::with_still_memory)));
        let law = still.as_ref().map_or((self.law, self.rounded), |(law, rounded)| (law, rounded.as_ref()));
        let columns = BlockColumns {
            displacement,
            first_row,
            connectivity: self.connectivity,
            rest_shape: self.shape.slice(),
            fibre_direction: self.fibres.map(|f| f.slice()),
            nodal_volume_change: self.means.map_or(&[], |means| means.slice()),
            memory: self.memory.as_mut().map_or(&mut [], |memory| memory.0.slice_mut()),
            force: &mut force[block.force_offset..block.force_offset + block.force_length],
            patches: self.patches,
            inverted_go: self.policy.is_some_and(|policy| policy.0 == Inversion::Remove),
            interior,
        };
        with_element_of!(block, E => T::run::<E>(cpu, columns, law, block))
    }

    /// Looks through patches in which the kernel found elements with J < 0, before their nodes move.
    pub(super) fn note_inverted(&mut self, patches: &[usize], displacement: &Displacement, clock: &Clock) {
        let block = self.block;
        let length = patch_length(block.kind);
        let rows = patches.iter().flat_map(|patch| patch * length..block.count.min((patch + 1) * length));
        let state = |row: usize| {
            ElementState::of(block, row, self.connectivity, self.shape, displacement, self.law.elastic_of(row))
        };
        let is_inverted = |row: &usize| state(*row).is_inverted();
        match (self.policy, &mut self.removal) {
            _ if patches.is_empty() => {}
            (Some(OnInversion(Inversion::Remove)), Some(removal)) => {
                let flat = rows.filter(|row| state(*row).is_flatter_than(FLATTEST));
                flat.for_each(|row| remove(row, clock.step + 1, removal));
            }
            // rounding may hide from f64 what the kernel saw
            _ if self.inverted[0] == u32::MAX => {
                self.inverted[0] = { rows }.find(is_inverted).unwrap_or(patches[0] * length) as u32;
                self.inverted[1] = step_number(clock);
            }
            _ => {}
        }
    }
}

/// A precision in which kernels run.
pub(super) trait Precise: SimdScalar {
    /// Runs the kernel of an element type with the law in f64, or rounded.
    fn run<E: Element>(
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, Self>,
        law: (&BlockLaw<f64>, Option<&BlockLaw<f32>>),
        block: &Block,
    ) -> Vec<usize>;
}

impl Precise for f64 {
    fn run<E: Element>(
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f64>,
        (law, _): (&BlockLaw<f64>, Option<&BlockLaw<f32>>),
        block: &Block,
    ) -> Vec<usize> {
        let groups_a_patch = patch_groups(block.kind);
        match law.own_kernels.as_ref().filter(|_| cpu.has_vectors()) {
            Some(own) => own.kernels().double(cpu, columns, law, block, groups_a_patch),
            None => run_block::<E, f64>(cpu, columns, law, groups_a_patch),
        }
    }
}

impl Precise for f32 {
    fn run<E: Element>(
        cpu: &Cpu,
        columns: BlockColumns<'_, '_, f32>,
        (exact, law): (&BlockLaw<f64>, Option<&BlockLaw<f32>>),
        block: &Block,
    ) -> Vec<usize> {
        let groups_a_patch = patch_groups(block.kind);
        let rounded;
        let law = match law {
            Some(law) => law,
            None => {
                rounded = exact.rounded();
                &rounded
            }
        };
        match law.own_kernels.as_ref().filter(|_| cpu.has_vectors()) {
            Some(own) => own.kernels().single(cpu, columns, law, block, groups_a_patch),
            None => run_block_fast::<E>(cpu, columns, law, groups_a_patch),
        }
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
                .fragment(least_volume_ratio(FLATTEST))
                .bind(RemovalStep::NAME, buffers.column(block.entity, RemovalStep::NAME)),
            _ => kernel
                .fragment(shader!("note_inverted"))
                .fragment(least_volume_ratio(0.0))
                .bind(FirstInverted::NAME, buffers.column(block.entity, FirstInverted::NAME)),
        };
        kernels.push(block.with_stress(with_step(kernel, world), corners, buffers));
    }
    kernels
}

/// Below which J elements count as inverted.
fn least_volume_ratio(least: f64) -> Fragment {
    Fragment::new("generated: least volume ratio", format!("const LEAST_J: f32 = {least:e};\n"))
}

fn two_pass(block: &BlockKernels) -> Kernel {
    let mut text = String::from("fn write_forces(element: u32, forces: array<vec3<f32>, NODES>) {\n");
    for corner in 0..node_count(block.block.kind) {
        text += &format!("    write_force(element, {corner}u, forces[{corner}]);\n");
    }
    let generated = block.generated("corners", text + "}\n");
    block.kernel("element_forces").fragment(shader!("two_pass")).fragment(generated)
}
