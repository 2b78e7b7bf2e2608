//! Runs a scene and samples it at times that all configurations share.

use super::sample::{Sample, Sampler, takes};
use crate::accuracy::solver::{BodyField, Channel, Field, Refusal, Solution};
use sinew::assembly::mesh_of;
use sinew::scene::SceneFile;
use sinew::scene::schema::{Axis, Quantity};
use sinew::{Error, Options, Simulation};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Times at which fields are kept; numbers and energies are sampled more often.
pub const FIELDS: u64 = 10;
/// Samples of energies for each sample of fields: they cost as much as some steps.
pub const ENERGIES_A_FIELD: u64 = 4;
/// Runs shorter than this are timed again (s).
const SHORT: f64 = 0.1;
/// Between two checks of the clock at most so long (s), by what steps have taken so far.
const BREATH: f64 = 0.25;
/// Steps before the clock is checked for the first time, and at least between two checks.
const FIRST: u64 = 40;
/// How often.
const AGAIN: u32 = 3;

/// What is sampled in a scene.
#[derive(Clone, Debug)]
pub struct Sampling {
    /// Samples of probes over the duration: ten, or a multiple of forty.
    pub count: u64,
    /// Probes: name, what, and the components that mean something.
    pub probes: Vec<(String, Quantity, Vec<usize>)>,
}

impl Sampling {
    /// For a scene that has been prepared; `steps` is how many the coarsest step takes: samples must not make it much
    /// finer.
    pub fn new(scene: &SceneFile, reactions: &[(String, sinew::scene::schema::Probe, Vec<Axis>)], steps: u64) -> Self {
        let grain = FIELDS * ENERGIES_A_FIELD;
        let count = if steps < 10 * grain { FIELDS } else { (steps / 10 / grain).clamp(1, 10) * grain };
        let mut probes: Vec<(String, Quantity, Vec<usize>)> = Vec::new();
        for (name, probe) in &scene.scene.probes {
            let all = 0..sinew::observation::header(&probe.what).len() - 1;
            probes.push((name.clone(), probe.what.clone(), all.collect()));
        }
        for (name, probe, axes) in reactions {
            probes.push((name.clone(), probe.what.clone(), axes.iter().map(|axis| *axis as usize).collect()));
        }
        probes.sort_by(|a, b| a.0.cmp(&b.0));
        probes.dedup_by(|a, b| a.0 == b.0);
        Self { count, probes }
    }

    /// The names of all channels.
    pub fn names(&self) -> Vec<String> {
        let probes = self.probes.iter().flat_map(|(name, what, components)| {
            components.iter().map(move |&component| column(name, what, component).0)
        });
        probes.chain(["energy.kinetic".into(), "energy.strain".into()]).collect()
    }

    /// A step (s) of which a whole number makes the duration, at most `step` (s): samples lie within the steps, too.
    pub fn whole(duration: f64, step: f64) -> f64 {
        duration / (duration / step - 1e-9).ceil().max(1.0)
    }

    /// A step (s) of which a whole number lies between two samples, at most `step` (s).
    pub fn fitting(&self, duration: f64, step: f64) -> f64 {
        let between = (duration / self.count as f64 / step - 1e-9).ceil().max(1.0);
        duration / (self.count as f64 * between)
    }
}

/// The name and the unit of a probe's component: `tip.uz` and `m`.
fn column(probe: &str, what: &Quantity, component: usize) -> (String, String) {
    let header = sinew::observation::header(what);
    let (name, unit) = header.get(component + 1).map_or(("", "1"), |of| (of.name, of.unit));
    (format!("{probe}.{name}"), if unit == "1" { String::new() } else { unit.to_string() })
}

/// Why an error means that there is no solution.
pub fn refusal(error: Error) -> Refusal {
    match error {
        Error::Unstable(_) | Error::NotConverged(_) => Refusal::Broke(error.to_string()),
        Error::Scene(diagnostics) => {
            let errors = diagnostics.list().into_iter().filter(|d| d.severity == sinew::scene::Severity::Error);
            let first = errors.map(|error| error.message.clone()).next();
            Refusal::Refused(first.unwrap_or_else(|| diagnostics.to_string()))
        }
        error => Refusal::Refused(error.to_string()),
    }
}

/// Runs a scene that has been prepared, with the step it is to be run with.
pub fn solve(
    scene: &SceneFile,
    options: &Options,
    sampling: &Sampling,
    check_time: &dyn Fn() -> Result<(), Refusal>,
) -> Result<Solution, Refusal> {
    let mut simulation = Simulation::new(scene, options).map_err(refusal)?;
    let sampler = Sampler::new(sampling, scene.scene.duration);
    let mut run = Run { sampling, channels: BTreeMap::new(), field: Field::default(), sampler };
    run.through(&mut simulation, scene, check_time)?;
    let mut solution = run.solution(&mut simulation, scene)?;
    drop(simulation);
    while solution.seconds < SHORT && solution.timed < AGAIN {
        let mut simulation = Simulation::new(scene, options).map_err(refusal)?;
        simulation.settle().map_err(refusal)?;
        let seconds = time_of(&mut simulation, |simulation| simulation.advance_towards_end(u64::MAX))?;
        solution.seconds = solution.seconds.min(seconds);
        solution.timed += 1;
    }
    Ok(solution)
}

/// Takes steps; how long they took (s). What waits on a device is waited for.
pub fn timed(simulation: &mut Simulation, steps: u64) -> Result<f64, Refusal> {
    time_of(simulation, |simulation| simulation.advance(steps))
}

fn time_of(
    simulation: &mut Simulation,
    work: impl FnOnce(&mut Simulation) -> Result<(), Error>,
) -> Result<f64, Refusal> {
    let started = Instant::now();
    work(simulation).map_err(refusal)?;
    if let Some(body) = simulation.scene().bodies.keys().next().cloned() {
        let on_device = simulation.is_on_gpu();
        if on_device {
            simulation.displacements(&body).map_err(refusal)?;
        }
    }
    Ok(started.elapsed().as_secs_f64())
}

/// What is gathered on the way.
struct Run<'a> {
    sampling: &'a Sampling,
    channels: BTreeMap<String, Channel>,
    field: Field,
    sampler: Sampler<'a>,
}

impl Run<'_> {
    fn through(
        &mut self,
        simulation: &mut Simulation,
        scene: &SceneFile,
        check_time: &dyn Fn() -> Result<(), Refusal>,
    ) -> Result<(), Refusal> {
        for (name, body) in &scene.scene.bodies {
            let mesh = mesh_of(body, scene).map_err(|error| Refusal::Refused(error.to_string()))?;
            let body = BodyField { mesh: Arc::new(mesh), masses: Vec::new(), displacements: Vec::new() };
            self.field.bodies.insert(name.clone(), body);
        }
        // bodies are brought to rest before steps are timed
        simulation.settle().map_err(refusal)?;
        if scene.scene.is_static() {
            let all = simulation.planned_steps();
            while !simulation.is_finished() && simulation.step_count() < all {
                check_time()?;
                let left = all - simulation.step_count();
                let steps = left.min(in_a_breath(simulation, self.sampler.seconds));
                self.sampler.seconds += timed(simulation, steps)?;
            }
            self.sampler.see(simulation, [true; 2])?;
            let sample = self.sampler.last().map(|sample| Sample { time: scene.scene.duration, ..sample });
            sample.into_iter().for_each(|sample| self.take(sample));
        } else {
            let mut advance = |simulation: &mut Simulation, time: f64, so_far: f64| {
                check_time()?;
                let most = in_a_breath(simulation, so_far);
                time_of(simulation, |simulation| simulation.advance_short_of(time, most))
            };
            for number in 0..=self.sampling.count {
                let mut sample = self.sampler.at(simulation, number, &mut advance)?;
                let [energies, fields] = takes(self.sampling, number);
                sample.energies = sample.energies.filter(|_| energies);
                sample.displacements = sample.displacements.filter(|_| fields);
                self.take(sample);
            }
        }
        for (name, body) in &mut self.field.bodies {
            body.masses = simulation.masses(name).map_err(refusal)?;
        }
        Ok(())
    }

    /// Takes what was seen.
    fn take(&mut self, sample: Sample) {
        let time = sample.time;
        for ((name, what, components), values) in self.sampling.probes.iter().zip(&sample.probes) {
            self.keep(name, what, components, time, values);
        }
        for (name, value) in ["energy.kinetic", "energy.strain"].into_iter().zip(sample.energies.into_iter().flatten())
        {
            self.push(name.into(), "energy", "J".into(), time, value);
        }
        if let Some(displacements) = sample.displacements {
            self.field.times.push(time);
            for (body, own) in self.field.bodies.values_mut().zip(displacements) {
                body.displacements.push(own);
            }
        }
    }

    fn keep(&mut self, probe: &str, what: &Quantity, components: &[usize], time: f64, values: &[f64]) {
        for &component in components {
            let (name, unit) = column(probe, what, component);
            self.push(name, probe, unit, time, values.get(component).copied().unwrap_or(f64::NAN));
        }
    }

    fn push(&mut self, name: String, group: &str, unit: String, time: f64, value: f64) {
        let new = || Channel { name: name.clone(), group: group.into(), unit, times: Vec::new(), values: Vec::new() };
        let channel = self.channels.entry(name.clone()).or_insert_with(new);
        channel.times.push(time);
        channel.values.push(value);
    }

    fn solution(self, simulation: &mut Simulation, scene: &SceneFile) -> Result<Solution, Refusal> {
        let summary = simulation.summary("finished").map_err(refusal)?;
        Ok(Solution {
            channels: self.channels.into_values().collect(),
            field: Some(self.field),
            seconds: self.sampler.seconds,
            preload: simulation.preload().map_or(0.0, |preload| preload.seconds),
            timed: 1,
            simulated: (!scene.scene.is_static()).then_some(scene.scene.duration),
            steps: if scene.scene.is_static() { summary.steps } else { summary.planned_steps },
            elements: summary.elements as u64,
            nodes: summary.nodes as u64,
            time_step: summary.time_step,
            backend: summary.backend,
            hourglass_share: summary.energies.hourglass / summary.energies.strain.max(1e-300),
        })
    }
}

/// Steps between two checks of the clock, where those so far took so long (s).
fn in_a_breath(simulation: &Simulation, so_far: f64) -> u64 {
    let each = so_far / simulation.step_count().max(1) as f64;
    let steps = if each > 0.0 { (BREATH / each) as u64 } else { FIRST };
    steps.clamp(FIRST, 2000)
}
