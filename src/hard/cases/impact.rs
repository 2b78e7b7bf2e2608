//! A cube that falls on a plate that pushes back: a custom system, as users write them.

use super::super::Trial;
use crate::components::{Displacement, ExternalForce, RestPosition};
use crate::error::Error;
use crate::systems::{Phase, Registry, System};
use bevy_ecs::prelude::*;

/// What the scene says under `parameters`.
#[derive(Resource, serde::Deserialize)]
struct Plate {
    /// Force a depth and node (N/m).
    stiffness: f64,
}

/// Pushes nodes up that are below z = 0.
fn plate(plate: Res<Plate>, mut bodies: Query<(&RestPosition, &Displacement, &mut ExternalForce)>) {
    for (rest, u, mut force) in &mut bodies {
        for row in 0..rest.0.len() {
            let height = rest.0[row].z + u.vector(row).z;
            if height < 0.0 {
                let mut sum = force.vector(row);
                sum.z -= plate.stiffness * height;
                force.set_vector(row, sum);
            }
        }
    }
}

/// H26.
pub fn impact(trial: &mut Trial<'_>) -> Result<(), Error> {
    let registry = Registry::default()
        .with(System::custom("plate", Phase::Loads, "pushes up what is below z = 0", plate).with_parameters::<Plate>());
    let (young, cell) = (1e7, 0.0125);
    let nodal = if trial.configuration.elements_name() == "Tet4NodalPressure" { "\"nodal_volume\", " } else { "" };
    let schedule = format!("schedule=[{nodal}\"element_forces\", \"gather\", \"plate\", \"integrate\", \"observe\"]");
    // with a system on the host every step of a GPU goes there and back
    let few = trial.configuration.is_gpu() && !trial.full;
    for &speed in if few { &[50.0][..] } else { &[10.0, 50.0][..] } {
        for &times in if few { &[10.0][..] } else { &[1.0, 10.0, 100.0][..] } {
            let stiffness = times * young * cell;
            let mut sets = vec![
                schedule.clone(),
                format!("parameters={{\"plate\": (stiffness: {stiffness:e})}}"),
                format!("bodies.body.velocity=(0, 0, -{speed})"),
            ];
            let mut alone = trial.start_with(&sets, &registry)?;
            // ω² ≤ ω_e² + k/m: the lightest node bears the plate alone
            let lightest = alone.masses("body")?.into_iter().fold(f64::INFINITY, f64::min);
            let square = 1.0 / alone.time_step().powi(2) + 0.25 * stiffness / lightest;
            drop(alone);
            // a fifth of it, or the energy in the plate cannot be told from the end of a step
            sets.push(format!("integration.step={:e}", 0.2 / square.sqrt()));
            let mut simulation = trial.start_with(&sets, &registry)?;
            let start = simulation.energies()?.kinetic;
            let name = format!("{speed} m/s, penalty ×{times}");
            let (mut deepest, mut most) = (0.0_f64, 0.0_f64);
            for looks_left in (1..=30).rev() {
                let left = simulation.planned_steps().saturating_sub(simulation.step_count());
                let ended = simulation.advance_towards_end(left.div_ceil(looks_left));
                if ended.is_err() {
                    trial.stops(&name, ended, &["element"]);
                    break;
                }
                let (rest, fields) = (simulation.rest_positions("body")?, simulation.fields("body")?);
                // energies are those of the middle of the step
                let half = 0.5 * simulation.time_step();
                let height = |node: usize| rest[node].z + fields.displacement[node].z - half * fields.velocity[node].z;
                let depth = |node: usize| (-height(node)).max(0.0);
                let held: f64 = (0..rest.len()).map(|node| 0.5 * stiffness * depth(node).powi(2)).sum();
                let e = simulation.energies()?;
                most = most.max(e.kinetic + e.strain + e.hourglass + held);
                deepest = (0..rest.len()).map(depth).fold(deepest, f64::max);
            }
            if deepest > 0.0 {
                trial.most(format!("energy over that at the start, {name}"), most / start, 1.01);
                trial.report(format!("deepest in cells, {name}"), deepest / cell);
            }
        }
    }
    Ok(())
}
