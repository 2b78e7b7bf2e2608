//! `suction`: faces in the mouth of a tool are sucked into it. `shaders/suction.wgsl` is its twin; which faces those
//! are and by what pressure, `suction_mouth` finds.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::pressure::{find_areas, push, with_faces};
use super::rows::Rows;
use super::stage::Stage;
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;
use serde::Serialize;

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
    .with_twin::<Suction>("suction", shader!("suction"), |_, stage| stage)
}

impl NodeSystem for Suction {
    type Columns = (&'static Displacement, &'static SuctionMarks, &'static SuctionPressure, &'static mut ExternalForce);
    /// The pressure (Pa).
    type Prepared = f64;
    const READS_ELSEWHERE: &'static [&'static str] = &[Displacement::NAME];

    fn rows(&self) -> Rows<'_> {
        Rows::Changing
    }

    fn stages(&self, body: Entity, world: &World) -> Vec<Stage> {
        let BodyFaces { parts, .. } = &*self.faces;
        let load = SuctionLoad {
            faces: self.faces.len(),
            first: self.first_mark(),
            pressure: SUCTION_NUMBERS * self.number,
            lists: parts.starts.len(),
        };
        let lists = [&parts.starts[..], &parts.corners].concat();
        let stage = Stage::of(Rows::List(&parts.rows)).uniform("load", &load).integers("lists", &lists);
        vec![with_faces(stage, &parts.faces, parts_of(&self.faces).as_flattened(), body, world)]
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

/// Where kernels find what they need.
#[derive(Serialize)]
struct SuctionLoad {
    faces: usize,
    first: usize,
    pressure: usize,
    lists: usize,
}

/// The parts of a body's faces as kernels see them: nodes, face, weight.
pub(super) fn parts_of(faces: &BodyFaces) -> Vec<[u32; 6]> {
    let part =
        |((&[a, b, c, d], &face), &weight): ((&[u32; 4], &u32), &f64)| [a, b, c, d, face, (weight as f32).to_bits()];
    faces.parts.faces.iter().zip(&faces.of_part).zip(&faces.parts.weights).map(part).collect()
}
