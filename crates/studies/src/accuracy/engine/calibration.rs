//! What a configuration will cost, from a few steps of its kind, and from what its kind has cost so far.

use super::Engine;
use super::march::{self, FIELDS, Sampling, refusal};
use super::variant::{reactions, variant};
use crate::accuracy::configuration::{Configuration, Digits, Factor};
use crate::accuracy::method::Method;
use crate::accuracy::solver::{Cost, Refusal, Solution};
use sinew::Simulation;
use std::time::Instant;

/// Steps are timed for this long to predict with (s).
const CALIBRATION: f64 = 0.04;

/// The share of the time left that one search for equilibrium may take to tell how many steps it needs.
const SEARCH_SHARE: f64 = 0.05;

/// Elements of the scene that are enough to predict with.
const ENOUGH: f64 = 3000.0;

/// Implicit steps that are timed at least: the first one is none like the others.
const IMPLICIT_STEPS: u64 = 4;

/// By which power of the cells along an edge an implicit step takes more passes over all forces: those of two levels
/// grow from 21 to 30 where a mesh has 2.1 times the cells.
pub(super) const MORE_PASSES: f64 = 0.5;

/// Steps of a search for equilibrium that are timed at once: it checks itself that often.
const STEPS_BETWEEN_CHECKS: u64 = 40;

/// How many times as many steps a search takes that was given up before anything could be seen of its end.
const UNKNOWN: f64 = 20.0;

/// What a configuration has shown.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    mesh: Factor,
    elements: f64,
    /// The step as the scene wants it (s).
    step: f64,
    /// Steps of a search for equilibrium.
    steps: f64,
    seconds_a_step: f64,
    /// Time beside steps (s).
    overhead: f64,
    /// What bringing the bodies to rest before the first step takes (s), once.
    preload: f64,
}

/// How often a run that is done once brings bodies to rest: to find its step, and to take it.
const PRELOADS: f64 = 2.0;

/// The kind of a configuration: all of it that changes what an element and step costs, and how many steps a search
/// takes.
fn kind_of(configuration: &Configuration) -> Configuration {
    Configuration { mesh: Factor::ONE, step: 1, hourglass: 1.0, ..configuration.clone() }
}

impl Engine<'_> {
    /// What a configuration costs, by its kind's calibration: elements grow with the third power of the mesh, steps
    /// with the first.
    pub(super) fn cost(&mut self, configuration: &Configuration) -> Result<Cost, Refusal> {
        let known = self.calibrate(configuration)?;
        let finer = configuration.mesh.value() / known.mesh.value();
        let growth = finer.powi(3);
        let duration = self.file.scene.duration;
        let is_implicit = configuration.method.is_implicit();
        let shrinks = if is_implicit { 1.0 } else { finer.max(1e-9) };
        let most = known.step / shrinks / f64::from(configuration.step);
        let steps = match self.file.scene.is_static() {
            // waves must cross the body so many times, and take a step a cell
            true => known.steps * finer,
            false if is_implicit => (duration / Sampling::whole(duration, most)).round(),
            false => {
                (duration / self.sampling.as_ref().map_or(most, |sampling| sampling.fitting(duration, most))).round()
            }
        };
        let passes = if is_implicit { finer.powf(MORE_PASSES) } else { 1.0 };
        let run = steps * known.seconds_a_step * growth * passes;
        let again = if run < 0.1 { 3.0 } else { 1.0 };
        // bodies are brought to rest by a search: it takes a step a cell, too
        let preload = (PRELOADS + again - 1.0) * known.preload * growth * finer;
        let elements = (known.elements * growth) as u64;
        Ok(Cost { seconds: again * run + known.overhead * growth + preload, elements, steps: steps as u64 })
    }

    /// Keeps what a run has shown of its kind, for predictions of finer meshes: `all` is what it took, all in all (s).
    pub(super) fn learn(&mut self, configuration: &Configuration, solution: &Solution, all: f64) {
        let kind = kind_of(configuration);
        let known = self.known.iter_mut().find(|(known, _)| *known == kind);
        let Some((_, known)) = known.filter(|(_, known)| configuration.mesh >= known.mesh) else { return };
        if configuration.step == 1 && solution.steps > 0 {
            let overhead = all - f64::from(solution.timed) * solution.seconds;
            let preload = solution.preload.min(overhead.max(0.0));
            let often = PRELOADS + f64::from(solution.timed) - 1.0;
            *known = Calibration {
                mesh: configuration.mesh,
                elements: solution.elements as f64,
                step: solution.time_step,
                steps: solution.steps as f64,
                seconds_a_step: solution.seconds / solution.steps as f64,
                overhead: (overhead - often * preload).max(0.0),
                preload,
            };
        }
    }

    /// The finest mesh that is quickly made: of a handful of elements a step costs what it would cost without any.
    fn quickly_made(&mut self) -> Result<Factor, Refusal> {
        let meshes = self.sound_meshes()?;
        // the first is the scene as it is written
        let elements =
            self.known.first().map_or(f64::INFINITY, |(_, known)| known.elements / known.mesh.value().powi(3));
        let small = |factor: &Factor| elements * factor.value().powi(3) <= ENOUGH;
        Ok(meshes.into_iter().filter(small).max().unwrap_or(Factor::ONE))
    }

    /// What a few steps show of a configuration, on a mesh that is quickly made.
    pub(super) fn calibrate(&mut self, configuration: &Configuration) -> Result<Calibration, Refusal> {
        let kind = kind_of(configuration);
        if let Some((_, known)) = self.known.iter().find(|(known, _)| *known == kind) {
            return Ok(*known);
        }
        let mut calibration = self.timed_steps(&kind)?;
        if self.file.scene.is_static() {
            calibration.steps = self.steps_of_a_search(&kind)? * calibration.mesh.value();
        }
        self.known.push((kind, calibration));
        Ok(calibration)
    }

    fn timed_steps(&mut self, kind: &Configuration) -> Result<Calibration, Refusal> {
        let mesh = self.quickly_made()?;
        self.check_time()?;
        let started = Instant::now();
        let on_mesh = Configuration { mesh, ..kind.clone() };
        // the step of heavier masses is that of the usual ones and more
        let longer = match kind.method {
            Method::HeavierMasses(_) => Some(self.step(&on_mesh, &self.options(&on_mesh))?),
            _ => None,
        };
        let scene = variant(self.file, &on_mesh, longer);
        let mut simulation = Simulation::new(&scene, &self.options(&on_mesh)).map_err(refusal)?;
        simulation.settle().map_err(refusal)?;
        let preload = simulation.preload().map_or(0.0, |preload| preload.seconds);
        let summary = simulation.summary("calibration").map_err(refusal)?;
        let setup = (started.elapsed().as_secs_f64() - preload).max(0.0);
        let found = self.file.scene.integration.safety * summary.stable_step;
        let explicit = || longer.unwrap_or(self.file.scene.integration.step.map_or(found, |step| step.min(found)));
        let step = kind.method.longest_step().unwrap_or_else(explicit);
        let steps = simulation.planned_steps();
        if self.sampling.is_none() {
            let steps = (self.file.scene.duration / step * kind.mesh.value() / mesh.value()) as u64;
            self.sampling = Some(Sampling::new(self.file, &reactions(&self.file.scene), steps));
        }
        let each = if scene.scene.is_static() { STEPS_BETWEEN_CHECKS } else { 1 };
        let (mut taken, mut count) = (0.0, each);
        let least = if kind.method.is_implicit() { IMPLICIT_STEPS } else { 0 };
        while (taken < CALIBRATION || simulation.step_count() < least)
            && simulation.step_count() < steps
            && !simulation.is_finished()
        {
            self.check_time()?;
            let now = count.min(steps - simulation.step_count());
            taken += march::timed(&mut simulation, now)?;
            count = if scene.scene.is_static() { each } else { (count * 2).min(4000) };
        }
        // where steps are chosen by their errors, of the longest as many as were simulated
        let count = match kind.method {
            Method::Adaptive { step, .. } => simulation.time() / step,
            _ => simulation.step_count() as f64,
        };
        let seconds_a_step = if count > 0.0 { taken / count } else { taken };
        let started = Instant::now();
        simulation.energies().map_err(refusal)?;
        let one = started.elapsed().as_secs_f64();
        // energies are sampled a few times as often as fields; setting up happens once more to find the step
        let samples = self.sampling.as_ref().map_or(FIELDS, |sampling| sampling.count).min(60);
        let overhead = 2.0 * setup + one * samples as f64;
        Ok(Calibration { mesh, elements: summary.elements as f64, step, steps: 0.0, seconds_a_step, overhead, preload })
    }

    /// How many steps a search for equilibrium takes on the scene's own mesh. Nobody knows before: it is gone through,
    /// or as far as time allows, on a mesh that stands for the others. Kinds that differ in the element or the law take
    /// what the scene's own kind takes with the same number type.
    fn steps_of_a_search(&mut self, kind: &Configuration) -> Result<f64, Refusal> {
        let own = self.base(self.kinds.as_deref().unwrap_or_default());
        let digits = Configuration { digits: kind.digits, place: kind.place, method: kind.method, ..kind_of(&own) };
        let alike = |c: &Configuration| {
            c.method == kind.method && (c.digits == Digits::Double) == (kind.digits == Digits::Double)
        };
        let known = self.known.iter().find(|(known, _)| *known == digits);
        let known = known.or_else(|| self.known.iter().find(|(known, _)| alike(known)));
        if let Some((_, known)) = known {
            return Ok(known.steps / known.mesh.value());
        }
        let share = SEARCH_SHARE * self.time_left();
        let mesh = self.sound_meshes()?.into_iter().find(|mesh| !self.single_layers().contains(mesh));
        let mesh = mesh.unwrap_or(Factor::ONE);
        let on_mesh = Configuration { mesh, ..kind.clone() };
        let mut simulation =
            Simulation::new(&variant(self.file, &on_mesh, None), &self.options(&on_mesh)).map_err(refusal)?;
        let (most, mut taken, mut first) = (simulation.planned_steps(), 0.0, None);
        while taken < share && simulation.step_count() < most && !simulation.is_finished() {
            self.check_time()?;
            // (one that breaks down is told of when it is its turn to run)
            let Ok(seconds) = march::timed(&mut simulation, STEPS_BETWEEN_CHECKS) else { break };
            taken += seconds;
            first = first.or_else(|| simulation.equilibrium().map(|found| found.residual).filter(|r| r.is_finite()));
        }
        let done = simulation.step_count() as f64 / mesh.value();
        let found = simulation.equilibrium().filter(|_| !simulation.is_finished());
        let Some((found, first)) = found.zip(first) else { return Ok(done) };
        // a residual falls by the same factor in the same time
        let fallen = (first / found.residual).ln() / (first / found.tolerance).ln();
        let share = if fallen.is_finite() { fallen.clamp(1.0 / UNKNOWN, 1.0) } else { 1.0 / UNKNOWN };
        Ok(done / share)
    }
}
