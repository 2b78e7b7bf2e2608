//! Whether implicit steps would pay, from numbers of the scene: how fast loads act, how fast bodies swing, and what a
//! few steps take.

use super::wording::{count, digits, quantity};
use serde::Serialize;
use sinew::scene::schema::{Attachment, Axis, Constraint, Curve, ImplicitScheme, Scene};
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation};
use sinew_studies::accuracy::Method;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// What implicit Euler would take.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    /// Its step (s).
    pub step: f64,
    /// Passes over all forces from start to end, by those of the first steps.
    pub passes: u64,
    /// Those of explicit steps.
    pub explicit_passes: u64,
    /// How fast bodies swing in the shape that they are loaded into (Hz): Rayleigh's quotient.
    pub frequency: f64,
    /// The error of the step over time of a single mass that swings so, loaded as the scene is: root mean square, as a
    /// share of the largest value.
    pub error: f64,
}

impl Advice {
    /// In words.
    pub fn text(&self) -> String {
        format!(
            "loads are slow (what they act on swings at about {} Hz): implicit steps of {} take some {} passes over all \
             forces in place of {}, for an error of about {} %\n  try --set 'solver=Implicit(step: {})'; sinew \
             accuracy tells what it costs\n",
            digits(self.frequency),
            quantity(self.step, "s"),
            count(self.passes),
            count(self.explicit_passes),
            digits(100.0 * self.error),
            self.step
        )
    }
}

/// The largest error of a step that is worth a word.
const ERROR: f64 = 0.01;
/// The least share of passes that has to be saved for it.
const SAVED: f64 = 0.5;
/// How many steps are tried.
const TRIED: u64 = 10;
/// Elements from which on trying takes too long for a look.
const MOST_ELEMENTS: usize = 50_000;

/// What implicit steps would take in place of the explicit ones of a simulation, if they pay by much. None for bodies
/// that nothing at rest holds: what carries them moves them far and strains them little, by how it quickens.
///
/// # Errors
/// None for what implicit steps cannot do: there is no advice then.
pub fn implicit(file: &SceneFile, explicit: &mut Simulation) -> Result<Option<Advice>, Error> {
    let scene = explicit.scene().clone();
    let summary = explicit.summary("not run")?;
    let curves: Vec<&Curve> = scene.curves().into_iter().map(|(_, curve)| curve).collect();
    let told_by_programs = curves.iter().any(|curve| matches!(curve, Curve::Input { .. }));
    let of_this_scene = Method::of(&scene) == Method::Explicit && !told_by_programs && !curves.is_empty();
    if !of_this_scene || summary.elements > MOST_ELEMENTS || !are_held(&scene) {
        return Ok(None);
    }
    let explicit_passes = summary.planned_steps;
    let mut steps: Vec<f64> = Method::of_motion(scene.duration, summary.time_step, TRIED)
        .into_iter()
        .filter_map(|method| match method {
            Method::Implicit { scheme: ImplicitScheme::Euler, step, linearized: false } => Some(step),
            _ => None,
        })
        .collect();
    steps.sort_by(|a, b| b.total_cmp(a));
    // what turns about what holds it would be said to swing too slowly to swing at all
    let swings = |trial: &Trial| trial.frequency * scene.duration >= 1.0;
    let Some(first) = steps.first().and_then(|&step| tried(file, step)).filter(swings) else { return Ok(None) };
    let error = |step: f64| {
        let worst = curves.iter().map(|curve| error_of_a_mass(curve, first.frequency, step, scene.duration));
        worst.fold(0.0, f64::max)
    };
    let Some((step, error)) = steps.into_iter().map(|step| (step, error(step))).find(|(_, error)| *error <= ERROR)
    else {
        return Ok(None);
    };
    let Some(trial) = (if step == first.step { Some(first) } else { tried(file, step) }) else { return Ok(None) };
    let passes = (trial.passes_a_step * scene.duration / step).ceil() as u64;
    let pays = (passes as f64) < (1.0 - SAVED) * explicit_passes as f64;
    Ok(pays.then_some(Advice { step, passes, explicit_passes, frequency: first.frequency, error }))
}

/// Whether each body is held along all axes by nodes that do not move, or is tied or glued to one that is.
fn are_held(scene: &Scene) -> bool {
    let fixes = |constraint: &Constraint, name: &String, axis: &Axis| match constraint {
        Constraint::Fixed { body, axes, .. } => body.as_ref().is_none_or(|body| body == name) && axes.contains(axis),
        Constraint::Prescribed { .. } => false,
    };
    let is_fixed = |name: &String, axis: &Axis| scene.constraints.iter().any(|one| fixes(one, name, axis));
    let are_fixed = |name: &String| [Axis::X, Axis::Y, Axis::Z].iter().all(|axis| is_fixed(name, axis));
    let mut held: BTreeSet<&String> = scene.bodies.keys().filter(|&name| are_fixed(name)).collect();
    let mut before = None;
    while before != Some(held.len()) {
        before = Some(held.len());
        for attachment in &scene.attachments {
            let (one, other) = match attachment {
                Attachment::Tie { from, to, .. } => (from.body.as_ref(), to.body.as_ref()),
                Attachment::Glue { bodies: (one, other), .. } => (Some(one), Some(other)),
                Attachment::Grasp { .. } | Attachment::Suture { .. } => continue,
            };
            if let (Some(one), Some(other)) = (one, other)
                && (held.contains(one) || held.contains(other))
            {
                held.extend([one, other]);
            }
        }
    }
    held.len() == scene.bodies.len()
}

/// What a few steps showed.
#[derive(Clone, Copy)]
struct Trial {
    step: f64,
    passes_a_step: f64,
    frequency: f64,
}

/// Takes a few implicit Euler steps; `None` where that cannot be, or nothing moves.
fn tried(file: &SceneFile, step: f64) -> Option<Trial> {
    let mut file = file.clone();
    Method::Implicit { scheme: ImplicitScheme::Euler, step, linearized: false }.apply(&mut file.scene, None);
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let mut simulation = Simulation::new(&file, &options).ok()?;
    simulation.advance_towards_end(TRIED).ok()?;
    let taken = simulation.implicit_steps()?;
    let passes_a_step = taken.passes as f64 / taken.steps as f64;
    let energies = simulation.energies().ok()?;
    let names: Vec<String> = file.scene.bodies.keys().cloned().collect();
    let mut moved = 0.0;
    for name in names {
        let (masses, ways) = (simulation.masses(&name).ok()?, simulation.displacements(&name).ok()?);
        moved += masses.iter().zip(ways).map(|(mass, u)| mass * u.length_squared()).sum::<f64>();
    }
    let frequency = (2.0 * (energies.strain + energies.hourglass) / moved).sqrt() / TAU;
    (frequency.is_finite() && frequency > 0.0 && passes_a_step.is_finite()).then_some(Trial {
        step,
        passes_a_step,
        frequency,
    })
}

/// The error over time of implicit Euler for a mass on a spring without damping, u″ + ω²u = ω²f(t), against steps so
/// short that theirs does not count: root mean square over that of the largest value.
fn error_of_a_mass(curve: &Curve, frequency: f64, step: f64, duration: f64) -> f64 {
    let square = (TAU * frequency).powi(2);
    // central differences of a fiftieth of a period, 2π²/3/50² off in phase, a whole number in a step
    let parts = (step * frequency * 50.0).ceil().max(50.0);
    let short = step / parts;
    let (mut exact, mut rate) = (0.0, 0.0);
    let (mut euler, mut euler_rate) = (0.0, 0.0);
    let (mut sum, mut largest, mut count) = (0.0_f64, 0.0_f64, 0.0);
    for number in 0..(duration / step).round() as u64 {
        let from = number as f64 * step;
        for part in 0..parts as u64 {
            let middle = from + (part as f64 + 0.5) * short;
            exact += 0.5 * short * rate;
            rate += short * square * (curve.value(middle) - exact);
            exact += 0.5 * short * rate;
        }
        let end = from + step;
        euler_rate = (euler_rate + step * square * (curve.value(end) - euler)) / (1.0 + step * step * square);
        euler += step * euler_rate;
        sum += (euler - exact).powi(2);
        largest = largest.max(exact.abs());
        count += 1.0;
    }
    let error = (sum / count).sqrt() / largest;
    if error.is_finite() { error } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass of 72 Hz under a load that grows smoothly within seven periods, and under one that is there at once.
    #[test]
    fn slow_loads_have_small_errors_and_sudden_ones_have_not() {
        let slow = Curve::Smooth { start: 0.0, end: 0.1 };
        let of = |curve: &Curve, step: f64| error_of_a_mass(curve, 72.0, step, 0.2);
        assert!(of(&slow, 0.01) < 2e-3, "{}", of(&slow, 0.01));
        assert!(of(&Curve::default(), 0.01) > 0.1, "{}", of(&Curve::default(), 0.01));
        assert_eq!(of(&Curve::Table(vec![(0.0, 0.0)]), 0.01), f64::INFINITY, "what nothing loads has no error");
    }

    /// Who is glued or tied to what is held is held; who hangs on a thread, or is held along one axis, may be carried.
    #[test]
    fn bodies_are_held_by_what_does_not_move() {
        let held = |constraints: &str, attachments: &str| {
            let mesh = "mesh: Box(size: (1, 1, 1), cells: (1, 1, 1))";
            let body = |name: &str| format!("\"{name}\": ({mesh}, material: \"m\")");
            let text = format!(
                "(duration: 1, bodies: {{{}, {}, {}}},
                materials: {{\"m\": (density: 1, neo_hookean: Young(young: 1, poisson: 0))}},
                constraints: [{constraints}], attachments: [{attachments}])",
                body("a"),
                body("b"),
                body("c")
            );
            let file = SceneFile::from_memory("held.ron", &text, Default::default(), &[]);
            are_held(&file.unwrap().scene)
        };
        let (fixed, glue) = ("Fixed(body: \"c\", on: All)", "Glue(bodies: (\"a\", \"b\"))");
        let ends = "from: (body: \"b\", at: (0, 0, 0)), to: (body: \"c\", at: (0, 0, 0))";
        assert!(held(fixed, &format!("{glue}, Tie({ends})")));
        assert!(!held(fixed, glue));
        assert!(!held(fixed, &format!("{glue}, Suture({ends}, stiffness: 1)")));
        assert!(held("Fixed(on: All)", "") && !held("Fixed(on: All, axes: [X])", ""));
        assert!(held("Fixed(on: All, axes: [X, Y]), Fixed(on: All, axes: [Z])", ""));
        assert!(!held("Prescribed(on: All, displacement: (0, 0, 1), curve: Smooth(end: 1))", ""));
    }

    /// Of a smooth load errors of the first order halve with the step.
    #[test]
    fn errors_of_slow_loads_shrink_with_the_step() {
        let quick = Curve::Smooth { start: 0.0, end: 0.1 };
        let [long, short] = [2e-3, 1e-3].map(|step| error_of_a_mass(&quick, 10.0, step, 0.1));
        assert!(short < 0.6 * long && short > 0.4 * long, "{long} {short}");
    }
}
