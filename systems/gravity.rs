//! `gravity`: mass times acceleration on every node. `shaders/gravity.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::stage::{Stage, with_factors};
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::components::*;
use crate::math::{LANES, SimdScalar};
use bevy_ecs::prelude::*;
use pulp::{Simd, WithSimd};
use serde::Serialize;
use std::sync::Arc;

/// Gravity on the body: the acceleration (m/s²) is a signal.
#[derive(Component, Clone, Debug, Serialize)]
pub struct Gravity {
    /// What it is multiplied with at each row along each axis; empty: 1 at all.
    #[serde(skip)]
    factors: Arc<Vec<[f64; 3]>>,
    signal: usize,
}

/// Adds m g to the external forces.
pub fn system() -> System {
    System::built_in_nodes::<Gravity>(
        "gravity",
        Phase::Loads,
        "adds mass times acceleration to the external forces",
        "`Gravity(...)` under `loads`",
        |world| super::registry::count::<Gravity>(world, "gravity load", "gravity loads"),
    )
    .for_load(|on, signal| Some(Gravity { factors: on.all()?.clone(), signal }))
    .with_shader::<Gravity>("shaders/gravity.wgsl", include_str!("../shaders/gravity.wgsl"))
}

impl NodeSystem for Gravity {
    type Columns = (&'static Mass, &'static mut ExternalForce);
    type Prepared = [f64; 4];

    fn stages(&self, _: Entity, _: &World) -> Vec<Stage> {
        vec![with_factors(Stage::default(), &self.factors)]
    }

    fn prepare(&self, before: &Before<'_>) -> [f64; 4] {
        before.signals.values()[self.signal]
    }

    /// None: it depends on the mass alone.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, acceleration: &[f64; 4], cpu: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let (first, mass) = (nodes.first, nodes.mass());
        let Some(external) = nodes.external_force_mut() else { return };
        if self.factors.is_empty() {
            cpu.dispatch_widest(Pull { mass, acceleration: acceleration.map(T::from_f64), external });
            return;
        }
        let of_rows = mass.iter().zip(&self.factors[first..]).zip(external.as_chunks_mut::<3>().0);
        for ((mass, factors), external) in of_rows {
            for i in 0..3 {
                external[i] += *mass * (T::from_f64(factors[i]) * T::from_f64(acceleration[i]));
            }
        }
    }
}

struct Pull<'a, T> {
    mass: &'a [T],
    acceleration: [T; 4],
    external: &'a mut [T],
}

impl<T: SimdScalar> WithSimd for Pull<'_, T> {
    type Output = ();

    /// A register full of components at a time.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let width = T::width::<S>();
        let components: [T; 3 * LANES] = std::array::from_fn(|at| self.acceleration[at % 3]);
        let acceleration = [0, 1, 2].map(|k| T::load(simd, &components[k * width..]));
        for (mass, external) in self.mass.chunks(width).zip(self.external.chunks_mut(3 * width)) {
            let mass = T::broadcast3(T::load_part(simd, mass));
            for ((mass, acceleration), external) in mass.into_iter().zip(acceleration).zip(external.chunks_mut(width)) {
                T::store_part(T::load_part(simd, external) + mass * acceleration, external);
            }
        }
    }
}
