//! What kernels of an element block have in common: the element type's and the material's fragments, constants, buffers.

use super::Buffers;
use super::cpu::BlockLaw;
use super::kernel::{BufferId, Fragment, Kernel, Layout, Uniform, uniform};
use crate::components::{
    self, Column, Connectivity, Displacement, FibreDirection, Label, NodalVolumeChange, ViscousMemory,
};
use crate::elements::{Element, PressureFrom};
use crate::evaluation::with_element;
use crate::materials::{ElasticLaw, Fibres, J_FLOOR, NeoHookean, PronyTerm, each_elastic_law};
use crate::math::LANES;
use crate::mesh::ElementKind;
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

uniform!(NeoHookean<f32> { shear, bulk });
uniform!(Fibres<f32> { eta, tension_only });
uniform!(PronyTerm<f32> { stress, memory, rate, aim });

/// A law's WGSL twin, its parameters, and how they are laid out.
struct ElasticPart {
    fragment: Fragment,
    bytes: Vec<u8>,
    layout: Layout,
}

macro_rules! elastic_parts {
    ($($law:ident = $stem:literal;)*) => {
        impl ElasticPart {
            fn of(law: &ElasticLaw<f32>) -> Self {
                match law {
                    $(ElasticLaw::$law(law) => Self {
                        fragment: shader!($stem),
                        bytes: law.bytes(),
                        layout: <$law<f32> as Uniform>::LAYOUT,
                    },)*
                }
            }
        }
    };
}
each_elastic_law!(elastic_parts);

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
    elastic: BufferId,
    fibres: Option<(BufferId, BufferId)>,
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
        let elastic = buffers
            .uniform(format!("{} of {label}", law.elastic.name()), &ElasticPart::of(&law.elastic).bytes);
        let fibres = law.fibres.as_ref().map(|(fibres, uniform)| {
            let direction = match uniform {
                Some([x, y, z]) => {
                    let direction = UniformDirection { x: *x, y: *y, z: *z };
                    buffers.uniform(format!("fibre_direction of {label}"), &direction.bytes())
                }
                None => buffers.column(entity, FibreDirection::NAME),
            };
            (buffers.uniform(format!("fibres of {label}"), &fibres.bytes()), direction)
        });
        Self { entity, block, law, label, columns, parameters, elastic, fibres }
    }

    /// A kernel with the block's element type, strain measures and laws of stress and energy without history; a thread for
    /// each element.
    pub fn kernel(&self, entry: &'static str) -> Kernel {
        let elastic = ElasticPart::of(&self.law.elastic);
        let mut kernel = self
            .of_columns(entry)
            .fragment(shader!("tensor"))
            .fragment(shader!("kinematics"))
            .fragment(shader!("point"))
            .fragment(match self.block.kind {
                ElementKind::Tet4 | ElementKind::Tet4NodalPressure => shader!("tet4"),
                ElementKind::Hex8 => shader!("hex8"),
                ElementKind::Hex8MeanDilatation => shader!("hex8_mean_dilatation"),
            })
            .fragment(elastic.fragment)
            .fragment(shader!("finite_strain"))
            .fragment(shader!("volume_ratio"))
            .bind("displacement", self.columns[0]);
        kernel.layouts.push(("elastic", elastic.layout));
        kernel
    }

    /// A kernel that knows the block's layout only; a thread for each element.
    pub fn of_columns(&self, entry: &'static str) -> Kernel {
        Kernel::new(format!("{entry} of {}", self.label), entry)
            .fragment(shader!("row"))
            .fragment(shader!("block"))
            .fragment(self.generated("constants", self.constants()))
            .bind_uniform::<Block>("block", self.parameters)
            .bind("connectivity", self.columns[1])
            .threads(self.block.count as u32)
    }

    /// Adds where the element type's pressure comes from.
    fn with_pressure(&self, kernel: Kernel, buffers: &mut dyn Buffers) -> Kernel {
        match with_element!(self.block.kind, E => E::PRESSURE) {
            PressureFrom::Point => kernel.fragment(shader!("point_pressure")),
            // comes with the element type
            PressureFrom::MeanOverPoints => kernel,
            PressureFrom::Nodes => kernel
                .fragment(shader!("tet4_nodal_pressure"))
                .bind(NodalVolumeChange::NAME, buffers.column(self.entity, NodalVolumeChange::NAME)),
        }
    }

    /// Adds the fibres, if there are any.
    fn with_fibres(&self, kernel: Kernel) -> Kernel {
        let Some((fibres, direction)) = self.fibres else { return kernel };
        let kernel = kernel.fragment(shader!("fibres")).bind_uniform::<Fibres<f32>>("fibres", fibres);
        match self.law.fibres {
            Some((_, Some(_))) => kernel
                .fragment(shader!("fibres_uniform"))
                .bind_uniform::<UniformDirection>("uniform_direction", direction),
            _ => kernel.fragment(shader!("fibres_field")).bind("fibre_direction", direction),
        }
    }

    /// Adds the stress of the material, which carries its history on by a step.
    pub fn with_stress(&self, kernel: Kernel, buffers: &mut dyn Buffers) -> Kernel {
        let mut text = String::from(
            "fn isochoric_stress(element: u32, point: u32, k: Kinematics) -> Sym3 {\n    var stress = elastic_isochoric(k);\n",
        );
        if self.law.fibres.is_some() {
            text += "    stress = sym_plus(stress, fibres_isochoric(k, fibre_direction_of(element)));\n";
        }
        let terms = self.law.prony.len();
        if terms > 0 {
            text += "    stress = relaxed(element, point, stress);\n";
        }
        text += "    return stress;\n}\n";
        if terms > 0 {
            text += &format!("const TERMS: u32 = {terms}u;\n");
        }
        let kernel = self.with_fibres(kernel.bind("elastic", self.elastic));
        let kernel = self.with_pressure(kernel, buffers).fragment(self.generated("stress", text));
        if terms == 0 {
            return kernel;
        }
        let bytes: Vec<u8> = self.law.prony.iter().flat_map(Uniform::bytes).collect();
        let prony = buffers.uniform(format!("prony of {}", self.label), &bytes);
        kernel
            .fragment(shader!("prony"))
            .bind_uniform::<PronyTerm<f32>>("prony", prony)
            .bind(ViscousMemory::NAME, buffers.column(self.entity, ViscousMemory::NAME))
    }

    /// Adds the elastic energy per rest volume of the material.
    pub fn with_energy(&self, kernel: Kernel, buffers: &mut dyn Buffers) -> Kernel {
        let fibres = match self.law.fibres {
            Some(_) => "fibres_energy(k, fibre_direction_of(element))",
            None => "0.0",
        };
        let text =
            format!("fn fibres_energy_at(element: u32, k: Kinematics) -> f32 {{\n    return {fibres};\n}}\n");
        self.with_pressure(self.with_fibres(kernel.bind("elastic", self.elastic)), buffers)
            .fragment(shader!("energy"))
            .fragment(self.generated("energy", text))
    }

    /// Text that is made for this block.
    pub fn generated(&self, what: &str, text: String) -> Fragment {
        Fragment::new(format!("generated: {what} of {}", self.label), text)
    }

    fn constants(&self) -> String {
        with_element!(self.block.kind, E => constants::<E>())
    }
}

fn constants<E: Element>() -> String {
    format!(
        "const LANES: u32 = {LANES}u;\nconst NODES: u32 = {}u;\nconst POINTS: u32 = {}u;\nconst ROWS: u32 = {}u;\n\
         const VOLUME_ROW: u32 = {}u;\nconst J_FLOOR: f32 = {J_FLOOR:e};\n",
        E::NODES,
        E::POINTS,
        E::ROWS,
        E::VOLUME_ROW,
    )
}
