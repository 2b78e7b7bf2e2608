//! Waves that contact sends: bars that meet, a cube that is dropped.

use super::super::super::Trial;
use super::measures::{gone, kinetic_and_spent, last_window, mass, momentum, of_waves};
use sinew::Error;
use sinew::Simulation;

const SIDE: f64 = 0.01;
const DENSITY: f64 = 1000.0;
const POISSON: f64 = 0.45;
const G: f64 = 9.81;

/// A bar: its length (m), Young's modulus (Pa), cells along it.
type Bar = (f64, f64, u32);

const BARS: [Bar; 3] = [(0.1, 3e3, 40), (0.1, 3e3, 80), (0.03, 5e4, 50)];

/// Velocity of a wave in a bar (m/s).
fn wave((_, young, _): Bar) -> f64 {
    (of_waves(young, POISSON) / DENSITY).sqrt()
}

/// How fast the bars meet: strains of .3 % (m/s).
fn speed(bar: Bar) -> f64 {
    0.006 * wave(bar)
}

/// What was felt during a run.
struct Hit {
    first: f64,
    last: f64,
    /// The mean force (N) in the middle half of the contact that is expected.
    mean: f64,
    impulse: f64,
    least: f64,
}

/// Runs for 1.4 times the time that two waves along the bar take, and notes the force (N) that `felt` tells.
fn hit(
    simulation: &mut Simulation,
    expected: f64,
    felt: impl Fn(&mut Simulation) -> Result<f64, Error>,
) -> Result<Hit, Error> {
    let mut hit = Hit { first: f64::NAN, last: 0.0, mean: 0.0, impulse: 0.0, least: 0.0 };
    let mut count = 0.0;
    while simulation.time() < 1.4 * expected {
        simulation.advance(1)?;
        let (force, time) = (felt(simulation)?, simulation.time());
        hit.impulse += force * last_window(simulation);
        hit.least = hit.least.min(force);
        if force > 0.0 {
            hit.last = time;
            hit.first = if hit.first.is_nan() { time } else { hit.first };
        }
        if (0.25 * expected..0.75 * expected).contains(&time) {
            (hit.mean, count) = (hit.mean + force, count + 1.0);
        }
    }
    hit.mean /= count;
    Ok(hit)
}

/// H39.
pub fn two_bars(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &bar in trial.some(&BARS) {
        let (length, young, cells) = bar;
        let (c, v) = (wave(bar), speed(bar));
        let mesh = |elements: &str| {
            format!("Box(size: ({SIDE}, {SIDE}, {length}), cells: (1, 1, {cells}), elements: {elements})")
        };
        let elements = trial.configuration.elements_name();
        let sets = [
            format!("bodies.body.mesh={}", mesh(elements)),
            format!("bodies.other.mesh={}", mesh(elements)),
            format!("bodies.other.translate=(0, 0, {})", 1.0001 * length),
            format!("bodies.other.velocity=(0, 0, {})", -v),
            format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: {POISSON})"),
        ];
        let mut simulation = trial.start(&sets)?;
        let all = mass(&mut simulation, "other")? * v;
        let duration = 2.0 * length / c;
        let hit = hit(&mut simulation, duration, |simulation| Ok(simulation.contact("other")?.force.z))?;
        let what = |what: &str| format!("{what}, {cells} layers of {young} Pa");
        trial.within(what("time of contact over 2L/c"), (hit.last - hit.first) / duration, 0.99, 1.02);
        let force = DENSITY * c * SIDE * SIDE * v / 2.0;
        trial.near(what("force (N)"), hit.mean, force, 0.015);
        trial.holds(what("nothing pulls"), hit.least >= 0.0);
        let low = momentum(&mut simulation, "body")?.z;
        let high = momentum(&mut simulation, "other")?.z;
        trial.near(what("momentum that has gone over (kg m/s)"), low, -all, 0.02);
        trial.near(what("impulse (N s)"), hit.impulse, all, 0.02);
        trial.most(what("momentum of both, change"), (low + high) / all + 1.0, trial.bound(1e-10, 1e-5));
        let share = kinetic_and_spent(&mut simulation)? / (0.5 * all * v);
        trial.within(what("energy left"), share, 1.0 - 1.0 / f64::from(cells), 1.001);
    }
    Ok(())
}

/// H40.
pub fn bar_on_plane(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &bar in trial.some(&BARS) {
        let (length, young, cells) = bar;
        let (c, v) = (wave(bar), speed(bar));
        let elements = trial.configuration.elements_name();
        let sets = [
            format!(
                "bodies.body.mesh=Box(size: ({SIDE}, {SIDE}, {length}), cells: (1, 1, {cells}), elements: {elements})"
            ),
            format!("bodies.body.translate=(0, 0, {})", 1e-4 * length),
            format!("bodies.body.velocity=(0, 0, {})", -v),
            format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: {POISSON})"),
        ];
        let mut simulation = trial.start(&sets)?;
        let mass = mass(&mut simulation, "body")?;
        let duration = 2.0 * length / c;
        let hit = hit(&mut simulation, duration, |simulation| Ok(-simulation.tool("wall")?.force.z))?;
        let what = |what: &str| format!("{what}, {cells} layers of {young} Pa");
        trial.within(what("time of contact over 2L/c"), (hit.last - hit.first) / duration, 0.99, 1.03);
        trial.near(what("force (N)"), hit.mean, DENSITY * c * SIDE * SIDE * v, 0.015);
        trial.holds(what("nothing pulls"), hit.least >= 0.0);
        let after = momentum(&mut simulation, "body")?.z;
        trial.near(what("impulse (N s)"), hit.impulse, after + mass * v, trial.bound(1e-9, 1e-4));
        trial.near(what("rebound (m/s)"), after / mass, v, if cells < 80 { 0.03 } else { 0.02 });
        let share = kinetic_and_spent(&mut simulation)? / (0.5 * mass * v * v);
        trial.within(what("energy left"), share, 1.0 - 1.0 / f64::from(cells), 1.001);
    }
    Ok(())
}

/// H44.
pub fn drop(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(layers, height) in trial.some(&[(4_u32, 2e-3), (8, 5e-4), (2, 4e-3)]) {
        let sets = [
            format!("bodies.body.mesh.cells=({layers}, {layers}, {layers})"),
            format!("bodies.body.translate=(0, 0, {height})"),
            // what is told of the touching layer is told two steps later, and must be over before the layers above it
            // bring more: by the stable step, which takes .6 of the time of a wave through a layer, what is lost comes
            // to 1.15 of the half layer's, where 1.05 are allowed. And of one length, so that velocities are those of
            // the middle of steps at both ends
            format!("integration=(step: {}, when_unstable: Watch)", 0.1 * 0.02 / f64::from(layers) / wave(BARS[0])),
        ];
        let mut simulation = trial.start(&sets)?;
        let (mass, weight) = (mass(&mut simulation, "body")?, -G * mass(&mut simulation, "body")?);
        // with what is left of the height that it falls from
        let energy = |simulation: &mut Simulation| -> Result<f64, Error> {
            Ok(kinetic_and_spent(simulation)? - weight * gone(simulation, "body")?.z)
        };
        let (mut before, mut impulse) = (0.0, 0.0);
        let felt = |simulation: &mut Simulation| -> Result<f64, Error> { Ok(-simulation.tool("table")?.force.z) };
        simulation.advance(1)?;
        let start = (momentum(&mut simulation, "body")?.z, simulation.time());
        while felt(&mut simulation)? == 0.0 && simulation.time() < 1.0 {
            before = energy(&mut simulation)?;
            simulation.advance(1)?;
            impulse += felt(&mut simulation)? * simulation.time_step();
        }
        let what = |what: &str| format!("{what}, {layers} layers from {height} m");
        let arrives = (2.0 * height / G).sqrt();
        let late = (simulation.time() - arrives) / simulation.time_step();
        trial.most(what("steps between arrival and √(2H/g)"), late, 2.0);
        for _ in 0..2 {
            simulation.advance(1)?;
            impulse += felt(&mut simulation)? * simulation.time_step();
        }
        let lost = (before - energy(&mut simulation)?) / (mass * G * height);
        let layer = 1.0 / (2.0 * f64::from(layers));
        // and up to φ(1 − φ) of a step's internal work, φ the part of a step that is left before they touch
        trial.within(what("energy lost of the touching half layer's"), lost / layer, 0.5, 1.05);
        let end = simulation.time() + 0.01;
        while simulation.time() < end {
            simulation.advance(1)?;
            impulse += felt(&mut simulation)? * simulation.time_step();
        }
        let gained = momentum(&mut simulation, "body")?.z - start.0 - weight * (simulation.time() - start.1);
        trial.near(what("impulse (N s)"), impulse, gained, trial.bound(1e-9, 1e-4));
    }
    Ok(())
}
