//! Steps for as long as somebody can wait: a frame of a picture, a tick of a device that a hand holds.

use super::Simulation;
use crate::backend::device::Device;
use crate::error::Error;
use std::time::Duration;
use web_time::Instant;

/// Batches take half of what is left of the budget: what a step takes is known from those before, and may be more now.
const SHARE: f64 = 0.5;

/// What [`Simulation::advance_for`] did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advanced {
    /// Steps taken.
    pub steps: u64,
    /// Simulated time that they took (s).
    pub simulated: f64,
    /// What that took on the clock on the wall.
    pub took: Duration,
    /// The longest of the batches in which steps were taken: by no more than that the budget is overdrawn.
    pub longest_batch: Duration,
    /// Why it ended.
    pub why: Ended,
}

/// Why [`Simulation::advance_for`] came back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The time that was wanted is reached.
    Reached,
    /// The budget is spent: what falls short is not caught up later.
    Budget,
    /// A static analysis is at rest.
    Rest,
}

impl Advanced {
    /// Simulated seconds a second on the wall: 1 keeps up with life, more is faster. That of a
    /// [`Summary`](super::Summary) and of a [`Touch`](crate::port::Touch) is the other way round.
    pub fn real_time_factor(&self) -> f64 {
        self.simulated / self.took.as_secs_f64()
    }
}

impl Simulation {
    /// Takes as many steps as fit into a budget of time on the clock on the wall, at least one, until the clock shows
    /// at least `until` (s; infinite: as long as the budget lasts, also beyond the end of the scene). How long a step
    /// takes is measured. Bits depend on the steps alone, not on what they took. Who gives a budget keeps the pace:
    /// `real_time: true` of a scene waits for nothing here.
    ///
    /// # Errors
    /// As [`Simulation::advance`]; that `until` is no number.
    pub fn advance_for(&mut self, budget: Duration, until: f64) -> Result<Advanced, Error> {
        if until.is_nan() {
            return Err(Error::Options("steps cannot be taken until a time that is no number".into()));
        }
        self.metronome.stand_aside(true);
        let advanced = self.steps_within(budget, until);
        self.metronome.stand_aside(false);
        advanced
    }

    fn steps_within(&mut self, budget: Duration, until: f64) -> Result<Advanced, Error> {
        let started = Instant::now();
        self.settle()?;
        let (first, from) = (self.step_count(), self.time());
        let mut longest = Duration::ZERO;
        let why = loop {
            if self.steps_until(until) == 0 {
                break Ended::Reached;
            }
            let rest = budget.saturating_sub(started.elapsed()).as_secs_f64();
            let before = self.step_count();
            let fits = match self.seconds_a_step {
                Some(each) if rest < each && before > first => break Ended::Budget,
                Some(each) => (SHARE * rest / each) as u64,
                None if rest == 0.0 && before > first => break Ended::Budget,
                None => 1,
            };
            let left = self.steps_left_to(until)?;
            if left == 0 {
                break Ended::Reached;
            }
            let batch = Instant::now();
            self.advance(fits.clamp(1, left))?;
            if let Some(mut device) = self.world.get_resource_mut::<Device>() {
                device.gpu().wait()?;
            }
            let (took, steps) = (batch.elapsed(), self.step_count() - before);
            longest = longest.max(took);
            if steps == 0 {
                break Ended::Rest;
            }
            let each = took.as_secs_f64() / steps as f64;
            self.seconds_a_step = Some(self.seconds_a_step.map_or(each, |before| 0.5 * (before + each)));
        };
        Ok(Advanced {
            steps: self.step_count() - first,
            simulated: self.time() - from,
            took: started.elapsed(),
            longest_batch: longest,
            why,
        })
    }
}
