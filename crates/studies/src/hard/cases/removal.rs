//! Bodies that lose elements.

use super::super::Trial;
use glam::DVec3;
use sinew::Error;
use sinew::Simulation;

/// Mass (kg) and centre of mass (m) of the nodes below a height.
fn below(simulation: &mut Simulation, height: f64) -> Result<(f64, DVec3), Error> {
    let (rest, u, mass) =
        (simulation.rest_positions("body")?, simulation.displacements("body")?, simulation.masses("body")?);
    let mut sum = (0.0, DVec3::ZERO);
    for node in (0..rest.len()).filter(|&node| rest[node].z < height) {
        sum = (sum.0 + mass[node], sum.1 + mass[node] * (rest[node] + u[node]));
    }
    Ok((sum.0, sum.1 / sum.0))
}

/// H17.
pub fn islands(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    let initial: f64 = simulation.masses("body")?.iter().sum();
    simulation.advance_to(0.025)?;
    let mut heights = Vec::new();
    let interval = simulation.planned_steps() / 5;
    for _ in 0..3 {
        heights.push((simulation.time(), below(&mut simulation, 0.0201)?.1.z));
        simulation.advance(interval)?;
    }
    // steps need not be of one length
    let speed = |i: usize| (heights[i + 1].1 - heights[i].1) / (heights[i + 1].0 - heights[i].0);
    let acceleration = 2.0 * (speed(1) - speed(0)) / (heights[2].0 - heights[0].0);
    trial.near("acceleration of the island", acceleration, -9.81, trial.bound(1e-7, 1e-3));
    simulation.finish()?;
    let summary = simulation.summary("finished")?;
    let left: f64 = simulation.masses("body")?.iter().sum();
    trial.most("mass left and removed less that at the start", (left + summary.removed_mass) / initial - 1.0, 1e-6);
    trial.near("removed mass", summary.removed_mass, initial / 3.0, 1e-6);
    let masses = simulation.masses("body")?;
    let rest = simulation.rest_positions("body")?;
    let inactive = (0..rest.len()).filter(|&node| (rest[node].z - 0.03).abs() < 1e-6).all(|node| masses[node] == 0.0);
    trial.holds("nodes without elements are inactive", inactive);
    Ok(())
}

/// H18.
pub fn everything(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    let initial: f64 = simulation.masses("body")?.iter().sum();
    simulation.advance_to(0.07)?;
    let inactive = simulation.displacements("body")?;
    simulation.finish()?;
    let summary = simulation.summary("finished")?;
    trial.near("removed mass", summary.removed_mass, initial, 1e-6);
    let finite = inactive.iter().all(|u| u.is_finite());
    trial.holds("nodes stay where they were left", finite && inactive == simulation.displacements("body")?);
    trial.holds("nothing weighs any more", simulation.masses("body")?.iter().all(|&mass| mass == 0.0));
    Ok(())
}
