//! Time, and what depends on nothing else.

use super::curve::smooth;
use super::input::Input;
use crate::scene::schema::{Curve, Load};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// The clock counts steps; time is their number times Δt, exact however long the run (a sum of f32 steps reads 1087.7 s
/// after 1e7 steps of 1e-4 s).
#[derive(Resource, Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Clock {
    /// Steps taken.
    pub step: u64,
    /// Δt (s).
    pub time_step: f64,
    /// The step since which Δt is what it is, and the time at its beginning (s).
    pub since: (u64, f64),
    /// Δt before that (s).
    pub before: f64,
    /// How steps lead to rest, in a static analysis.
    pub relaxation: Option<Relaxation>,
}

impl Clock {
    /// At the beginning of a motion in steps of Δt (s).
    pub fn with_step(time_step: f64) -> Self {
        Self { step: 0, time_step, since: (0, 0.0), before: time_step, relaxation: None }
    }

    /// Whether it can be the clock of a motion: steps are positive and finite, and Δt is what it is since a step that
    /// was taken.
    pub fn is_sound(&self) -> bool {
        let step = |step: f64| step.is_finite() && step > 0.0;
        let since = self.since.0 <= self.step && self.since.1.is_finite() && self.since.1 >= 0.0;
        step(self.time_step) && step(self.before) && since && self.relaxation.is_none() && self.time().is_finite()
    }

    /// The step that is nearest to a time (s), in steps as they are now: the present one at least.
    pub fn step_nearest(&self, time: f64) -> u64 {
        let steps = ((time - self.since.1) / self.time_step).round().max(0.0);
        // a number of steps beyond what can be counted ends at the largest
        self.since.0.saturating_add(steps as u64).max(self.step)
    }

    /// Time at the beginning of a step (s), which must not lie before the last change of Δt: the time of the change and
    /// so many steps, exact however long the run.
    pub fn time_at(&self, step: u64) -> f64 {
        self.since.1 + step.saturating_sub(self.since.0) as f64 * self.time_step
    }

    /// Time from the middle of the last step to the middle of the present one (s), over which forces change velocities:
    /// Δt, in the first step half of it, and after a change of Δt the mean of both.
    pub fn between_middles(&self) -> f64 {
        match self.step {
            0 => 0.5 * self.time_step,
            step if step == self.since.0 => 0.5 * (self.before + self.time_step),
            _ => self.time_step,
        }
    }

    /// The times (s) from the middle of the step before to the middle of a step, which must not lie before the last
    /// change of Δt: over them forces at its beginning change velocities. The first such window begins with the motion.
    pub fn window_at(&self, step: u64) -> (f64, f64) {
        let there = Self { step, ..*self };
        let end = self.time_at(step) + 0.5 * self.time_step;
        (end - there.between_middles(), end)
    }

    /// Takes steps of another length from now on (s).
    pub fn change_step(&mut self, time_step: f64) {
        // two changes before a step is taken are one
        if self.step != self.since.0 || self.step == 0 {
            self.before = self.time_step;
        }
        self.since = (self.step, self.time());
        self.time_step = time_step;
    }

    /// The present time (s). In a static analysis it grows with the loads up to the scene's duration and stays there.
    pub fn time(&self) -> f64 {
        match &self.relaxation {
            None => self.time_at(self.step),
            Some(relaxation) => relaxation.end * relaxation.progress(self.step),
        }
    }

    /// What turns a step's displacement into a velocity (1/s): 1/Δt; 0 in a static analysis, whose steps are no motion.
    pub fn rate(&self) -> f64 {
        if self.relaxation.is_some() { 0.0 } else { 1.0 / self.time_step }
    }
}

/// Dynamic relaxation: pseudo-steps that lead to rest. Chosen by the simulation, anew every so many steps.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
pub struct Relaxation {
    /// The time whose loads and motions are wanted (s).
    pub end: f64,
    /// A step, and how far loads had grown in it: from there they grow by `growth` a step.
    pub since: (u64, f64),
    /// Growth of the progress of loads in a step.
    pub growth: f64,
    /// a = cΔt/2 of the damping c, the same for all nodes.
    pub damping: f64,
    /// What forces are multiplied with, over the fictitious mass: how much the bound of the stable step is outdone.
    pub gain: f64,
}

impl Relaxation {
    /// How far loads and motions have grown at the end of so many steps, from 0 to 1.
    pub fn progress(&self, steps: u64) -> f64 {
        (self.since.1 + self.growth * steps.saturating_sub(self.since.0) as f64).min(1.0)
    }

    /// What loads and motions are multiplied with then: the progress by the 3-4-5 polynomial, so that nothing begins or
    /// ends suddenly.
    pub fn share(&self, steps: u64) -> f64 {
        smooth(self.progress(steps))
    }
}

/// A number or three that depend on time alone.
#[derive(Clone, Debug)]
pub enum Signal {
    /// A curve's mean over the window in which the load acts, times a vector: one slot.
    Load {
        /// Course in time.
        curve: Curve,
        /// What it multiplies; a scalar load uses the first component.
        amplitude: DVec3,
    },
    /// Rows of the affine motion u = A·(X − center) + b at the end of the step: three slots (A's row, b's component).
    Motion {
        /// Course in time.
        curve: Curve,
        /// Displacement of the centre (m).
        displacement: DVec3,
        /// Displacement gradient.
        gradient: DMat3,
        /// Axis times angle (rad).
        rotation: DVec3,
    },
}

/// What a curve is the course of.
#[derive(Clone, Copy)]
enum Use {
    Load,
    Motion,
}

impl Signal {
    /// How many slots it fills.
    pub fn slots(&self) -> usize {
        match self {
            Signal::Load { .. } => 1,
            Signal::Motion { .. } => 3,
        }
    }

    /// Its course in time, as the scene has it.
    fn curve(&self) -> &Curve {
        match self {
            Signal::Load { curve, .. } | Signal::Motion { curve, .. } => curve,
        }
    }

    /// Whether it ever moves anything.
    fn moves(&self) -> bool {
        matches!(self, Signal::Motion { displacement, gradient, rotation, .. }
            if (*displacement, *gradient, *rotation) != (DVec3::ZERO, DMat3::ZERO, DVec3::ZERO))
    }

    fn fill(&self, curve: &Curve, factor: impl Fn(&Curve, Use) -> f64, slots: &mut [[f64; 4]]) {
        match self {
            Signal::Load { amplitude, .. } => {
                let v = *amplitude * factor(curve, Use::Load);
                slots[0] = [v.x, v.y, v.z, 0.0];
            }
            Signal::Motion { displacement, gradient, rotation, .. } => {
                let factor = factor(curve, Use::Motion);
                let a = *gradient * factor + rotation_less_identity(*rotation * factor);
                let b = *displacement * factor;
                for i in 0..3 {
                    let row = a.row(i);
                    slots[i] = [row.x, row.y, row.z, b[i]];
                }
            }
        }
    }
}

/// R − I by Rodrigues' formula, exact for small angles too: sin θ K + 2 sin²(θ/2) K².
fn rotation_less_identity(rotation: DVec3) -> DMat3 {
    let angle = rotation.length();
    if angle == 0.0 {
        return DMat3::ZERO;
    }
    let k = rotation / angle;
    let cross = DMat3::from_cols(DVec3::new(0.0, k.z, -k.y), DVec3::new(-k.z, 0.0, k.x), DVec3::new(k.y, -k.x, 0.0));
    cross * angle.sin() + cross * cross * (2.0 * (0.5 * angle).sin().powi(2))
}

/// All signals of a scene and their values in the present step; loads and constraints know their slots.
#[derive(Resource, Clone, Debug, Default)]
pub struct Signals {
    /// Each with the place of its input, where it has one.
    sources: Vec<(Signal, Option<usize>)>,
    values: Vec<[f64; 4]>,
    inputs: Vec<Input>,
    /// Loads of the scene: number, place among the sources, and by what their amplitude is divided.
    loads: Vec<(usize, usize, f64)>,
}

impl Signals {
    /// Adds a signal and returns its first slot.
    pub fn add(&mut self, signal: Signal) -> usize {
        let slot = self.values.len();
        self.values.resize(slot + signal.slots(), [0.0; 4]);
        let input = self.declare(signal.curve());
        self.sources.push((signal, input));
        slot
    }

    /// Adds the signal of the scene's load of a number, whose amplitude is divided by `parts`; its slot.
    pub fn add_load(&mut self, number: usize, load: &Load, parts: f64) -> usize {
        self.loads.push((number, self.sources.len(), parts));
        self.add(Signal::Load { curve: load.curve().clone(), amplitude: load.amplitude() / parts })
    }

    /// Takes the amplitudes of the scene's loads as they are now.
    pub fn renew_loads(&mut self, all: &[Load]) {
        for &(number, place, parts) in &self.loads {
            if let (Some(load), Some((Signal::Load { amplitude, .. }, _))) =
                (all.get(number), self.sources.get_mut(place))
            {
                *amplitude = load.amplitude() / parts;
            }
        }
    }

    /// Takes note of the input that a curve may be; its place.
    pub fn declare(&mut self, curve: &Curve) -> Option<usize> {
        let Curve::Input { name, initial, rate } = curve else { return None };
        let known = self.inputs.iter().position(|input| input.name == *name);
        Some(known.unwrap_or_else(|| {
            self.inputs.push(Input::new(name, *initial, *rate));
            self.inputs.len() - 1
        }))
    }

    /// What a program may set.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The same, to set.
    pub fn inputs_mut(&mut self) -> &mut [Input] {
        &mut self.inputs
    }

    /// The largest size that the input of a slot has had or goes to, 1 at least; 1 where it has none.
    pub fn largest_input(&self, slot: usize) -> f64 {
        let mut first = 0;
        for (source, input) in &self.sources {
            if (first..first + source.slots()).contains(&slot) {
                return input.map_or(1.0, |input| self.inputs[input].largest());
            }
            first += source.slots();
        }
        1.0
    }

    /// Evaluates all signals for a step: of loads the mean over a window (s), see [`Clock::window_at`], of motions
    /// where they are at the end of the step (s).
    pub fn evaluate(&mut self, window: (f64, f64), end: f64) {
        self.fill(|curve, of| match of {
            Use::Load => curve.mean(window),
            Use::Motion => curve.value(end),
        });
    }

    /// Takes a share of what all signals are at a time (s): of a rotation, of its angle.
    pub fn approach(&mut self, time: f64, share: f64) {
        self.fill(|curve, _| share * curve.value(time));
    }

    fn fill(&mut self, factor: impl Fn(&Curve, Use) -> f64) {
        let mut slot = 0;
        for (source, input) in &self.sources {
            let curve = input.map_or(source.curve(), |input| self.inputs[input].course());
            source.fill(curve, &factor, &mut self.values[slot..]);
            slot += source.slots();
        }
    }

    /// The first time after one (s) from which on a load or a motion may be quicker than ever before.
    pub fn quickens_after(&self, time: f64) -> Option<f64> {
        self.sources.iter().filter_map(|(source, _)| source.curve().quickens_after(time)).reduce(f64::min)
    }

    /// Whether nodes have been moved as told by a jump until a time (s).
    pub fn have_jumped(&self, until: f64) -> bool {
        let jumped = |(source, input): &(Signal, Option<usize>)| match (source.curve(), input) {
            (Curve::Step { start, .. }, _) => *start <= until,
            (_, Some(input)) => self.inputs[*input].has_jumped(),
            _ => false,
        };
        self.sources.iter().any(|source| source.0.moves() && jumped(source))
    }

    /// Values of all slots in the present step.
    pub fn values(&self) -> &[[f64; 4]] {
        &self.values
    }
}
