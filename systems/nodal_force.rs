//! `nodal_force`: forces on chosen nodes. `shaders/nodal_force.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::kernel::{Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::math::Scalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Adds a force to each of the load's nodes that has mass: a parked node bears nothing.
pub fn system() -> System {
    System::built_in(
        "nodal_force",
        Phase::Loads,
        "adds forces on chosen nodes to the external forces",
        "`NodalForce(...)` under `loads`",
        |world| super::registry::count::<NodalForce>(world, "nodal force", "nodal forces"),
        nodal_force,
    )
    .on_device(kernels)
}

fn nodal_force(
    signals: Res<Signals>,
    loads: Query<(&NodalForce, &OfBody)>,
    mut bodies: Query<(&Mass, &mut ExternalForce)>,
) {
    for (load, body) in &loads {
        let Ok((mass, mut external)) = bodies.get_mut(body.0) else { continue };
        let force = signals.values()[load.signal];
        match &mut external.0 {
            Reals::F32(external) => push(&load.rows, force, mass.slice(), external),
            Reals::F64(external) => push(&load.rows, force, mass.slice(), external),
        }
    }
}

fn push<T: Scalar>(rows: &[u32], force: [f64; 4], mass: &[T], external: &mut [T]) {
    for row in rows.iter().map(|&row| row as usize).filter(|&row| mass[row] > T::default()) {
        for i in 0..3 {
            external[3 * row + i] += T::from_f64(force[i]);
        }
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct NodalLoad {
    count: u32,
    signal: u32,
}
uniform!(NodalLoad { count, signal });

/// One kernel for each load.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let loads: Vec<(NodalForce, Entity)> =
        world.query::<(&NodalForce, &OfBody)>().iter(world).map(|(load, body)| (load.clone(), body.0)).collect();
    let mut kernels = Vec::new();
    for (force, body) in loads {
        let load = NodalLoad { count: force.rows.len() as u32, signal: force.signal as u32 };
        let kernel = Kernel::new("nodal_force", "nodal_force")
            .fragment(shader!("nodal_force"))
            .fragment(shader!("loads"))
            .fragment(shader!("row"))
            .bind_uniform::<NodalLoad>("load", buffers.uniform("nodal_force".into(), &load.bytes()))
            .bind("rows", buffers.constants("rows of nodal_force".into(), bytemuck::cast_slice(&force.rows)))
            .bind(Mass::NAME, buffers.column(body, Mass::NAME))
            .bind(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME))
            .threads(load.count);
        kernels.push(with_step(kernel, world));
    }
    kernels
}
