//! What probes see at times that are asked for, wherever steps end.

use super::Simulation;
use super::run::WHOLE;
use crate::error::Error;
use crate::observation::{between, turn_of};

/// A time (s), and what some probes see then.
type Seen = (f64, Vec<Vec<f64>>);

impl Simulation {
    /// Goes on to the first of some ascending times (s), and says what some probes see then, by their names in this
    /// order, and at those of the times after it that no further step is needed for: as many as there are, and one at
    /// least. Times within a step are interpolated as in tables. Where the first has passed, what is there now is seen.
    ///
    /// # Errors
    /// As [`Simulation::advance`]; no such probe; that a static analysis has no times.
    #[doc(hidden)]
    pub fn probes_at(&mut self, names: &[String], times: &[f64]) -> Result<Vec<Vec<Vec<f64>>>, Error> {
        if self.scene().is_static() {
            return Err(Error::Options("a static analysis has no times at which probes could be asked".into()));
        }
        let Some(&first) = times.first() else { return Ok(Vec::new()) };
        let (before, now) = loop {
            self.advance_short_of(first, u64::MAX)?;
            let before = self.seen_by(names)?;
            if self.steps_until(first) == 0 {
                break (before.clone(), before);
            }
            self.step()?;
            if self.steps_until(first) == 0 {
                break (before, self.seen_by(names)?);
            }
        };
        let end = now.0 + WHOLE * self.time_step();
        let count = times.iter().take_while(|time| **time <= end).count().max(1);
        Ok(times[..count].iter().map(|&time| self.seen_at(time, names, [&before, &now])).collect())
    }

    fn seen_by(&mut self, names: &[String]) -> Result<Seen, Error> {
        let probes = names.iter().map(|name| self.probe(name)).collect::<Result<_, _>>()?;
        Ok((self.time(), probes))
    }

    /// What is seen at a time between two others.
    fn seen_at(&self, time: f64, names: &[String], [(from, before), (to, after)]: [&Seen; 2]) -> Vec<Vec<f64>> {
        // a time that is a whole number of steps is met in spite of rounding
        if from >= to || time >= to - WHOLE * self.time_step() {
            return after.clone();
        }
        let share = (time - from) / (to - from);
        let turn = |name: &String| self.scene().probes.get(name).and_then(|probe| turn_of(&probe.what));
        let each = names.iter().zip(before.iter().zip(after));
        each.map(|(name, (before, after))| between(turn(name), [before, after], share)).collect()
    }
}
