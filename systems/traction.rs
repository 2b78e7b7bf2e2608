//! `traction`: dead loads on the surface. `shaders/traction.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::stage::{Stage, with_factors};
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::face_kernel::{FaceLoad, face_loads};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::sync::Arc;

/// A force per rest area (Pa), a signal, on faces of the surface.
#[derive(Component, Clone, Debug, Serialize)]
pub struct Traction {
    /// The faces, by the nodes they load.
    #[serde(skip)]
    pub faces: Arc<FaceCorners>,
    signal: usize,
}

/// Adds the force per rest area, in a direction that does not follow the surface. A face of a removed element bears
/// none.
pub fn system() -> System {
    System::built_in_nodes::<Traction>(
        "traction",
        Phase::Loads,
        "adds dead loads on the surface to the external forces",
        "`Traction(...)` under `loads`",
        |world| super::registry::count::<Traction>(world, "traction", "tractions"),
    )
    .for_load(|on, signal| Some(Traction { faces: on.faces()?.clone(), signal }))
    .with_shader::<Traction>("shaders/traction.wgsl", include_str!("../shaders/traction.wgsl"))
}

impl NodeSystem for Traction {
    type Columns = &'static mut ExternalForce;
    type Prepared = [f64; 4];

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.faces.rows)
    }

    /// Where elements can go, one for each block behind its faces.
    fn stages(&self, body: Entity, world: &World) -> Vec<Stage> {
        let of_block = |FaceLoad { faces, alive }: FaceLoad| {
            let place = |corner: &u32| (*corner as usize / 4, *corner as usize % 4);
            let areas: Vec<f32> =
                faces.corners.iter().map(place).map(|(face, corner)| faces.areas[face][corner] as f32).collect();
            let behind: Vec<u32> = faces.corners.iter().map(place).map(|(face, _)| faces.elements[face].1).collect();
            let stage = Stage::of(Rows::List(&faces.rows)).integers("starts", &faces.starts);
            let stage = stage.reals("areas", &areas).integers("behind", &behind);
            with_alive(with_factors(stage, &faces.factors), alive)
        };
        face_loads(&self.faces, body, world).into_iter().map(of_block).collect()
    }

    fn prepare(&self, before: &Before<'_>) -> [f64; 4] {
        before.signals.values()[self.signal]
    }

    /// None: it does not follow the surface.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, traction: &[f64; 4], _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let (faces, first) = (&self.faces, nodes.first);
        let Some(external) = nodes.external_force_mut() else { return };
        let (traction, alive) = ([0, 1, 2].map(|i| T::from_f64(traction[i])), faces.alive.read());
        for i in places_within(&faces.rows, first, external.len() / 3) {
            let mut area = T::default();
            for &corner in &faces.corners[faces.starts[i] as usize..faces.starts[i + 1] as usize] {
                let (face, corner) = (corner as usize / 4, corner as usize % 4);
                if alive[face] == 1 {
                    area += T::from_f64(faces.areas[face][corner]);
                }
            }
            let at = 3 * (faces.rows[i] as usize - first);
            let factors = faces.factors.get(i).unwrap_or(&[1.0; 3]);
            for k in 0..3 {
                external[at + k] += T::from_f64(factors[k]) * traction[k] * area;
            }
        }
    }
}

/// Adds what tells which elements of a block are there; `None`: all are, for good.
pub(super) fn with_alive(stage: Stage, block: Option<Entity>) -> Stage {
    match block {
        Some(block) => stage.fragment(shader!("alive")).column(Alive::NAME, block, Alive::NAME),
        None => stage
            .text("generated: no element is ever removed", "fn bears(element: u32) -> bool {\n    return true;\n}\n"),
    }
}
