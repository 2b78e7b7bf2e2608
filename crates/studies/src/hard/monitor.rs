//! Gates G1 to G3 along a run.

use super::Trial;
use sinew::Error;
use sinew::Simulation;
use sinew::components::Energies;

/// Samples of a run.
const SAMPLES: u64 = 40;

/// What was seen along a run of the body `body`.
#[derive(Clone, Debug)]
pub struct Monitor {
    /// The largest imbalance of energy, as G2 has it.
    pub imbalance: f64,
    /// The least J of all elements and samples.
    pub least_j: f64,
    /// The least and the largest mean J of all elements: ΣV/V₀ in meshes of equal elements.
    pub volume: [f64; 2],
    /// The largest displacement (m).
    pub largest: f64,
    /// Hourglass energy over strain energy, at the sample where both together were largest.
    pub hourglass: f64,
    most_held: f64,
    held: f64,
    moved: f64,
}

impl Monitor {
    /// Takes the rest of a run's steps, sampling it on the way.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn run(simulation: &mut Simulation) -> Result<Self, Error> {
        let mut monitor = Self::begin(simulation)?;
        for samples_left in (1..=SAMPLES).rev() {
            // how many steps are left changes with their length
            let left = simulation.planned_steps().saturating_sub(simulation.step_count());
            simulation.advance_towards_end(left.div_ceil(samples_left))?;
            monitor.sample(simulation)?;
        }
        simulation.finish()?;
        monitor.sample(simulation)?;
        Ok(monitor)
    }

    /// Begins at the present state.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn begin(simulation: &mut Simulation) -> Result<Self, Error> {
        let energies = simulation.energies()?;
        let held = held(&energies) - work_done(&energies);
        Ok(Self {
            imbalance: 0.0,
            least_j: f64::INFINITY,
            volume: [f64::INFINITY, f64::NEG_INFINITY],
            largest: 0.0,
            hourglass: 0.0,
            most_held: 0.0,
            held,
            moved: held.abs(),
        })
    }

    /// Samples the present state.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn sample(&mut self, simulation: &mut Simulation) -> Result<(), Error> {
        let e = simulation.energies()?;
        let scale =
            [e.kinetic + e.strain + e.hourglass, work_done(&e).abs(), self.moved].into_iter().fold(0.0, f64::max);
        if scale > 0.0 {
            self.imbalance = self.imbalance.max((held(&e) - work_done(&e) - self.held).abs() / scale);
        }
        if e.strain + e.hourglass > self.most_held {
            self.most_held = e.strain + e.hourglass;
            self.hourglass = e.hourglass / e.strain;
        }
        let fields = simulation.fields("body")?;
        let there = || fields.volume_ratio.iter().zip(&fields.alive).filter(|(_, alive)| **alive == 1).map(|(j, _)| *j);
        let mean = there().sum::<f64>() / (there().count().max(1) as f64);
        self.least_j = there().fold(self.least_j, f64::min);
        self.volume = [self.volume[0].min(mean), self.volume[1].max(mean)];
        self.largest = fields.displacement.iter().fold(self.largest, |largest, u| largest.max(u.length()));
        Ok(())
    }
}

/// What bodies hold or have given away.
fn held(e: &Energies) -> f64 {
    e.kinetic + e.strain + e.hourglass + e.removed + e.damping_loss.unwrap_or(0.0) + e.scheme_loss.unwrap_or(0.0)
}

/// What was put in.
fn work_done(e: &Energies) -> f64 {
    e.load_work.unwrap_or(0.0) + e.constraint_work.unwrap_or(0.0)
}

impl Trial<'_> {
    /// Runs to the end, and asks for the balance of energy (G2) and for J above a limit (G3).
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn run(&mut self, simulation: &mut Simulation, least_j: f64) -> Result<Monitor, Error> {
        let monitor = Monitor::run(simulation)?;
        self.most("imbalance of energy", monitor.imbalance, self.bound(0.01, 0.02));
        self.least("least J", monitor.least_j, least_j);
        Ok(monitor)
    }
}
