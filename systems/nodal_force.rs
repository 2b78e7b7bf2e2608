//! `nodal_force`: forces on chosen nodes. `shaders/nodal_force.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::kernel::{Fragment, Uniform, uniform};
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// A force (N), a signal, on each of some nodes.
#[derive(Component, Clone, Debug)]
pub struct NodalForce {
    /// The nodes.
    pub on: Arc<LoadedNodes>,
    signal: usize,
}

/// Adds a force to each of the load's nodes that has mass: a inactive node bears nothing.
pub fn system() -> System {
    System::built_in_nodes::<NodalForce>(
        "nodal_force",
        Phase::Loads,
        "adds forces on chosen nodes to the external forces",
        "`NodalForce(...)` under `loads`",
        |world| super::registry::count::<NodalForce>(world, "nodal force", "nodal forces"),
    )
    .for_load(|on, signal| Some(NodalForce { on: on.nodes()?.clone(), signal }))
    .on_nodes(stages)
}

impl NodeSystem for NodalForce {
    type Columns = (&'static Mass, &'static mut ExternalForce);
    type Prepared = [f64; 4];

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.on.rows)
    }

    fn prepare(&self, before: &Before<'_>) -> [f64; 4] {
        before.signals.values()[self.signal]
    }

    /// None: it is the same wherever the node goes.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, force: &[f64; 4], _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let (first, mass) = (nodes.first, nodes.mass());
        let Some(external) = nodes.external_force_mut() else { return };
        let LoadedNodes { rows, factors } = &*self.on;
        for place in places_within(rows, first, mass.len()) {
            let row = rows[place] as usize - first;
            if mass[row] > T::default() {
                let factors = factors.get(place).unwrap_or(&[1.0; 3]);
                for i in 0..3 {
                    external[3 * row + i] += T::from_f64(factors[i]) * T::from_f64(force[i]);
                }
            }
        }
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct NodalLoad {
    signal: u32,
}
uniform!(NodalLoad { signal });

/// One stage for each load.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let loads: Vec<(NodalForce, Entity)> =
        world.query::<(&NodalForce, &OfBody)>().iter(world).map(|(load, body)| (load.clone(), body.0)).collect();
    let mut stages = Vec::new();
    for (force, body) in loads {
        let load = NodalLoad { signal: force.signal as u32 };
        let stage = NodeStage::new("nodal_force", "nodal_force", body, rows_of(body, world), shader!("nodal_force"))
            .bind_uniform::<NodalLoad>("load", buffers.uniform("nodal_force".into(), &load.bytes()))
            .column(Mass::NAME, buffers.column(body, Mass::NAME))
            .column(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME))
            .of_rows(force.on.rows.clone());
        let stage = with_factors(stage, &force.on.factors, buffers);
        stages.push(stage.with_step(world).loaded(true));
    }
    stages
}

/// Adds what a load is multiplied with at each of its rows along each axis; empty: 1 at all.
pub(super) fn with_factors(stage: NodeStage, factors: &[[f64; 3]], buffers: &mut dyn Buffers) -> NodeStage {
    if factors.is_empty() {
        let text = "fn factor_of(i: u32) -> vec3<f32> {\n    return vec3<f32>(1.0);\n}\n";
        return stage.own(Fragment::new("generated: the same load on all nodes", text));
    }
    let factors: Vec<f32> = factors.iter().flatten().map(|&factor| factor as f32).collect();
    let factors = buffers.constants("factors of a load".into(), bytemuck::cast_slice(&factors));
    stage.own(shader!("load_factor")).bind("factors", factors)
}
