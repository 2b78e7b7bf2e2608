//! Pace on the clock on the wall: `real_time: true` in a scene.

use super::Simulation;
use crate::assembly::steps_of;
use crate::components::Clock;
use serde::Serialize;
use std::time::Duration;
use web_time::Instant;

/// Simulated time between two checks of the clock on the wall (s); and who is later than that goes on from there.
const TICK: f64 = 1e-3;

/// How a run kept up with life.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RealTime {
    /// Looks at the clock on the wall, each millisecond of simulated time.
    pub ticks: u64,
    /// How often more than a millisecond was missing: life went on later from there, and nothing was skipped.
    pub late: u64,
    /// Time waited for life (s).
    pub waited: f64,
}

/// What is needed to keep the pace. No bit of the state depends on it.
#[derive(Debug, Default)]
pub(super) struct Metronome {
    /// A moment of life, and the simulated time (s) that belongs to it.
    from: Option<(Instant, f64)>,
    /// The step before which it is checked again.
    next: u64,
    /// Whether the program keeps the pace itself.
    stands_aside: bool,
    kept: RealTime,
}

impl Metronome {
    /// How it went.
    pub fn kept(&self) -> RealTime {
        self.kept
    }

    /// Time waited so far.
    pub fn waited(&self) -> Duration {
        Duration::from_secs_f64(self.kept.waited)
    }

    /// The program keeps the pace itself, or no longer: life goes on from where the simulation is then.
    pub fn stand_aside(&mut self, stands_aside: bool) {
        (self.stands_aside, self.from) = (stands_aside, None);
    }

    /// How long to wait at a simulated time (s).
    fn wait(&mut self, now: Instant, time: f64) -> Duration {
        self.kept.ticks += 1;
        let Some((start, since)) = self.from.filter(|(_, since)| *since <= time) else {
            self.from = Some((now, time));
            return Duration::ZERO;
        };
        let due = start + Duration::from_secs_f64(time - since);
        if now > due + Duration::from_secs_f64(TICK) {
            self.kept.late += 1;
            self.from = Some((now, time));
        }
        due.saturating_duration_since(now)
    }
}

impl Simulation {
    /// Waits until life is where the simulation is, if the scene asks for that.
    pub(super) fn wait_for_real_time(&mut self) {
        let clock = *self.world.resource::<Clock>();
        if !self.scene.real_time || self.metronome.stands_aside || clock.relaxation.is_some() {
            return;
        }
        let tick = steps_of(TICK, clock.time_step);
        let soon = clock.step.saturating_add(tick);
        // after going back it may be far off
        if clock.step < self.metronome.next && self.metronome.next <= soon {
            return;
        }
        let now = Instant::now();
        let wait = self.metronome.wait(now, clock.time());
        if !wait.is_zero() {
            sleep(wait);
            self.metronome.kept.waited += now.elapsed().as_secs_f64();
        }
        self.metronome.next = soon;
    }

    /// The step before which the pace is checked again.
    pub(super) fn next_tick(&self) -> u64 {
        let waits = self.scene.real_time && !self.metronome.stands_aside;
        if waits { self.metronome.next.max(self.step_count() + 1) } else { u64::MAX }
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn sleep(wait: Duration) {
    std::thread::sleep(wait);
}

/// In a page nothing may wait: its frames keep the pace.
#[cfg(target_arch = "wasm32")]
fn sleep(_: Duration) {}

#[cfg(test)]
mod tests;
