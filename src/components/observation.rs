//! What is observed.

use crate::error::Error;
use crate::scene::schema::{Quantity, SkinFormat};
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// One thing to observe, on rows of a body.
#[derive(Component, Clone, Debug)]
pub struct Probe {
    /// What.
    pub what: Quantity,
    /// Rows of the body's node columns.
    pub nodes: Vec<u32>,
    /// Elements: place of the block in the body's list, and row there.
    pub elements: Vec<(u32, u32)>,
    /// Volume at rest of these elements at the start (m³), where it is of what is gone.
    pub volume: f64,
    /// The place in the scene of the attachment that it is of, if it is of one.
    pub attachment: Option<usize>,
    /// How often.
    pub every: Cadence,
    /// Whether it holds of each number the value of the largest size so far.
    pub peak: bool,
    /// A hash of what is observed, of which body and where, as the scene says it: of two scenes probes of one name may
    /// differ.
    pub of: String,
}

/// What the series of a body's skin is written as, beside VTU.
#[derive(Component, Clone, Copy, Debug)]
pub struct AlsoWritten(pub SkinFormat);

/// Whether somebody may look at forces after the present step: if not, one pass over the nodes keeps them in registers
/// and leaves [`InternalForce`](super::InternalForce) and [`ExternalForce`](super::ExternalForce) as they were.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Observed(pub bool);

/// How often something is observed: at the start, and at the first step that is not earlier than each multiple of an
/// interval; in every step, if that is longer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cadence {
    /// The interval (s).
    interval: f64,
    /// The interval in steps; infinite: never.
    steps: f64,
    /// A step, and how many intervals had passed by then: from there they are counted.
    since: (u64, f64),
}

/// What rounding may leave of a whole number of intervals, and of steps.
const WHOLE_INTERVALS: f64 = 1e-9;
const WHOLE_STEPS: f64 = 1e-6;

impl Default for Cadence {
    fn default() -> Self {
        Self { interval: f64::INFINITY, steps: f64::INFINITY, since: (0, 0.0) }
    }
}

impl Cadence {
    /// From an interval and the time step (s).
    pub fn new(interval: f64, time_step: f64) -> Self {
        Self { interval, steps: interval / time_step, since: (0, 0.0) }
    }

    /// Goes on with steps of another length (s) from the beginning of `step`.
    pub fn change_step(&mut self, step: u64, time_step: f64) {
        if self.steps.is_finite() {
            self.since = (step, self.passed(step));
            self.steps = self.interval / time_step;
        }
    }

    /// Counts from a step and the time at its beginning (s), in steps of a length (s).
    pub fn go_on(&mut self, (step, time): (u64, f64), time_step: f64) {
        if self.steps.is_finite() {
            self.since = (step, time / self.interval);
            self.steps = self.interval / time_step;
        }
    }

    /// How many intervals have passed at the beginning of a step.
    fn passed(&self, step: u64) -> f64 {
        self.since.1 + step.saturating_sub(self.since.0) as f64 / self.steps
    }

    /// The first step after `step` that is observed.
    pub fn next_after(&self, step: u64) -> u64 {
        // a time that is a whole number of steps is met in spite of rounding
        let multiple = (self.passed(step) + WHOLE_INTERVALS).floor() + 1.0;
        let from_there = ((multiple - self.since.1) * self.steps - WHOLE_STEPS).ceil();
        // an interval that never passes ends at the largest number
        self.since.0.saturating_add(from_there as u64).max(step + 1)
    }

    /// Whether a step is observed.
    pub fn is_due(&self, step: u64) -> bool {
        self.steps.is_finite() && (step == 0 || self.next_after(step - 1) == step)
    }

    /// Whether an observation is due after one number of steps and not after another, which need not be whole.
    pub fn lies_between(&self, before: f64, after: f64) -> bool {
        (after / self.steps).floor() > (before / self.steps).floor()
    }

    /// How many steps a step that is observed goes beyond the time that is asked for; 0 where that is a whole number of
    /// steps, in spite of rounding, or less than one.
    pub fn overshoot(&self, step: u64) -> f64 {
        let passed = self.passed(step);
        let beyond = (passed - (passed + WHOLE_INTERVALS).floor()) * self.steps;
        if beyond > WHOLE_STEPS && self.steps > 1.0 { beyond } else { 0.0 }
    }

    /// The multiple of the interval (s) that is met within or at the end of a step that is observed, as it would be
    /// written down; `None` where every step is observed.
    pub fn time_asked(&self, step: u64) -> Option<f64> {
        let time = (self.passed(step) + WHOLE_INTERVALS + WHOLE_STEPS / self.steps).floor() * self.interval;
        // 3 · 0.1 is 0.30000000000000004
        (self.steps > 1.0).then(|| format!("{time:.14e}").parse().unwrap_or(time))
    }

    /// How many rows a table has after `steps` steps, those of the start and of the end included.
    pub fn rows(&self, steps: u64) -> u64 {
        if self.steps <= 1.0 {
            return steps.saturating_add(1);
        }
        let whole = (self.passed(steps) + WHOLE_INTERVALS).floor() as u64 + 1;
        if self.overshoot(steps) > 0.0 { whole + 1 } else { whole }
    }

    /// How many observations `steps` steps bring, the start and the end included.
    pub fn count(&self, steps: u64) -> u64 {
        let whole = (steps as f64 / self.steps + WHOLE_INTERVALS).floor() as u64;
        whole.saturating_add(if self.is_due(steps) { 1 } else { 2 }).min(steps.saturating_add(1))
    }
}

/// What tells of each system what energy it holds (J), where it says so.
#[derive(Resource, Clone, Default)]
pub struct HeldEnergies(pub Vec<HeldEnergy>);

/// What tells it of one.
pub type HeldEnergy = Arc<dyn Fn(&mut World) -> Result<Option<f64>, Error> + Send + Sync>;

/// Energies of all bodies (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Energies {
    /// ½ m v² in the middle of the last step.
    pub kinetic: f64,
    /// Elastic energy of the laws, in the middle of the last step too, so that energies add up (with viscosity: what an
    /// instantaneous deformation would store).
    pub strain: f64,
    /// In hourglass control, likewise.
    pub hourglass: f64,
    /// Of the work of loads, what node systems hold and give back (springs of a hand), likewise; none where none says
    /// so.
    pub held: Option<f64>,
    /// Kinetic and elastic energy of removed elements, at the time of their removal.
    pub removed: f64,
    /// Done by loads since the start, when counted.
    pub load_work: Option<f64>,
    /// Lost to damping since the start, when counted.
    pub damping_loss: Option<f64>,
    /// Taken by the formula of implicit steps since the start, when counted.
    pub scheme_loss: Option<f64>,
    /// Of the work of loads, what impact and friction have taken since the start, and tools when they caught nodes;
    /// none where nothing may touch, and in a static analysis.
    pub contact_loss: Option<f64>,
    /// Done by constraints since the start, when counted.
    pub constraint_work: Option<f64>,
    /// Done against internal forces since the start, when counted: strain, hourglass and what viscosity took.
    pub internal_work: Option<f64>,
}

#[cfg(test)]
mod tests;
