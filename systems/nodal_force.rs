//! `nodal_force`: forces on chosen nodes. `shaders/nodal_force.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::stage::{Stage, with_factors};
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::components::*;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::sync::Arc;

/// A force (N), a signal, on each of some nodes.
#[derive(Component, Clone, Debug, Serialize)]
pub struct NodalForce {
    /// The nodes.
    #[serde(skip)]
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
    .with_shader::<NodalForce>("shaders/nodal_force.wgsl", include_str!("../shaders/nodal_force.wgsl"))
}

impl NodeSystem for NodalForce {
    type Columns = (&'static Mass, &'static mut ExternalForce);
    type Prepared = [f64; 4];

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.on.rows)
    }

    fn stages(&self, _: Entity, _: &World) -> Vec<Stage> {
        vec![with_factors(Stage::of(self.rows()), &self.on.factors)]
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
