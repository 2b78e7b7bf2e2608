//! How fast simulated time goes, and how fast it should.

use std::time::Duration;

/// Time over which the real-time factor is averaged (s on the wall).
const MEMORY: f64 = 1.0;
/// The longest time on the wall that a frame makes good (s): who was away longer has not been waited for.
const LONGEST: f64 = 0.1;

/// Simulated time that is due, and what was reached lately.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Simulated seconds a second on the wall.
    pub speed: f64,
    /// Until when should have been simulated (s).
    due: f64,
    /// Simulated time and time on the wall, both weighted with e^(−age/[`MEMORY`]) (s).
    lately: [f64; 2],
}

impl Pace {
    pub fn new() -> Self {
        Self { speed: 1.0, due: 0.0, lately: [0.0; 2] }
    }

    /// Until when to simulate (s) after more time on the wall has passed, at a time (s).
    pub fn until(&mut self, now: f64, wall: Duration) -> f64 {
        self.due += wall.as_secs_f64().min(LONGEST) * self.speed;
        self.due = self.due.max(now);
        self.due
    }

    /// Takes note of what was simulated (s) since the last time, and how long that took on the wall. What fell short is
    /// not caught up.
    pub fn note(&mut self, now: f64, simulated: f64, wall: Duration, short: bool) {
        if short || self.speed.is_infinite() {
            self.due = now;
        }
        let wall = wall.as_secs_f64();
        let fade = (-wall / MEMORY).exp();
        self.lately = [self.lately[0] * fade + simulated, self.lately[1] * fade + wall];
    }

    /// Forgets what was: time stands, or goes on from elsewhere.
    pub fn stand(&mut self, now: f64) {
        (self.due, self.lately) = (now, [0.0; 2]);
    }

    /// Simulated seconds a second on the wall lately; none of a simulation that stands.
    pub fn factor(&self) -> Option<f64> {
        Some(self.lately[0] / self.lately[1]).filter(|factor| factor.is_finite())
    }
}

#[cfg(test)]
mod tests;
