//! What kernels of an element block have in common: the element type's and the material's fragments, constants,
//! buffers.

use super::Buffers;
use super::cpu::BlockLaw;
use super::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use super::law_kernel::{ElasticPart, ExponentialFamily, family_directions, law_of_element, prerequisites};
use super::patch_lists::{BATCH_GROUPS, PLACE_BITS, PackedPatches, PatchLists, patch_batches};
use super::user_law;
use crate::components::{
    self, Column, Connectivity, Displacement, FamilyDirection, FibreDirection, Label, NodalVolumeChange, ViscousMemory,
};
use crate::elements::{Element, PressureFrom};
use crate::elements::{node_count, with_element, with_element_of};
use crate::materials::{ElasticLaw, Fibres, J_FLOOR, PronyTerm};
use crate::math::LANES;
use crate::mesh::{ElementKind, each_element_kind};
use crate::shader;
use bevy_ecs::prelude::*;

/// A block as its kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Block {
    count: u32,
    force_offset: u32,
}
uniform!(Block { count, force_offset });

/// Direction of the fibres of a whole block.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct UniformDirection {
    x: f32,
    y: f32,
    z: f32,
}
uniform!(UniformDirection { x, y, z });

/// Where a kernel has what it knows of elements' corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CornersAt {
    /// In the columns of the body.
    Columns,
    /// In workgroup memory, of a patch's nodes.
    Patch,
}

/// Makes kernels of one block, all on the same uniform buffers.
pub(crate) struct BlockKernels {
    /// The block.
    pub entity: Entity,
    /// What it is.
    pub block: components::Block,
    law: BlockLaw<f32>,
    label: String,
    columns: [BufferId; 2],
    parameters: BufferId,
    elastic: Option<BufferId>,
    law_numbers: Option<BufferId>,
    fibres: Option<BufferId>,
    uniform_direction: Option<BufferId>,
    families: Option<BufferId>,
    varying_directions: Option<BufferId>,
}

/// What kernels know of a law's parameters: of the elastic law, of fibres, of families of fibres, each with the label
/// of its uniform, where there is any.
pub(crate) fn law_uniforms(law: &BlockLaw<f32>, label: &str) -> [Option<(String, Vec<u8>)>; 3] {
    let fibres = law.fibres.as_ref().map_or(Vec::new(), |(fibres, _)| fibres.bytes());
    let families = law.exponential.iter().flat_map(|family| ExponentialFamily::new(family).bytes()).collect();
    let parts = [
        (law.elastic.name(), ElasticPart::of(&law.elastic).bytes),
        ("fibres", fibres),
        ("exponential_fibres", families),
    ];
    parts.map(|(name, bytes)| (!bytes.is_empty()).then(|| (format!("{name} of {label}"), bytes)))
}

/// The terms of what all elements of a law remember, with the label of their uniform, where there are any and copies do
/// not differ in them.
pub(crate) fn terms_uniform(law: &BlockLaw<f32>, label: &str) -> Option<(String, Vec<u8>)> {
    let differ = law.copies.as_ref().is_some_and(|copies| copies.have_terms());
    let bytes: Vec<u8> = law.prony.iter().chain(&law.volumetric).flat_map(Uniform::bytes).collect();
    (!differ && !bytes.is_empty()).then(|| (format!("prony of {label}"), bytes))
}

/// The numbers in which elements' laws differ from copy to copy, with the label of their buffer.
pub(crate) fn law_numbers(law: &BlockLaw<f32>, label: &str) -> Option<(String, Vec<u8>)> {
    let copies = law.copies.as_ref()?;
    Some((format!("law_numbers of {label}"), bytemuck::cast_slice(&copies.numbers).to_vec()))
}

impl BlockKernels {
    /// Of every block that has a law in f32.
    pub fn of_world(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Self> {
        let mut query = world.query::<(Entity, &components::Block, &BlockLaw<f32>, Option<&Label>)>();
        let found = query.iter(world).map(|(entity, block, law, label)| {
            let label = label.map_or_else(|| format!("block {entity}"), |label| label.0.clone());
            (entity, block.clone(), law.clone(), label)
        });
        let found: Vec<_> = found.collect();
        found.into_iter().map(|(entity, block, law, label)| Self::new(entity, block, law, label, buffers)).collect()
    }

    fn new(
        entity: Entity,
        block: components::Block,
        law: BlockLaw<f32>,
        label: String,
        buffers: &mut dyn Buffers,
    ) -> Self {
        let columns = [buffers.column(block.body, Displacement::NAME), buffers.column(entity, Connectivity::NAME)];
        let parameters = Block { count: block.count as u32, force_offset: block.force_offset as u32 };
        let parameters = buffers.uniform(format!("block of {label}"), &parameters.bytes());
        let mut parts = law_uniforms(&law, &label).map(|part| part.map(|(name, bytes)| buffers.uniform(name, &bytes)));
        let [elastic, fibres, families] = std::array::from_fn(|i| parts[i].take());
        let uniform_direction = match law.fibres {
            Some((_, FamilyDirection::Uniform([x, y, z]))) => {
                let direction = UniformDirection { x, y, z };
                Some(buffers.uniform(format!("fibre_direction of {label}"), &direction.bytes()))
            }
            _ => None,
        };
        let law_numbers = law_numbers(&law, &label).map(|(label, bytes)| buffers.constants(label, &bytes));
        let varying_directions = (law.varying_families() > 0).then(|| buffers.column(entity, FibreDirection::NAME));
        Self {
            entity,
            block,
            law,
            label,
            columns,
            parameters,
            elastic,
            law_numbers,
            fibres,
            uniform_direction,
            families,
            varying_directions,
        }
    }

    /// A kernel with the block's element type, strain measures and laws of stress and energy without history; a thread
    /// for each element.
    pub fn kernel(&self, entry: &'static str) -> Kernel {
        self.with_law(self.of_columns(entry)).bind("displacement", self.columns[0])
    }

    /// The same with a workgroup for each patch, which has its nodes in workgroup memory.
    pub fn patch_kernel(&self, entry: &'static str, packed: &PackedPatches, buffers: &mut dyn Buffers) -> Kernel {
        let kind = self.block.kind;
        let batch = BATCH_GROUPS * LANES;
        let constants = format!(
            "const BATCH: u32 = {batch}u;\nconst BATCH_GROUPS: u32 = {BATCH_GROUPS}u;\nconst PATCH_GROUPS: u32 = {}u;\n\
             const PATCH_BATCHES: u32 = {}u;\nconst PATCH_NODES: u32 = {}u;\nconst PLACE_BITS: u32 = {PLACE_BITS}u;\n",
            components::patch_groups(kind),
            patch_batches(kind),
            packed.room,
        );
        let mut calls = String::from(
            "fn add_forces(element: u32, is_there: bool, batch: u32, forces: array<vec3<f32>, NODES>) {\n",
        );
        for corner in 0..node_count(kind) {
            calls += &format!("    add_force(element, is_there, batch, {corner}u, forces[{corner}]);\n");
        }
        let lists = buffers.uniform(format!("patches of {}", self.label), &packed.lists.bytes());
        let words = buffers.constants(format!("patch_lists of {}", self.label), bytemuck::cast_slice(&packed.words));
        let threads = packed.count() * batch;
        self.with_law(self.of_block(entry))
            .fragment(shader!("patches"))
            .fragment(shader!("patch_pass"))
            .fragment(self.generated("patches", constants + &calls + "}\n"))
            .bind_uniform::<PatchLists>("patches", lists)
            .bind("patch_lists", words)
            .bind("displacement", self.columns[0])
            .threads(u32::try_from(threads).unwrap_or(u32::MAX))
    }

    fn with_law(&self, kernel: Kernel) -> Kernel {
        let elastic = ElasticPart::of(&self.law.elastic);
        let mut kernel = kernel
            .fragment(shader!("tensor"))
            .fragment(shader!("inverse_cbrt"))
            .fragment(shader!("kinematics"))
            .fragment(shader!("point"))
            .fragment(element_shader(self.block.kind));
        kernel.fragments.extend(elastic.fragment.map(|fragment| self.own(fragment, "elastic")));
        kernel.fragments.extend(prerequisites(&self.law.elastic));
        if self.law_numbers.is_none() {
            kernel.layouts.extend(elastic.layout.map(|layout| ("elastic".into(), layout)));
        }
        match &self.law.elastic {
            ElasticLaw::UserLaw(law) => user_law::with_law(kernel, law.parts()),
            _ => kernel,
        }
    }

    /// A kernel that knows the block's layout only; a thread for each element.
    pub fn of_columns(&self, entry: &'static str) -> Kernel {
        self.of_block(entry)
            .fragment(shader!("corner"))
            .bind("connectivity", self.columns[1])
            .threads(self.block.count as u32)
    }

    fn of_block(&self, entry: &'static str) -> Kernel {
        let kernel = Kernel { block: Some(self.entity), ..Kernel::new(format!("{entry} of {}", self.label), entry) };
        kernel
            .fragment(shader!("row"))
            .fragment(shader!("block"))
            .fragment(self.generated("constants", self.constants()))
            .bind_uniform::<Block>("block", self.parameters)
    }

    /// Adds the parameters of the elastic law, if it has any, or those in which each element has its own, with the
    /// terms of what it remembers or without.
    fn with_parameters(&self, kernel: Kernel, remembers: bool) -> Kernel {
        match (self.law_numbers, self.elastic) {
            (Some(numbers), _) => kernel
                .fragment(self.generated("law of an element", law_of_element(&self.law, remembers)))
                .bind("law_numbers", numbers),
            (None, Some(buffer)) => kernel.fragment(shader!("law_of_all")).bind("elastic", buffer),
            (None, None) => kernel.fragment(shader!("law_of_all")),
        }
    }

    /// A fragment whose uniform of that name is each element's own where copies differ.
    fn own(&self, fragment: Fragment, uniform: &'static str) -> Fragment {
        if self.law_numbers.is_some() { fragment.with_private(uniform) } else { fragment }
    }

    /// Adds where the element type's pressure comes from.
    fn with_pressure(&self, kernel: Kernel, at: CornersAt, buffers: &mut dyn Buffers) -> Kernel {
        let from = with_element!(self.block.kind, E => E::PRESSURE);
        let kernel = match (at, from) {
            (CornersAt::Columns, _) | (_, PressureFrom::Nodes) => kernel,
            (CornersAt::Patch, _) => {
                let none = "fn bring_volume_change(local_node: u32, node: u32) {}\n";
                kernel.fragment(Fragment::new("generated: no volume change of nodes", none))
            }
        };
        match from {
            PressureFrom::Point => kernel.fragment(shader!("point_pressure")),
            PressureFrom::MeanOverPoints => kernel.fragment(shader!("mean_pressure")),
            PressureFrom::Nodes => kernel
                .fragment(shader!("tet4_nodal_pressure"))
                .fragment(match at {
                    CornersAt::Columns => shader!("corner_volume"),
                    CornersAt::Patch => shader!("patch_volume"),
                })
                .bind(NodalVolumeChange::NAME, buffers.column(self.entity, NodalVolumeChange::NAME)),
        }
    }

    /// Adds all families of fibres, if there are any.
    fn with_fibres(&self, mut kernel: Kernel) -> Kernel {
        let mut text = String::new();
        if let Some(fibres) = self.fibres {
            kernel = kernel.fragment(self.own(shader!("fibres"), "fibres"));
            if self.law_numbers.is_none() {
                kernel = kernel.bind_uniform::<Fibres<f32>>("fibres", fibres);
            }
            match (self.uniform_direction, &self.law.fibres) {
                (Some(direction), _) => {
                    kernel = kernel
                        .fragment(shader!("fibres_uniform"))
                        .bind_uniform::<UniformDirection>("uniform_direction", direction);
                }
                (None, Some((_, FamilyDirection::Varying(place)))) => {
                    text += "fn fibre_direction_of(element: u32) -> vec3<f32> {\n";
                    text += &format!("    return varying_direction(element, {place}u);\n}}\n");
                }
                (None, _) => {}
            }
        }
        if let Some(families) = self.families {
            text += &family_directions(&self.law.exponential);
            kernel = kernel.fragment(self.own(shader!("exponential_fibres"), "exponential_fibres"));
            if self.law_numbers.is_none() {
                kernel = kernel.bind_uniform::<ExponentialFamily>("exponential_fibres", families);
            }
            if !kernel.fragments.contains(&shader!("elementary")) {
                kernel = kernel.fragment(shader!("elementary"));
            }
        }
        if let Some(directions) = self.varying_directions {
            text += &format!("const VARYING: u32 = {}u;\n", self.law.varying_families());
            kernel = kernel.fragment(shader!("fibres_field")).bind("fibre_direction", directions);
        }
        match text.is_empty() {
            true => kernel,
            false => kernel.fragment(self.generated("fibres", text)),
        }
    }

    /// Adds the stress of the material, which carries its history on by a step.
    pub fn with_stress(&self, kernel: Kernel, at: CornersAt, buffers: &mut dyn Buffers) -> Kernel {
        let law = &self.law;
        let (terms, volumetric) = (law.prony.len(), law.volumetric.len());
        let lines = [
            (true, "var stress = elastic_isochoric(k);"),
            (law.fibres.is_some(), "stress = sym_plus(stress, fibres_isochoric(k, fibre_direction_of(element)));"),
            (self.families.is_some(), "stress = sym_plus(stress, exponential_isochoric(element, k));"),
            (terms > 0, "stress = relaxed(element, point, stress);"),
            (law.reproject, "stress = elastic_without_pressure(k, stress);"),
            (true, "return stress;"),
        ];
        let mut text = String::from("fn isochoric_stress(element: u32, point: u32, k: Kinematics) -> Sym3 {\n");
        text.extend(lines.iter().filter(|(there, _)| *there).map(|(_, line)| format!("    {line}\n")));
        text += "}\nfn viscous_pressure(element: u32, point: u32, pressure: f32) -> f32 {\n";
        text += match volumetric {
            0 => "    return pressure;\n}\n",
            _ => "    return relaxed_pressure(element, point, pressure);\n}\n",
        };
        if terms + volumetric > 0 {
            text += &format!("const TERMS: u32 = {terms}u;\nconst VOLUMETRIC_TERMS: u32 = {volumetric}u;\n");
        }
        let kernel = self.with_fibres(self.with_parameters(kernel, true));
        let kernel = self.with_pressure(kernel, at, buffers).fragment(self.generated("stress", text));
        if terms + volumetric == 0 {
            return kernel;
        }
        let kernel = match terms_uniform(law, &self.label) {
            Some((label, bytes)) => kernel
                .fragment(shader!("prony"))
                .bind_uniform::<PronyTerm<f32>>("prony", buffers.uniform(label, &bytes)),
            None => kernel.fragment(shader!("prony").with_private("prony")),
        };
        kernel.bind(ViscousMemory::NAME, buffers.column(self.entity, ViscousMemory::NAME))
    }

    /// Adds the elastic energy per rest volume of the material.
    pub fn with_energy(&self, kernel: Kernel, buffers: &mut dyn Buffers) -> Kernel {
        let energies = [
            self.fibres.map(|_| "fibres_energy(k, fibre_direction_of(element))"),
            self.families.map(|_| "exponential_energy(element, k)"),
        ];
        let energies: Vec<&str> = energies.into_iter().flatten().collect();
        let sum = if energies.is_empty() { "0.0".into() } else { energies.join(" + ") };
        let text = format!("fn fibres_energy_at(element: u32, k: Kinematics) -> f32 {{\n    return {sum};\n}}\n");
        self.with_pressure(self.with_fibres(self.with_parameters(kernel, false)), CornersAt::Columns, buffers)
            .fragment(shader!("energy"))
            .fragment(self.generated("energy", text))
    }

    /// Text that is made for this block.
    pub fn generated(&self, what: &str, text: String) -> Fragment {
        Fragment::new(format!("generated: {what} of {}", self.label), text)
    }

    fn constants(&self) -> String {
        with_element_of!(self.block, E => constants::<E>())
    }
}

macro_rules! element_shaders {
    ($dollar:tt $($(#[$about:meta])* $file:ident: $kind:ident of $cell:ident, $shader:literal;)*) => {
        /// The WGSL of an element type.
        pub(super) fn element_shader(kind: ElementKind) -> Fragment {
            match kind {
                $(ElementKind::$kind => shader!($shader),)*
            }
        }
    };
}
each_element_kind! { $ element_shaders }

fn constants<E: Element>() -> String {
    format!(
        "const LANES: u32 = {LANES}u;\nconst NODES: u32 = {}u;\nconst POINTS: u32 = {}u;\nconst CHECKED_POINTS: u32 = {}u;\nconst ROWS: u32 = {}u;\n\
         const VOLUME_ROW: u32 = {}u;\nconst J_FLOOR: f32 = {J_FLOOR:e};\n",
        E::NODES,
        E::POINTS,
        E::CHECKED_POINTS,
        E::ROWS,
        E::VOLUME_ROW,
    )
}
