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
mod tests {
    use super::*;

    #[test]
    fn what_falls_short_is_not_caught_up_and_what_is_early_is_waited_for() {
        let frame = Duration::from_millis(16);
        let mut pace = Pace { speed: 0.5, ..Pace::new() };
        assert!((pace.until(0.0, frame) - 0.008).abs() < 1e-12);
        // a step went beyond: the next frame goes less far
        pace.note(0.01, 0.01, frame, false);
        assert!((pace.until(0.01, frame) - 0.016).abs() < 1e-12);
        // it came to 0.011 s only
        pace.note(0.011, 0.001, frame, true);
        assert!((pace.until(0.011, frame) - 0.019).abs() < 1e-12);
        // the window was away for a minute
        assert!((pace.until(0.019, Duration::from_secs(60)) - 0.069).abs() < 1e-12);
    }

    #[test]
    fn the_factor_is_what_was_simulated_over_the_wall() {
        let mut pace = Pace::new();
        assert_eq!(pace.factor(), None);
        for _ in 0..400 {
            pace.note(0.0, 0.004, Duration::from_millis(16), true);
        }
        assert!(pace.factor().is_some_and(|factor| (factor - 0.25).abs() < 1e-9), "{pace:?}");
        pace.stand(3.0);
        assert_eq!(pace.factor(), None);
        assert!((pace.until(3.0, Duration::ZERO) - 3.0).abs() < 1e-12);
    }
}
