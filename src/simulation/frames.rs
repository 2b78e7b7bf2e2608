//! How long frames take: each is 10 ms of life, or a step where that is longer.

use super::Simulation;
use crate::components::Clock;
use crate::observation::Observer;
use serde::Serialize;
use std::time::Duration;

/// A frame (s of life), and what rounding may make it shorter by.
const FRAME: f64 = 0.01;
const ROUNDING: f64 = 1e-9;

/// How long frames took on the clock on the wall, without what was waited and written. A frame ends with the first step
/// that is 10 ms of life or more after the one before.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Frames {
    /// How many ended.
    pub count: u64,
    /// The longest (s): mostly the first, in which buffers are filled and preconditioners made.
    pub longest: f64,
    /// What 99 of 100 took at most (s), to 4 %.
    pub percentile_99: f64,
}

/// What takes their time. No bit of the state depends on it.
#[derive(Debug, Default)]
pub(super) struct FrameClock {
    /// Life (s) and the time that solving had taken where the present frame began.
    from: Option<(f64, Duration)>,
    durations: Durations,
    longest: f64,
}

impl Simulation {
    /// Begins the first frame, and the first after going back.
    pub(super) fn begin_frame(&mut self) {
        let clock = self.world.resource::<Clock>();
        let (time, is_motion) = (clock.time(), clock.relaxation.is_none());
        if is_motion && self.frames.from.is_none_or(|(began, _)| time < began) {
            self.frames.from = Some((time, self.solving()));
        }
    }

    /// Ends a frame if life is so far.
    pub(super) fn end_frame(&mut self) {
        let (clock, Some((began, before))) = (*self.world.resource::<Clock>(), self.frames.from) else { return };
        if clock.time() - began < FRAME - ROUNDING {
            return;
        }
        let now = self.solving();
        let took = now.saturating_sub(before).as_secs_f64();
        self.frames.durations.count(took);
        self.frames.longest = self.frames.longest.max(took);
        self.frames.from = Some((clock.time(), now));
    }

    /// The step before which the present frame ends: of explicit steps on a GPU none, for they are not waited for.
    pub(super) fn next_frame(&self) -> u64 {
        let (clock, Some((began, _))) = (self.world.resource::<Clock>(), self.frames.from) else { return u64::MAX };
        if self.has_no_frames() {
            return u64::MAX;
        }
        let left = began + FRAME - ROUNDING - clock.time();
        clock.step + (left / clock.time_step).ceil().max(1.0) as u64
    }

    fn has_no_frames(&self) -> bool {
        self.facts.on_gpu && self.solver.implicit().is_none()
    }

    /// How long frames took; none in an analysis of rest, none where no frame has ended, and none of explicit steps on
    /// a GPU.
    pub(super) fn frames(&self) -> Option<Frames> {
        let (count, longest) = (self.frames.durations.total(), self.frames.longest);
        let percentile_99 = self.frames.durations.of_most().min(longest);
        (count > 0 && !self.has_no_frames()).then_some(Frames { count, longest, percentile_99 })
    }

    /// How long was spent in steps so far, without what was waited for life and written.
    pub(super) fn solving(&self) -> Duration {
        let run = self.elapsed + self.running.map_or(Duration::ZERO, |since| since.elapsed());
        let writing = self.world.resource::<Observer>().writing;
        run.saturating_sub(writing).saturating_sub(self.metronome.waited())
    }
}

/// Parts of an octave, and the shortest time that is told from others (s).
const OF_AN_OCTAVE: f64 = 16.0;
const SHORTEST: f64 = 1e-6;
/// Octaves, up to an hour.
const OCTAVES: usize = 32;

/// How often frames took how long, by parts of octaves.
#[derive(Debug)]
struct Durations([u32; OCTAVES * OF_AN_OCTAVE as usize]);

impl Default for Durations {
    fn default() -> Self {
        Self([0; OCTAVES * OF_AN_OCTAVE as usize])
    }
}

impl Durations {
    /// Counts a frame of so many seconds.
    fn count(&mut self, seconds: f64) {
        let place = (OF_AN_OCTAVE * (seconds / SHORTEST).log2()).max(0.0) as usize;
        self.0[place.min(self.0.len() - 1)] += 1;
    }

    fn total(&self) -> u64 {
        self.0.iter().map(|&count| u64::from(count)).sum()
    }

    /// What 99 of 100 took at most (s).
    fn of_most(&self) -> f64 {
        let all = self.total();
        let mut longer = all;
        let place = self.0.iter().position(|&count| {
            longer -= u64::from(count);
            100 * longer <= all
        });
        SHORTEST * ((place.unwrap_or(0) + 1) as f64 / OF_AN_OCTAVE).exp2()
    }
}

#[cfg(test)]
mod tests;
