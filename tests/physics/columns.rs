//! What kernels have written, in the author's order.

use glam::DVec3;
use sinew::Simulation;
use sinew::backend::device::bring_to_host;
use sinew::components::{
    Authoring, Column, DisplacementIncrement, ExternalForce, InertialMass, InternalForce, Mass, Reals,
};

fn column<C: Column + std::ops::Deref<Target = Reals>>(simulation: &mut Simulation, body: &str) -> Vec<DVec3> {
    let entity = simulation.body(body).unwrap();
    bring_to_host(simulation.world_mut(), |_, name| name == C::NAME).unwrap();
    let world = simulation.world();
    let column = world.get::<C>(entity).unwrap();
    world.get::<Authoring>(entity).unwrap().node_rows.iter().map(|&row| column.vector(row as usize)).collect()
}

/// Forces of elements on nodes (N), at the beginning of the last step.
pub fn internal_forces(simulation: &mut Simulation, body: &str) -> Vec<DVec3> {
    column::<InternalForce>(simulation, body)
}

/// Loads on nodes (N), at the beginning of the last step.
pub fn external_forces(simulation: &mut Simulation, body: &str) -> Vec<DVec3> {
    column::<ExternalForce>(simulation, body)
}

/// Velocities (m/s) in the middle of the last step.
pub fn velocities(simulation: &mut Simulation, body: &str) -> Vec<DVec3> {
    let time_step = simulation.time_step();
    column::<DisplacementIncrement>(simulation, body).into_iter().map(|step| step / time_step).collect()
}

/// Positions (m).
pub fn positions(simulation: &mut Simulation, body: &str) -> Vec<DVec3> {
    let rest = simulation.rest_positions(body).unwrap();
    rest.iter().zip(simulation.displacements(body).unwrap()).map(|(&x, u)| x + u).collect()
}

/// Masses of nodes (kg).
pub fn masses(simulation: &mut Simulation, body: &str) -> Vec<f64> {
    numbers::<Mass>(simulation, body)
}

/// What nodes move with (kg), where mass is scaled.
pub fn inertia(simulation: &mut Simulation, body: &str) -> Vec<f64> {
    numbers::<InertialMass>(simulation, body)
}

fn numbers<C: Column + std::ops::Deref<Target = Reals>>(simulation: &mut Simulation, body: &str) -> Vec<f64> {
    let entity = simulation.body(body).unwrap();
    bring_to_host(simulation.world_mut(), |_, name| name == C::NAME).unwrap();
    let world = simulation.world();
    let column = world.get::<C>(entity).unwrap();
    world.get::<Authoring>(entity).unwrap().node_rows.iter().map(|&row| column.get(row as usize)).collect()
}
