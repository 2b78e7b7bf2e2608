//! Long runs, small numbers, far places.

use super::super::Trial;
use super::fibres::fastest_step;
use glam::DVec3;
use sinew::Error;
use sinew::Simulation;

fn largest(u: &[DVec3]) -> f64 {
    u.iter().fold(0.0, |largest, u| largest.max(u.length()))
}

/// H20.
pub fn denormals(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    let start = if trial.full { fastest_step(&mut simulation)? } else { 0.0 };
    simulation.advance_to(if trial.full { 35.0 } else { 2.0 })?;
    let left = largest(&simulation.displacements("body")?);
    trial.most("what is left of the swing (m)", left, 1e-6);
    if trial.full {
        trial.most("step in the tail over step at the start", fastest_step(&mut simulation)? / start, 1.5);
    }
    Ok(())
}

/// H21.
pub fn long_run(trial: &mut Trial<'_>) -> Result<(), Error> {
    let steps: u64 = match (trial.full, trial.configuration.is_gpu()) {
        _ if trial.is_implicit() => 10_000,
        (true, _) => 10_000_000,
        (_, true) => 30_000,
        _ => 100_000,
    };
    // a sample of a GPU costs a download
    let every = if trial.configuration.is_gpu() { 6 } else { 1 };
    let mut simulation = trial.start(&[])?;
    let first = ringing(&mut simulation, every)?;
    let at = simulation.step_count();
    simulation.advance(steps - at - WINDOW)?;
    let last = ringing(&mut simulation, every)?;
    trial.most("drift of the frequency", last.0 / first.0 - 1.0, 1e-3);
    trial.most("drift of energy", last.1 / first.1 - 1.0, trial.bound(1e-3, 1e-2));
    let exact = simulation.step_count() == steps && simulation.time() == steps as f64 * 1e-4;
    trial.holds("t = n·Δt", exact);
    Ok(())
}

/// Steps that are sampled.
const WINDOW: u64 = 1500;

/// Frequency (Hz) from the zero crossings of the top's displacement, and the mean energy (J), over the next steps,
/// sampled every so many.
fn ringing(simulation: &mut Simulation, every: u64) -> Result<(f64, f64), Error> {
    let mut crossings = Vec::new();
    let (mut before, mut energy, mut samples) = (0.0, 0.0, 0);
    for sample in 0..WINDOW / every {
        let step = every * sample;
        simulation.advance(every)?;
        let u: f64 = simulation.displacements("body")?.iter().map(|u| u.z).sum();
        if before < 0.0 && u >= 0.0 {
            crossings.push(step as f64 - every as f64 * u / (u - before));
        }
        before = u;
        if sample.is_multiple_of(if every > 1 { 8 } else { 16 }) {
            let e = simulation.energies()?;
            (energy, samples) = (energy + e.kinetic + e.strain + e.hourglass, samples + 1);
        }
    }
    let periods = crossings.len().saturating_sub(1) as f64;
    let time = (crossings.last().unwrap_or(&0.0) - crossings.first().unwrap_or(&0.0)) * simulation.time_step();
    Ok((periods / time, energy / f64::from(samples)))
}

/// H22.
pub fn spin(trial: &mut Trial<'_>) -> Result<(), Error> {
    let turns: f64 = if trial.full { 1000.0 } else { 10.0 };
    let turn = std::f64::consts::TAU / DVec3::new(20.0, 0.0, 59.6).length();
    let mut simulation = trial.start(&[format!("duration={}", turns * turn)])?;
    simulation.advance(1)?;
    // velocities of implicit steps are those of their ends
    let half = if trial.is_implicit() { 0.0 } else { 0.5 * simulation.time_step() };
    let start = angular_momentum(&mut simulation, half)?;
    simulation.finish()?;
    let end = angular_momentum(&mut simulation, half)?;
    trial.most("change of angular momentum", (end - start).length() / start.length(), trial.bound(1e-10, 1e-5));
    Ok(())
}

/// Σ m x × v (kg m²/s) as long before the end of the last step (s) as velocities are.
fn angular_momentum(simulation: &mut Simulation, before: f64) -> Result<DVec3, Error> {
    let (rest, masses) = (simulation.rest_positions("body")?, simulation.masses("body")?);
    let fields = simulation.fields("body")?;
    let of = |node: usize| {
        let velocity = fields.velocity[node];
        masses[node] * (rest[node] + fields.displacement[node] - before * velocity).cross(velocity)
    };
    Ok((0..rest.len()).map(of).sum())
}

/// H23.
pub fn far_away(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut swings = Vec::new();
    for place in ["(1e4, -2e4, 7e3)", "(0, 0, 0)"] {
        let mut simulation = trial.start(&[format!("bodies.body.translate={place}")])?;
        simulation.finish()?;
        swings.push(simulation.displacements("body")?);
    }
    let difference = swings[0].iter().zip(&swings[1]).fold(0.0_f64, |worst, (a, b)| worst.max((*a - *b).length()));
    trial.most("difference of displacements", difference / largest(&swings[1]), 1e-5);
    // it flies 1e4 m: f64 keeps its strains, f32 says that it does not
    let free = ["constraints=[]", "loads=[]", "bodies.body.translate=(0, 0, 0)", "bodies.body.velocity=(5e4, 0, 0)"];
    let mut flies = trial.start(&free.map(String::from))?;
    flies.finish()?;
    let warned = flies.guards().warnings.iter().any(|notice| notice.criterion == "rounding");
    trial.holds("strains rounded in flight are warned of, in f32 alone", warned != trial.configuration.is_f64());
    if trial.configuration.is_f64() {
        let strained =
            flies.fields("body")?.volume_ratio.iter().fold(0.0_f64, |largest, j| largest.max((j - 1.0).abs()));
        trial.most("change of volume after 1e4 m", strained, 1e-4);
    }
    Ok(())
}

/// H33.
pub fn nothing_loaded(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    let steps = if trial.configuration.is_gpu() { 3000 } else { 10_000 };
    simulation.advance(if trial.full { 100_000 } else { steps })?;
    trial.most("largest displacement over length", largest(&simulation.displacements("body")?) / 0.1, 1e-7);
    Ok(())
}
