//! Inputs: factors that a program sets between steps.

use super::Clock;
use crate::scene::schema::Curve;
use serde::{Deserialize, Serialize};

/// An input, and its course up to what is known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its name in the scene.
    pub name: String,
    /// The factor until it is set.
    pub initial: f64,
    /// By how much it changes in a second at most (1/s).
    pub rate: Option<f64>,
    /// What becomes of it during the run.
    pub state: InputState,
}

/// What of an input changes, as snapshots have it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct InputState {
    /// What it is, or becomes as fast as its rate allows.
    target: f64,
    /// A table: the last corners before the present, and what is to come.
    course: Curve,
    /// What has been set since the last step.
    pending: Option<f64>,
    /// The fastest that it ever changed (1/s); where it has no rate, its largest jump.
    fastest: f64,
    /// The largest size that it has had or goes to, 1 at least: what a load of the scene's own is stiff by.
    #[serde(default = "one")]
    largest: f64,
}

fn one() -> f64 {
    1.0
}

/// What became of an input that was set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It goes elsewhere than before.
    Moves,
    /// So much faster than ever before that what follows the run should know.
    Quickens,
}

impl Input {
    /// At its initial value.
    pub fn new(name: &str, initial: f64, rate: Option<f64>) -> Self {
        let course = Curve::Table(vec![(0.0, initial)]);
        let state =
            InputState { target: initial, course, pending: None, fastest: 0.0, largest: initial.abs().max(1.0) };
        Self { name: name.into(), initial, rate, state }
    }

    /// Its course in time, as far as it is known.
    pub fn course(&self) -> &Curve {
        &self.state.course
    }

    /// Where it goes: what was set last.
    pub fn target(&self) -> f64 {
        self.state.pending.unwrap_or(self.state.target)
    }

    /// Sets where it goes from the next step on.
    pub fn set(&mut self, value: f64) {
        self.state.pending = Some(value);
    }

    /// Takes back what was set since the last step.
    pub fn withdraw(&mut self) {
        self.state.pending = None;
    }

    /// What was set since the last step.
    pub fn pending(&self) -> Option<f64> {
        self.state.pending
    }

    /// The largest size that it has had or goes to, 1 at least.
    pub fn largest(&self) -> f64 {
        self.state.largest
    }

    /// Takes a size as the largest; what was the largest before.
    pub fn replace_largest(&mut self, largest: f64) -> f64 {
        std::mem::replace(&mut self.state.largest, largest)
    }

    /// Whether it has jumped.
    pub fn has_jumped(&self) -> bool {
        self.rate.is_none() && self.state.fastest > 0.0
    }

    /// Begins to go where it was set to go, from the clock's time on; `None` where it goes there anyway.
    pub fn take_up(&mut self, clock: &Clock) -> Option<Change> {
        let state = &mut self.state;
        let target = state.pending.take().filter(|target| *target != state.target)?;
        // pseudo-steps are no motion: there is no time in which something could change
        let rate = self.rate.filter(|_| clock.relaxation.is_none());
        let now = clock.time();
        let Curve::Table(points) = &state.course else { return None };
        // a second time before the same step: from where it was before the first
        let began = points.iter().find(|&&(time, _)| time == now);
        let here = began.map_or_else(|| state.course.value(now), |&(_, value)| value);
        let Curve::Table(points) = &mut state.course else { return None };
        points.truncate(points.partition_point(|&(time, _)| time < now));
        // loads act with means over windows that begin in the step before
        let known = points.partition_point(|&(time, _)| time < now - clock.before.max(clock.time_step));
        points.drain(..known.saturating_sub(1));
        // slower than any clock can tell is never there, in a number all the same
        let there = rate.map_or(now, |rate| (now + (target - here).abs() / rate).min(f64::MAX));
        points.extend([(now, here), (there, target)]);
        state.largest = state.largest.max(here.abs()).max(target.abs());
        state.target = target;
        let speed = rate.unwrap_or((target - here).abs());
        let quickens = speed > 2.0 * state.fastest;
        state.fastest = state.fastest.max(speed);
        Some(if quickens { Change::Quickens } else { Change::Moves })
    }
}

impl InputState {
    /// Whether it can be that of an input: finite numbers, in a course whose times do not go back.
    pub fn is_sound(&self) -> bool {
        let Curve::Table(points) = &self.course else { return false };
        let numbers = [self.target, self.fastest, self.largest].into_iter().chain(self.pending);
        let grows = points.windows(2).all(|pair| pair[0].0 <= pair[1].0);
        let mut all = numbers.chain(points.iter().flat_map(|&(time, value)| [time, value]));
        !points.is_empty() && grows && all.all(f64::is_finite)
    }
}

#[cfg(test)]
mod tests;
