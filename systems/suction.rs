//! `suction`: faces in the mouth of a tool are sucked into it. `shaders/suction.wgsl` is its twin; which faces those
//! are and by what pressure, `suction_mouth` finds.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::pressure::{find_areas, push};
use super::rows::Rows;
use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::kernel::{Uniform, uniform};
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use crate::error::missing;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Adds +Δp ∫ N_a n dA over the deformed faces in the mouth: a [`Pressure`](super::Pressure) with its sign reversed,
/// which the tool feels.
pub fn system() -> System {
    System::built_in_nodes::<Suction>(
        "suction",
        Phase::Loads,
        "adds what tools suck by to the external forces",
        "an entry under `suction`",
        |world| super::registry::count::<Suction>(world, "tool that sucks", "tools that suck"),
    )
    .on_nodes(stages)
}

impl NodeSystem for Suction {
    type Columns = (&'static RestPosition, &'static Displacement, &'static mut ExternalForce);
    /// The pressure (Pa).
    type Prepared = f64;

    fn rows(&self) -> Rows<'_> {
        Rows::Changing
    }

    fn prepare(&self, before: &Before<'_>) -> f64 {
        find_areas(&self.active, before.rest, before.displacement);
        -self.now
    }

    /// None is counted: as of [`Pressure`](super::Pressure), of which the limit there holds for what is sucked, too.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, pressure: &f64, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        push(&self.active, *pressure, nodes);
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct SuctionLoad {
    faces: u32,
    first: u32,
    pressure: u32,
    lists: u32,
}
uniform!(SuctionLoad { faces, first, pressure, lists });

/// The parts of a body's faces as kernels see them: nodes, face, weight.
pub(super) fn parts_of(faces: &BodyFaces) -> Vec<[u32; 6]> {
    let part =
        |((&[a, b, c, d], &face), &weight): ((&[u32; 4], &u32), &f64)| [a, b, c, d, face, (weight as f32).to_bits()];
    faces.parts.faces.iter().zip(&faces.of_part).zip(&faces.parts.weights).map(part).collect()
}

fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let all: Vec<(Suction, Entity)> =
        world.query::<(&Suction, &OfBody)>().iter(world).map(|(suction, body)| (suction.clone(), body.0)).collect();
    let mut stages = Vec::new();
    for (suction, body) in all {
        let Some(rest) = world.get::<RestPosition>(body) else {
            debug_assert!(false, "{}", missing("a column of a body"));
            continue;
        };
        let faces = &suction.faces;
        let points: Vec<[f32; 3]> =
            faces.parts.faces.iter().flatten().map(|&node| rest.0[node as usize].as_vec3().to_array()).collect();
        let load = SuctionLoad {
            faces: faces.len() as u32,
            first: suction.first_mark() as u32,
            pressure: (SUCTION_NUMBERS * suction.number) as u32,
            lists: faces.parts.starts.len() as u32,
        };
        let lists = [&faces.parts.starts[..], &faces.parts.corners].concat();
        let lists = buffers.constants("corners of suction".into(), bytemuck::cast_slice(&lists));
        let parts = buffers.constants("faces of suction".into(), bytemuck::cast_slice(&parts_of(faces)));
        let points = buffers.constants("points of suction".into(), bytemuck::cast_slice(&points));
        let stage = NodeStage::new("suction", "suction", body, rows_of(body, world), shader!("suction"))
            .own(shader!("face_area"))
            .bind_uniform::<SuctionLoad>("load", buffers.uniform("suction".into(), &load.bytes()))
            .bind("lists", lists)
            .bind("faces", parts)
            .bind("face_points", points)
            .bind(SuctionMarks::NAME, buffers.column(body, SuctionMarks::NAME))
            .bind(SuctionPressure::NAME, buffers.column(body, SuctionPressure::NAME))
            .column(Displacement::NAME, buffers.column(body, Displacement::NAME))
            .reads_elsewhere(Displacement::NAME)
            .column(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME))
            .of_rows(faces.parts.rows.clone());
        stages.push(stage.with_step(world).loaded(true));
    }
    stages
}
