//! What a configuration will cost, from a few steps of its kind.

use super::Engine;
use super::march::{self, FIELDS, Looks, refusal};
use super::variant::{reactions, variant};
use crate::Simulation;
use crate::accuracy::configuration::{Configuration, Factor};
use crate::accuracy::solver::{Cost, Refusal};
use std::time::Instant;

/// Steps are timed for this long to predict with (s).
const CALIBRATION: f64 = 0.04;

/// Elements of the scene that are enough to predict with.
const ENOUGH: f64 = 3000.0;

/// Steps of a search for equilibrium that are timed at once: it looks at itself that often.
const BETWEEN_LOOKS: u64 = 40;

/// What a few steps of a configuration have shown.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    mesh: Factor,
    elements: f64,
    /// The step as the scene wants it (s).
    step: f64,
    /// Steps taken: of a search for equilibrium all.
    steps: u64,
    setup: f64,
    seconds_a_step: f64,
    look: f64,
}

impl Engine<'_> {
    /// What a configuration costs, by its kind's calibration: elements grow with the third power of the mesh, steps with the
    /// first.
    pub(super) fn cost(&mut self, configuration: &Configuration) -> Result<Cost, Refusal> {
        let known = self.calibrate(configuration)?;
        let finer = configuration.mesh.value() / known.mesh.value();
        let elements = known.elements * finer.powi(3);
        let duration = self.file.scene.duration;
        let looks = self.looks.as_ref().map_or(FIELDS, |looks| looks.count);
        let most = known.step / finer.max(1e-9) / f64::from(configuration.step);
        let steps = match self.file.scene.is_static() {
            // waves must cross the body so many times, and take a step a cell
            true => known.steps as f64 * finer,
            false => (duration / self.looks.as_ref().map_or(most, |looks| looks.fitting(duration, most))).round(),
        };
        let growth = finer.powi(3);
        let run = steps * known.seconds_a_step * growth;
        let again = if run < 0.1 { 3.0 } else { 1.0 };
        // energies are looked at a few times as often as fields, and setting up happens once more to find the step
        let beside = known.setup * growth * (again + 1.0) + known.look * growth * (looks as f64).min(60.0);
        Ok(Cost { seconds: again * run + beside, elements: elements as u64, steps: steps as u64 })
    }

    /// A mesh that is quickly made and large enough to tell of elements instead of what a step costs without any.
    fn mesh_to_calibrate_on(&self, configuration: &Configuration) -> Factor {
        let meshes = self.meshes();
        if self.file.scene.is_static() {
            // a coarse mesh may lack the nodes that the scene speaks of
            let stands = |mesh: &&Factor| {
                let kind = Configuration { mesh: **mesh, ..configuration.clone() };
                Simulation::new(&variant(self.file, &kind, None), &self.options(&kind)).is_ok()
            };
            return meshes.iter().find(stands).copied().unwrap_or(Factor::ONE);
        }
        // the first is the scene as it is written
        let elements = self.known.first().map_or(f64::INFINITY, |(_, known)| known.elements);
        let small = |factor: &&Factor| elements * factor.value().powi(3) <= ENOUGH;
        meshes.iter().filter(small).copied().fold(Factor::ONE, Factor::max)
    }

    /// What a few steps show of a configuration, on a mesh that is quickly made.
    pub(super) fn calibrate(&mut self, configuration: &Configuration) -> Result<Calibration, Refusal> {
        let mesh = self.mesh_to_calibrate_on(configuration);
        let kind = Configuration { mesh, step: 1, hourglass: 1.0, ..configuration.clone() };
        if let Some((_, known)) = self.known.iter().find(|(known, _)| *known == kind) {
            return Ok(*known);
        }
        if (self.interrupted)() {
            return Err(Refusal::Interrupted);
        }
        let wanted = self.file.scene.integration.step;
        let scene = variant(self.file, &kind, None);
        let mut simulation = Simulation::new(&scene, &self.options(&kind)).map_err(refusal)?;
        let summary = simulation.summary("calibration").map_err(refusal)?;
        let found = self.file.scene.integration.safety * summary.stable_step;
        let step = wanted.map_or(found, |step| step.min(found));
        let steps = simulation.planned_steps();
        if self.looks.is_none() {
            let steps = (self.file.scene.duration / step) as u64;
            self.looks = Some(Looks::new(self.file, &reactions(&self.file.scene), steps));
        }
        // of a search for equilibrium nobody knows how many steps it takes: it is gone through, on the coarsest mesh
        let enough = if scene.scene.is_static() { f64::INFINITY } else { CALIBRATION };
        let (mut taken, mut count) = (0.0, 1);
        while taken < enough && simulation.step_count() < steps && !simulation.is_finished() {
            if (self.interrupted)() {
                return Err(Refusal::Interrupted);
            }
            let now = count.min(steps - simulation.step_count());
            taken += march::timed(&mut simulation, now)?;
            count = (count * 2).min(4000);
        }
        let all_steps = simulation.step_count();
        let seconds_a_step = taken / all_steps.max(1) as f64;
        let started = Instant::now();
        simulation.energies().map_err(refusal)?;
        let look = started.elapsed().as_secs_f64();
        let (elements, setup) = (summary.elements as f64, summary.setup_seconds);
        let mut calibration = Calibration { mesh, elements, step, steps: all_steps, setup, seconds_a_step, look };
        if scene.scene.is_static() {
            calibration = self.priced_by_elements(&kind, calibration).unwrap_or(calibration);
        }
        self.known.push((kind, calibration));
        Ok(calibration)
    }

    /// What a search for equilibrium has shown on the coarsest mesh, with times from the largest that is quickly made: of a
    /// handful of elements a step costs what it would cost without any, and many of them would seem dearer than they are.
    /// `None` where there is no such mesh, or it breaks down so soon.
    fn priced_by_elements(&self, kind: &Configuration, known: Calibration) -> Option<Calibration> {
        let times = |factor: &Factor| (factor.value() / known.mesh.value()).powi(3);
        let enough = |factor: &Factor| known.elements * times(factor) <= ENOUGH;
        let mesh = self.meshes().into_iter().filter(enough).fold(known.mesh, Factor::max);
        if mesh == known.mesh {
            return None;
        }
        let larger = Configuration { mesh, ..kind.clone() };
        let mut simulation = Simulation::new(&variant(self.file, &larger, None), &self.options(&larger)).ok()?;
        let setup = simulation.summary("calibration").ok()?.setup_seconds;
        let mut taken = 0.0;
        while taken < CALIBRATION && simulation.step_count() < known.steps && !simulation.is_finished() {
            taken += march::timed(&mut simulation, BETWEEN_LOOKS).ok()?;
        }
        let seconds_a_step = taken / simulation.step_count().max(1) as f64;
        let started = Instant::now();
        simulation.energies().ok()?;
        let look = started.elapsed().as_secs_f64();
        let share = 1.0 / times(&mesh);
        Some(Calibration { setup: share * setup, seconds_a_step: share * seconds_a_step, look: share * look, ..known })
    }
}
