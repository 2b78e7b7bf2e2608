//! How often a system runs on the host.

use serde::{Deserialize, Serialize};

/// Every so many steps, counted from one of them.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct RunInterval {
    every: u64,
    from: u64,
    /// Time between two runs (s), where it is a time and no number of steps.
    interval: Option<f64>,
}

impl RunInterval {
    pub fn new(every: u64, interval: Option<f64>) -> Self {
        Self { every, from: 0, interval }
    }

    /// Whether it comes again and again.
    pub fn is_sound(&self) -> bool {
        self.every >= 1 && self.interval.is_none_or(|interval| interval.is_finite() && interval > 0.0)
    }

    pub fn is_due(&self, step: u64) -> bool {
        step >= self.from && (step - self.from).is_multiple_of(self.every)
    }

    /// The first step after `step` in which the system runs.
    pub fn next_after(&self, step: u64) -> u64 {
        if step < self.from { self.from } else { self.from + ((step - self.from) / self.every + 1) * self.every }
    }

    /// Goes on in steps of another length (s) from the beginning of `step`, to the nearest step.
    pub fn change_step(&mut self, step: u64, before: f64, now: f64) {
        let Some(interval) = self.interval else { return };
        let next = if self.is_due(step) { step } else { self.next_after(step) };
        self.from = step + ((next - step) as f64 * before / now).round() as u64;
        self.every = crate::assembly::steps_of(interval, now);
    }
}

#[cfg(test)]
mod tests;
