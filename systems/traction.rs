//! `traction`: dead loads on the surface. `shaders/traction.wgsl` is its twin.

use super::nodal_force::with_factors;
use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::face_kernel::{FaceLoad, face_loads};
use crate::backend::kernel::{Uniform, uniform};
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// A force per rest area (Pa), a signal, on faces of the surface.
#[derive(Component, Clone, Debug)]
pub struct Traction {
    /// The faces, by the nodes they load.
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
    .on_nodes(stages)
}

impl NodeSystem for Traction {
    type Columns = &'static mut ExternalForce;
    type Prepared = [f64; 4];

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.faces.rows)
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

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct TractionLoad {
    signal: u32,
}
uniform!(TractionLoad { signal });

/// One stage for each load; where elements can go, one for each block behind its faces.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let loads: Vec<(Traction, Entity)> =
        world.query::<(&Traction, &OfBody)>().iter(world).map(|(load, body)| (load.clone(), body.0)).collect();
    let mut stages = Vec::new();
    for (traction, body) in loads {
        for FaceLoad { faces, alive } in face_loads(&traction.faces, body, world) {
            let place = |corner: &u32| (*corner as usize / 4, *corner as usize % 4);
            let areas: Vec<f32> =
                faces.corners.iter().map(place).map(|(face, corner)| faces.areas[face][corner] as f32).collect();
            let behind: Vec<u32> = faces.corners.iter().map(place).map(|(face, _)| faces.elements[face].1).collect();
            let load = TractionLoad { signal: traction.signal as u32 };
            let stage = NodeStage::new("traction", "traction", body, rows_of(body, world), shader!("traction"))
                .bind_uniform::<TractionLoad>("load", buffers.uniform("traction".into(), &load.bytes()))
                .bind("starts", buffers.constants("starts of traction".into(), bytemuck::cast_slice(&faces.starts)))
                .bind("areas", buffers.constants("areas of traction".into(), bytemuck::cast_slice(&areas)))
                .bind("behind", buffers.constants("elements of traction".into(), bytemuck::cast_slice(&behind)))
                .column(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME))
                .of_rows(faces.rows);
            let stage = with_factors(stage, &faces.factors, buffers);
            stages.push(FaceLoad::with_alive(alive, stage, buffers).with_step(world).loaded(true));
        }
    }
    stages
}
