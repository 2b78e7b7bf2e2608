//! `gravity`: mass times acceleration on every node. `shaders/gravity.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::kernel::{Uniform, uniform};
use crate::backend::node_stage::NodeStage;
use crate::components::*;
use crate::math::Scalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Adds m g to the external forces.
pub fn system() -> System {
    System::built_in(
        "gravity",
        Phase::Loads,
        "adds mass times acceleration to the external forces",
        "`Gravity(...)` under `loads`",
        |world| super::registry::count::<Gravity>(world, "gravity load", "gravity loads"),
        gravity,
    )
    .on_nodes(stages)
}

fn gravity(signals: Res<Signals>, loads: Query<(&Gravity, &OfBody)>, mut bodies: Query<(&Mass, &mut ExternalForce)>) {
    for (load, body) in &loads {
        let Ok((mass, mut external)) = bodies.get_mut(body.0) else { continue };
        let acceleration = signals.values()[load.signal];
        match &mut external.0 {
            Reals::F32(external) => pull(mass.slice(), acceleration, external),
            Reals::F64(external) => pull(mass.slice(), acceleration, external),
        }
    }
}

/// Pulls at all nodes that the columns have.
pub(super) fn pull<T: Scalar>(mass: &[T], acceleration: [f64; 4], external: &mut [T]) {
    let acceleration = [0, 1, 2].map(|i| T::from_f64(acceleration[i]));
    for (force, &mass) in external.chunks_exact_mut(3).zip(mass) {
        for i in 0..3 {
            force[i] += mass * acceleration[i];
        }
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct GravityLoad {
    signal: u32,
}
uniform!(GravityLoad { signal });

/// One stage for each load.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let loads: Vec<(usize, Entity)> =
        world.query::<(&Gravity, &OfBody)>().iter(world).map(|(load, body)| (load.signal, body.0)).collect();
    let mut stages = Vec::new();
    for (signal, body) in loads {
        let count = world.get::<Mass>(body).map_or(0, |mass| mass.len()) as u32;
        let load = GravityLoad { signal: signal as u32 };
        let stage = NodeStage::new("gravity", "gravity", body, count, shader!("gravity"))
            .bind_uniform::<GravityLoad>("load", buffers.uniform("gravity".into(), &load.bytes()))
            .column(Mass::NAME, buffers.column(body, Mass::NAME))
            .column(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME));
        stages.push(stage.with_step(world).loaded(true));
    }
    stages
}
