//! Fibres far stiffer than tissue, squeezed, and without weight.

use super::super::Trial;
use super::point::Law;
use sinew::Error;
use sinew::Simulation;
use std::time::Instant;

const AREA: f64 = 1e-4;

/// H12.
pub fn stiff_fibres(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    simulation.finish()?;
    let law = Law { shear: 1e3, bulk: 1e4, fibres: 1e6 };
    trial.near("pull at a stretch of 1.02", simulation.probe("pull")?[0], law.free(1.02) * AREA, 1e-3);
    if trial.is_implicit() {
        return Ok(());
    }
    let transient = "analysis=Transient".to_string();
    let with = trial.start(std::slice::from_ref(&transient))?.time_step();
    let without = trial.start(&[transient, "materials.tendon.fibres.eta=0".into()])?.time_step();
    trial.most("step with fibres over step without", with / without, 0.2);
    Ok(())
}

/// H13.
pub fn squeezed_fibres(trial: &mut Trial<'_>) -> Result<(), Error> {
    let law = Law { fibres: 2000.0, ..Law::young(3000.0, 0.45) };
    let (across, pushed) = law.free_with_sides(0.5);
    let gradient = format!("((-0.5, 0, 0), (0, {0}, 0), (0, 0, {0}))", across - 1.0);
    let mut simulation = trial.start(&[format!("constraints[0].gradient={gradient}")])?;
    simulation.finish()?;
    // P = J σ / λ
    for stress in simulation.fields("body")?.stress {
        trial.near("stress at half the length", stress[0] * across * across, pushed, 1e-4);
    }
    Ok(())
}

/// H34.
pub fn zero_weights(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut with = trial.start(&[])?;
    let mut without = trial.start(&[
        "materials.tissue=(density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))".into(),
        "loads=[Gravity(acceleration: (0, 0, -9.81))]".into(),
    ])?;
    with.finish()?;
    without.finish()?;
    let (a, b) = (with.displacements("body")?, without.displacements("body")?);
    trial.holds("the same bits as without", a == b && with.time_step() == without.time_step());
    if trial.full {
        // by turns, for other work on the machine comes and goes
        let (mut first, mut second) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..20 {
            first = first.min(fastest_step(&mut with)?);
            second = second.min(fastest_step(&mut without)?);
        }
        trial.most("step time with over without", first / second, 1.03);
    }
    Ok(())
}

/// The shortest time of a step (s) in a hundred rounds.
pub fn fastest_step(simulation: &mut Simulation) -> Result<f64, Error> {
    let mut fastest = f64::INFINITY;
    for _ in 0..100 {
        let started = Instant::now();
        simulation.advance(20)?;
        fastest = fastest.min(started.elapsed().as_secs_f64() / 20.0);
    }
    Ok(fastest)
}
