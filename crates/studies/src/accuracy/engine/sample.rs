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
        let mut sample = Sample { time, ..Sample::default() };
        for (name, what, _) in &self.sampling.probes {
            let later = *what == Quantity::Reaction && !simulation.scene().is_implicit();
            sample.probes.push(if later { Vec::new() } else { simulation.probe(name).map_err(refusal)? });
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
        // reactions are made of the forces at the beginning of the step before: those of now are known one step later;
        // those of implicit steps are of their end
        if !simulation.scene().is_implicit()
            && self.sampling.probes.iter().any(|(_, what, _)| *what == Quantity::Reaction)
        {
            // (in equilibrium nothing moves any more, and no step is taken)
            let seconds = timed(simulation, 1)?;
            self.seconds += if time < self.duration - MET * simulation.time_step() { seconds } else { 0.0 };
            for ((name, what, _), values) in self.sampling.probes.iter().zip(&mut sample.probes) {
                if *what == Quantity::Reaction {
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
