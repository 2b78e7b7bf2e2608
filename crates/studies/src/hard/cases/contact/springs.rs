//! Springs in place of the kinematic law: what they give back, and how stiff they may be.

use super::super::super::Trial;
use super::measures::mass;
use sinew::Error;
use std::f64::consts::PI;

/// The share of its speed that a point keeps that is thrown back by a spring of a damping ratio that does not pull.
fn restitution(damping: f64) -> f64 {
    let rest = (1.0 - damping * damping).sqrt();
    let angle = PI - (2.0 * damping * rest).atan2(1.0 - 2.0 * damping * damping);
    (-damping / rest * angle).exp()
}

/// H51.
pub fn restitution_of_nodes(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(speed, side, density) in trial.some(&[(0.1, 0.02, 1000.0), (0.03, 0.008, 400.0)]) {
        let elements = trial.configuration.elements_name();
        // ten steps and a third away
        let (step, away) = (1e-4, 1.03e-3 * speed);
        let sets = [
            format!("bodies.body.mesh=Box(size: ({side}, {side}, {side}), cells: (1, 1, 1), elements: {elements})"),
            format!("bodies.body.translate=(0, 0, {away})"),
            format!("bodies.body.velocity=(0, 0, -{speed})"),
            format!("materials.nothing.density={density}"),
        ];
        let mut simulation = trial.start(&sets)?;
        simulation.advance_to(12.0 * step + 1e-9)?;
        let stopped = simulation.probe("struck")?[2];
        let what = |what: &str| format!("{what}, at {speed} m/s");
        // of f32 the last digit of a place of 2 cm in a step of .1 ms
        trial.most(what("kinematic: what two steps leave (m/s)"), stopped, trial.bound(1e-9, 2e-5));
        // how a spring gives back depends on where in a step it is met, the less the softer it is
        for (share, damping, off) in [(0.1, 0.0, 0.005), (0.01, 0.1, 0.02), (0.01, 0.3, 0.02), (0.01, 0.5, 0.02)] {
            let law = format!("contacts[0].law=Penalty(share: {share}, damping: {damping})");
            let mut simulation = trial.start(&[&sets[..], &[law]].concat())?;
            simulation.finish()?;
            let (back, expected) = (simulation.probe("struck")?[2] / speed, restitution(damping));
            let what = what(&format!("given back, share {share}, damping {damping}"));
            trial.within(what, back, expected - off, expected + off);
        }
    }
    Ok(())
}

/// H52.
pub fn stiffest(trial: &mut Trial<'_>) -> Result<(), Error> {
    let safety: f64 = 0.9;
    let stiffest = 4.0 * (1.0 - safety * safety);
    let elements = trial.configuration.elements_name();
    let sets = |share: f64| {
        let law = |number: usize| format!("contacts[{number}].law=Penalty(share: {share})");
        // both act on the lower block
        let mesh = |body: &str| format!("bodies.{body}.mesh.elements={elements}");
        vec![mesh("body"), mesh("other"), law(0), law(1)]
    };
    let mut simulation = trial.start(&sets(0.95 * 0.5 * stiffest))?;
    simulation.advance(if trial.full { 100_000 } else { 5000 })?;
    let weight = 9.81 * mass(&mut simulation, "body")?;
    // at the bound they rattle, with periods of two steps and more: means
    let (steps, mut table, mut other) = (1000, 0.0, 0.0);
    for _ in 0..steps {
        simulation.advance(1)?;
        table -= simulation.tool("table")?.force.z / f64::from(steps);
        other += simulation.contact("other")?.force.z / f64::from(steps);
    }
    trial.near("weight of both on the table (N)", table, 2.0 * weight, 0.01);
    trial.near("weight of one on the other (N)", other, weight, 0.01);
    trial.refused(
        "a spring that is too stiff for the step",
        trial.start(&sets(1.1 * 0.5 * stiffest)),
        &["share", "0.76"],
    );
    Ok(())
}
