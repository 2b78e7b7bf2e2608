//! What is seen of a run at a time that all configurations share, wherever its own steps end.

use super::march::{ENERGIES_A_FIELD, FIELDS, Sampling, refusal, timed};
use crate::accuracy::solver::Refusal;
use glam::DVec3;
use sinew::Simulation;
use sinew::scene::schema::Quantity;
use std::collections::VecDeque;

/// A time is met that is so little of a step away.
const MET: f64 = 1e-6;

/// What is seen of a run at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sample {
    /// When (s).
    pub time: f64,
    /// What each probe of the samples sees, in their order.
    pub probes: Vec<Vec<f64>>,
    /// Kinetic and strain energy (J); none where no sample asks for them.
    pub energies: Option<[f64; 2]>,
    /// Displacements of each body's nodes (m), by the names of bodies; none where no sample asks for them.
    pub displacements: Option<Vec<Vec<DVec3>>>,
}

impl Sample {
    /// What was seen between this and a later one, linearly: an error of second order in Δt, as that of steps.
    fn towards(&self, later: &Self, time: f64) -> Self {
        let share = (time - self.time) / (later.time - self.time);
        let number = |a: f64, b: f64| a + share * (b - a);
        let numbers = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| number(*a, *b)).collect();
        let vectors = |(a, b): (&Vec<DVec3>, &Vec<DVec3>)| a.iter().zip(b).map(|(a, b)| a.lerp(*b, share)).collect();
        let pair = |([k, s], [l, t]): ([f64; 2], [f64; 2])| [number(k, l), number(s, t)];
        let fields = self.displacements.as_ref().zip(later.displacements.as_ref());
        Self {
            time,
            probes: self.probes.iter().zip(&later.probes).map(numbers).collect(),
            energies: self.energies.zip(later.energies).map(pair),
            displacements: fields.map(|(a, b)| a.iter().zip(b).map(vectors).collect()),
        }
    }
}

/// Whether the sample of a number takes energies, and whether it takes fields.
pub(super) fn takes(sampling: &Sampling, number: u64) -> [bool; 2] {
    [
        number.is_multiple_of((sampling.count / (FIELDS * ENERGIES_A_FIELD)).max(1)),
        number > 0 && number.is_multiple_of(sampling.count / FIELDS),
    ]
}

/// Goes through a run, seeing it at the times of samples.
pub(super) struct Sampler<'a> {
    sampling: &'a Sampling,
    /// The end (s).
    duration: f64,
    /// What was seen at the end of the last two steps that were sampled, the later last.
    seen: VecDeque<(u64, Sample)>,
    /// Wall time of steps (s).
    pub seconds: f64,
}

impl<'a> Sampler<'a> {
    pub fn new(sampling: &'a Sampling, duration: f64) -> Self {
        Self { sampling, duration, seen: VecDeque::new(), seconds: 0.0 }
    }

    /// When the sample of a number is (s).
    pub fn time(&self, number: u64) -> f64 {
        self.duration * number as f64 / self.sampling.count as f64
    }

    /// Steps to the sample of a number and sees what is there; `advance` takes steps, none beyond a time (s), and says
    /// how long they took (s). Samples come in order. Steps may change on the way: a time within a step is
    /// interpolated.
    pub fn at(
        &mut self,
        simulation: &mut Simulation,
        number: u64,
        advance: &mut dyn FnMut(&mut Simulation, f64, f64) -> Result<f64, Refusal>,
    ) -> Result<Sample, Refusal> {
        let time = self.time(number);
        loop {
            let met = MET * simulation.time_step();
            if let Some((_, one)) = self.seen.iter().find(|(_, one)| (one.time - time).abs() <= met) {
                return Ok(Sample { time, ..one.clone() });
            }
            if let [(a, before), (b, after)] = self.seen.make_contiguous()
                && *a + 1 == *b
                && (before.time..after.time).contains(&time)
            {
                return Ok(before.towards(after, time));
            }
            if self.seen.back().is_some_and(|(_, last)| last.time > time) {
                return Err(Refusal::Refused(format!("the sample at {time} s was stepped over")));
            }
            let left = (time - simulation.time()) / simulation.time_step();
            let is_seen = self.seen.back().is_some_and(|(step, _)| *step == simulation.step_count());
            if left > 1.0 - MET {
                self.seconds += advance(simulation, time, self.seconds)?;
            } else if is_seen {
                self.seconds += timed(simulation, 1)?;
            } else {
                let step = (1.0 + MET) * simulation.time_step();
                let near = |number: &u64| (self.time(*number) - simulation.time()).abs() <= step;
                let wanted = (0..=self.sampling.count).filter(near).map(|number| takes(self.sampling, number));
                self.see(simulation, wanted.fold([false; 2], |[a, b], [c, d]| [a || c, b || d]))?;
            }
        }
    }

    /// Sees the present state, its energies and its fields if they are wanted.
    pub fn see(&mut self, simulation: &mut Simulation, [energies, fields]: [bool; 2]) -> Result<(), Refusal> {
        let (step, time) = (simulation.step_count(), simulation.time());
        let implicit = simulation.scene().is_implicit();
        let mut sample = Sample { time, ..Sample::default() };
        let later = |what: &Quantity| what.is_of_forces() && !implicit;
        for (name, what, _) in &self.sampling.probes {
            sample.probes.push(if later(what) { Vec::new() } else { simulation.probe(name).map_err(refusal)? });
        }
        if energies {
            let energies = simulation.energies().map_err(refusal)?;
            sample.energies = Some([energies.kinetic, energies.strain]);
        }
        if fields {
            let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
            let all = bodies.iter().map(|body| simulation.displacements(body));
            sample.displacements = Some(all.collect::<Result<_, _>>().map_err(refusal)?);
        }
        // forces are those of the beginning of the step before: those of now are known one step later; those of
        // implicit steps are of their end
        if self.sampling.probes.iter().any(|(_, what, _)| later(what)) {
            // (in equilibrium nothing moves any more, and no step is taken)
            let seconds = timed(simulation, 1)?;
            self.seconds += if time < self.duration - MET * simulation.time_step() { seconds } else { 0.0 };
            for ((name, what, _), values) in self.sampling.probes.iter().zip(&mut sample.probes) {
                if later(what) {
                    *values = simulation.probe(name).map_err(refusal)?;
                }
            }
        }
        self.seen.push_back((step, sample));
        if self.seen.len() > 2 {
            self.seen.pop_front();
        }
        Ok(())
    }

    /// What was seen last.
    pub fn last(&mut self) -> Option<Sample> {
        self.seen.pop_back().map(|(_, sample)| sample)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use sinew::components::Precision;
    use sinew::{Options, SceneFile};
    use std::path::Path;

    /// A plate is pressed into a block whose sides a thread draws together; half of the time is 20 steps.
    const PRESSED: &str = r#"(
        title: "Pressed", duration: 0.02, integration: (step: 0.0005),
        bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: "tissue")},
        materials: {"tissue": (density: 1000, neo_hookean: Young(young: 30000, poisson: 0.3), damping: 20)},
        constraints: [Fixed(on: Set("z0"))],
        tools: {"plate": (shape: Box(size: (0.3, 0.3, 0.05)), at: (0.06, 0.05, 0.1251),
            moves: [(displacement: (0, 0, -0.004), curve: Smooth(end: 0.02))])},
        contacts: [Tool(tool: "plate")],
        attachments: [Suture(name: "stitch", from: (at: (0, 0.05, 0.1)), to: (at: (0.1, 0.05, 0.1)), stiffness: 20,
            length: 0.05)],
        probes: {
            "up": (what: Displacement, on: Set("z1")),
            "reaction": (what: Reaction, on: Set("z0")),
            "force": (what: Force(direction: (0, 0, 1)), on: Set("z0")),
            "moment": (what: Moment(center: (0, 0, 1)), on: Set("z0")),
            "torque": (what: Torque(center: (0, 0, 1), axis: (1, 0, 0)), on: Set("z0")),
            "contact": (what: ContactForce, on: Set("z1")),
            "pressure": (what: ContactPressure, on: Set("z1")),
            "area": (what: ContactArea, on: Set("z1")),
            "thread": (what: AttachmentForce(attachment: "stitch")),
            "length": (what: SutureLength(attachment: "stitch")),
            "plate": (what: ToolForce(tool: "plate")),
            "turned": (what: ToolTorque(tool: "plate")),
        },
    )"#;

    #[test]
    fn whatever_is_of_forces_is_of_the_time_of_its_sample() {
        let scene = SceneFile::from_text("pressed.ron", PRESSED, Path::new(""), &[]).unwrap();
        let options = Options { precision: Precision::F64, threads: 1, ..Options::default() };
        let probes = scene.scene.probes.iter();
        let probes = probes.map(|(name, probe)| (name.clone(), probe.what.clone(), Vec::new())).collect();
        let sampling = Sampling { count: 10, probes };
        let mut simulation = Simulation::new(&scene, &options).unwrap();
        let mut sampler = Sampler::new(&sampling, scene.scene.duration);
        let mut advance = |simulation: &mut Simulation, time: f64, _: f64| {
            simulation.advance_short_of(time, u64::MAX).map(|()| 0.0).map_err(refusal)
        };
        let sample = sampler.at(&mut simulation, 5, &mut advance).unwrap();
        let mut by_hand = Simulation::new(&scene, &options).unwrap();
        by_hand.advance_to(0.01).unwrap();
        let at_once = sampling.probes.iter().map(|(name, ..)| by_hand.probe(name).unwrap()).collect::<Vec<_>>();
        by_hand.step().unwrap();
        for (((name, what, _), seen), at_once) in sampling.probes.iter().zip(&sample.probes).zip(at_once) {
            let later = by_hand.probe(name).unwrap();
            assert_ne!(later, at_once, "{name} tells the times apart");
            assert_eq!(*seen, if *what == Quantity::Displacement { at_once } else { later }, "{name}");
        }
    }
}
