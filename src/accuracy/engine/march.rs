//! Runs a scene and looks at it at times that all configurations share.

use crate::accuracy::solver::{BodyField, Channel, Field, Refusal, Solution};
use crate::assembly::mesh_of;
use crate::scene::SceneFile;
use crate::scene::schema::{Axis, Quantity};
use crate::{Error, Options, Simulation};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Times at which fields are kept; numbers and energies are looked at more often.
pub const FIELDS: u64 = 10;
/// Looks at energies for each look at fields: they cost as much as some steps.
const ENERGIES_A_FIELD: u64 = 4;
/// Runs shorter than this are timed again (s).
const SHORT: f64 = 0.1;
/// Between two looks at the clock at most so long (s), by what steps have taken so far.
const BREATH: f64 = 0.25;
/// Steps before the clock is looked at for the first time, and at least between two looks.
const FIRST: u64 = 40;
/// How often.
const AGAIN: u32 = 3;

/// What is looked at in a scene.
#[derive(Clone, Debug)]
pub struct Looks {
    /// Looks at probes over the duration: ten, or a multiple of forty.
    pub count: u64,
    /// Probes: name, what, and the components that mean something.
    pub probes: Vec<(String, Quantity, Vec<usize>)>,
}

impl Looks {
    /// For a scene that has been prepared; `steps` is how many the coarsest step takes: looks must not make it much
    /// finer.
    pub fn new(scene: &SceneFile, reactions: &[(String, crate::scene::schema::Probe, Vec<Axis>)], steps: u64) -> Self {
        let grain = FIELDS * ENERGIES_A_FIELD;
        let count = if steps < 10 * grain { FIELDS } else { (steps / 10 / grain).clamp(1, 10) * grain };
        let mut probes: Vec<(String, Quantity, Vec<usize>)> = Vec::new();
        for (name, probe) in &scene.scene.probes {
            let all = 0..crate::observation::header(probe.what).len() - 1;
            probes.push((name.clone(), probe.what, all.collect()));
        }
        for (name, probe, axes) in reactions {
            probes.push((name.clone(), probe.what, axes.iter().map(|axis| *axis as usize).collect()));
        }
        probes.sort_by(|a, b| a.0.cmp(&b.0));
        probes.dedup_by(|a, b| a.0 == b.0);
        Self { count, probes }
    }

    /// The names of all channels.
    pub fn names(&self) -> Vec<String> {
        let probes = self.probes.iter().flat_map(|(name, what, components)| {
            components.iter().map(move |&component| column(name, *what, component).0)
        });
        probes.chain(["energy.kinetic".into(), "energy.strain".into()]).collect()
    }

    /// A step (s) of which a whole number lies between two looks, at most `step` (s).
    pub fn fitting(&self, duration: f64, step: f64) -> f64 {
        let between = (duration / self.count as f64 / step - 1e-9).ceil().max(1.0);
        duration / (self.count as f64 * between)
    }
}

/// The name and the unit of a probe's component: `tip.uz` and `m`.
fn column(probe: &str, what: Quantity, component: usize) -> (String, String) {
    let header = crate::observation::header(what);
    let text = header.get(component + 1).copied().unwrap_or_default();
    let (name, unit) = text.strip_suffix(')').and_then(|text| text.split_once(" (")).unwrap_or((text, ""));
    (format!("{probe}.{name}"), unit.to_string())
}

/// Why an error means that there is no solution.
pub fn refusal(error: Error) -> Refusal {
    match error {
        Error::Unstable(_) | Error::NotConverged(_) => Refusal::Broke(error.to_string()),
        Error::Scene(diagnostics) => {
            let errors = diagnostics.list().into_iter().filter(|d| d.severity == crate::scene::Severity::Error);
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
    looks: &Looks,
    check_time: &dyn Fn() -> Result<(), Refusal>,
) -> Result<Solution, Refusal> {
    let mut simulation = Simulation::new(scene, options).map_err(refusal)?;
    let mut run = Run { looks, channels: BTreeMap::new(), field: Field::default(), seconds: 0.0 };
    run.through(&mut simulation, scene, check_time)?;
    let mut solution = run.solution(&mut simulation, scene)?;
    drop(simulation);
    while solution.seconds < SHORT && solution.timed < AGAIN {
        let mut simulation = Simulation::new(scene, options).map_err(refusal)?;
        simulation.settle().map_err(refusal)?;
        let steps = simulation.planned_steps();
        let seconds = timed(&mut simulation, steps)?;
        solution.seconds = solution.seconds.min(seconds);
        solution.timed += 1;
    }
    Ok(solution)
}

/// Takes steps; how long they took (s). What waits on a device is waited for.
pub fn timed(simulation: &mut Simulation, steps: u64) -> Result<f64, Refusal> {
    let started = Instant::now();
    simulation.advance(steps).map_err(refusal)?;
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
    looks: &'a Looks,
    channels: BTreeMap<String, Channel>,
    field: Field,
    seconds: f64,
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
        let all = simulation.planned_steps();
        if scene.scene.is_static() {
            while !simulation.is_finished() && simulation.step_count() < all {
                check_time()?;
                let steps = (all - simulation.step_count()).min(self.in_a_breath(simulation));
                self.seconds += timed(simulation, steps)?;
            }
            return self.look(simulation, self.looks.count, scene.scene.duration);
        }
        for look in 0..=self.looks.count {
            let target = all * look / self.looks.count;
            while simulation.step_count() < target {
                check_time()?;
                let steps = (target - simulation.step_count()).min(self.in_a_breath(simulation));
                self.seconds += timed(simulation, steps)?;
            }
            self.look(simulation, look, target as f64 * simulation.time_step())?;
        }
        Ok(())
    }

    /// Steps between two looks at the clock.
    fn in_a_breath(&self, simulation: &Simulation) -> u64 {
        let each = self.seconds / simulation.step_count().max(1) as f64;
        let steps = if each > 0.0 { (BREATH / each) as u64 } else { FIRST };
        steps.clamp(FIRST, 2000)
    }

    fn look(&mut self, simulation: &mut Simulation, look: u64, time: f64) -> Result<(), Refusal> {
        for (name, what, components) in self.looks.probes.clone() {
            if what != Quantity::Reaction {
                let values = simulation.probe(&name).map_err(refusal)?;
                self.keep(&name, what, &components, time, &values);
            }
        }
        if look.is_multiple_of((self.looks.count / (FIELDS * ENERGIES_A_FIELD)).max(1)) {
            let energies = simulation.energies().map_err(refusal)?;
            for (name, value) in [("energy.kinetic", energies.kinetic), ("energy.strain", energies.strain)] {
                self.push(name.into(), "energy", "J".into(), time, value);
            }
        }
        if look > 0 && look.is_multiple_of(self.looks.count / FIELDS) {
            self.field.times.push(time);
            for (name, body) in &mut self.field.bodies {
                body.displacements.push(simulation.displacements(name).map_err(refusal)?);
                body.masses = simulation.masses(name).map_err(refusal)?;
            }
        }
        // reactions are made of the forces at the beginning of the step before: those of now are known one step later
        let reactions: Vec<_> = self.looks.probes.iter().filter(|(_, what, _)| *what == Quantity::Reaction).collect();
        if !reactions.is_empty() {
            // (in equilibrium nothing moves any more, and no step is taken)
            let started = Instant::now();
            simulation.advance(1).map_err(refusal)?;
            let last = look == self.looks.count;
            self.seconds += if last { 0.0 } else { started.elapsed().as_secs_f64() };
            for (name, what, components) in reactions.into_iter().cloned().collect::<Vec<_>>() {
                let values = simulation.probe(&name).map_err(refusal)?;
                self.keep(&name, what, &components, time, &values);
            }
        }
        Ok(())
    }

    fn keep(&mut self, probe: &str, what: Quantity, components: &[usize], time: f64, values: &[f64]) {
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
            seconds: self.seconds,
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
