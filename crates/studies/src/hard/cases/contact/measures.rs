//! What contact cases measure.

use super::super::super::Trial;
use glam::DVec3;
use sinew::Error;
use sinew::Simulation;
use sinew::components::{Clock, DisplacementIncrement};

/// Displacements of all nodes of a body in the last step (m), in the author's order.
pub fn steps(simulation: &mut Simulation, body: &str) -> Result<Vec<DVec3>, Error> {
    let view = simulation.column::<DisplacementIncrement>(body)?;
    Ok(view.node_rows().iter().map(|&row| view.values().vector(row as usize)).collect())
}

/// Momentum of a body (kg m/s), in the middle of the last step.
pub fn momentum(simulation: &mut Simulation, body: &str) -> Result<DVec3, Error> {
    let (masses, rate) = (simulation.masses(body)?, 1.0 / simulation.time_step());
    Ok(masses.iter().zip(steps(simulation, body)?).map(|(mass, step)| step * rate * *mass).sum())
}

/// Momentum (kg m/s) of bodies and its moment about the origin (kg m²/s), in the middle of the last step.
pub fn moments(simulation: &mut Simulation, bodies: &[&str]) -> Result<[DVec3; 2], Error> {
    let mut sums = [DVec3::ZERO; 2];
    for body in bodies {
        let (masses, rest) = (simulation.masses(body)?, simulation.rest_positions(body)?);
        let (u, steps) = (simulation.displacements(body)?, steps(simulation, body)?);
        let rate = 1.0 / simulation.time_step();
        for node in 0..rest.len() {
            let momentum = steps[node] * rate * masses[node];
            sums[0] += momentum;
            sums[1] += (rest[node] + u[node] - 0.5 * steps[node]).cross(momentum);
        }
    }
    Ok(sums)
}

/// How far the centre of mass of a body has gone (m), in the middle of the last step.
pub fn gone(simulation: &mut Simulation, body: &str) -> Result<DVec3, Error> {
    let (masses, u, steps) = (simulation.masses(body)?, simulation.displacements(body)?, steps(simulation, body)?);
    let sum: DVec3 = (0..u.len()).map(|node| masses[node] * (u[node] - 0.5 * steps[node])).sum();
    Ok(sum / masses.iter().sum::<f64>())
}

/// The mass of a body (kg).
pub fn mass(simulation: &mut Simulation, body: &str) -> Result<f64, Error> {
    Ok(simulation.masses(body)?.iter().sum())
}

/// Kinetic energy and what was spent on elements (J): what the equations of motion keep exactly.
pub fn kinetic_and_spent(simulation: &mut Simulation) -> Result<f64, Error> {
    let energies = simulation.energies()?;
    Ok(energies.kinetic + energies.internal_work.unwrap_or(0.0))
}

/// Where nodes of a body are (m).
pub fn places(simulation: &mut Simulation, body: &str) -> Result<Vec<DVec3>, Error> {
    let (rest, u) = (simulation.rest_positions(body)?, simulation.displacements(body)?);
    Ok(rest.iter().zip(u).map(|(rest, u)| *rest + u).collect())
}

/// How long (s) forces of the last step acted: from the middle of the step before, whatever their lengths were.
pub fn last_window(simulation: &Simulation) -> f64 {
    let clock = simulation.world().resource::<Clock>();
    let (from, to) = clock.window_at(clock.step - 1);
    to - from
}

/// The modulus of a wave along a bar whose sides are held, λ + 2μ (Pa), from Young's modulus and Poisson's ratio.
pub fn of_waves(young: f64, poisson: f64) -> f64 {
    young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
}

impl Trial<'_> {
    /// The values that give another body the elements of the configuration.
    pub fn elements_of(&self, bodies: &[&str]) -> Vec<String> {
        let name = self.configuration.elements_name();
        bodies.iter().map(|body| format!("bodies.{body}.mesh.elements={name}")).collect()
    }

    /// All there is of a list in full and where that is quickest, else its first.
    pub fn some<'a, T>(&self, all: &'a [T]) -> &'a [T] {
        if self.is_thorough() { all } else { &all[..1] }
    }
}
