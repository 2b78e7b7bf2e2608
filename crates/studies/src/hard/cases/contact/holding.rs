//! What is held by forceps.

use super::super::super::Trial;
use super::measures::mass;
use sinew::components::DisplacementIncrement;
use sinew::{Error, Simulation};

/// Momentum of the body along z (kg m/s), in the middle of the last step.
fn rising(simulation: &mut Simulation) -> Result<f64, Error> {
    let (masses, rate) = (simulation.masses("body")?, 1.0 / simulation.time_step());
    let view = simulation.column::<DisplacementIncrement>("body")?;
    let rows = view.node_rows().iter().zip(masses);
    Ok(rows.map(|(&row, mass)| view.values().vector(row as usize).z * rate * mass).sum())
}

/// Kinetic energy and what elements hold (J).
fn energy(simulation: &mut Simulation) -> Result<f64, Error> {
    let energies = simulation.energies()?;
    Ok(energies.kinetic + energies.strain + energies.hourglass)
}

/// H61.
pub fn grasp(trial: &mut Trial<'_>) -> Result<(), Error> {
    let elements = format!("bodies.body.mesh.elements={}", trial.configuration.elements_name());
    let mut simulation = trial.start(&[elements])?;
    let weight = 9.81 * mass(&mut simulation, "body")?;
    let largest = 0.03 * weight;
    simulation.advance_to(0.88)?;
    let (mut before, mut jump) = (energy(&mut simulation)?, 0.0_f64);
    while simulation.time() < 0.95 {
        simulation.advance(1)?;
        let now = energy(&mut simulation)?;
        jump = jump.max((now - before).abs() / largest);
        before = now;
    }
    trial.most("energy that closing makes or takes, of the largest", jump, trial.bound(1e-6, 1e-5));
    trial.holds("it is closed", simulation.tool("forceps")?.nodes == 16);
    simulation.advance_to(2.65)?;
    let reading = simulation.tool("forceps")?;
    trial.near("weight that hangs on it (N)", -reading.force.z, weight, 1e-4);
    trial.most("force aside, of the weight", reading.force.truncate().length() / weight, 1e-4);
    trial.holds("the table bears nothing", simulation.tool("table")?.nodes == 0);
    simulation.advance_to(2.79)?;
    let mut jump = 0.0_f64;
    let mut before = rising(&mut simulation)?;
    while simulation.time() < 2.81 {
        simulation.advance(1)?;
        let now = rising(&mut simulation)?;
        // gravity and damping take no more in a step
        let bound = (1.01 * weight + 20.0 * before.abs()) * simulation.time_step();
        jump = jump.max((now - before).abs() / bound);
        before = now;
    }
    trial.most("change of momentum in a step while it opens, of what weight and damping make", jump, 1.0);
    trial.holds("it is open", simulation.tool("forceps")?.nodes == 0);
    Ok(())
}
