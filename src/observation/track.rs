//! Rows of a table at the times that are asked for, which lie between steps.
//!
//! A step ends where it ends. Of a time that is asked for within a step, what is observed at both ends of it is
//! interpolated linearly, whose error is of second order in Δt as that of the steps themselves. The last row is that of
//! the end, whether that is asked for or not.

use crate::components::Cadence;

/// Rows of a table: time (s) and values.
pub type Row = (f64, Vec<f64>);

/// What is observed again and again.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// How often.
    pub every: Cadence,
    /// Step, time and values at the end of the last step that may be needed for an interpolation.
    before: Option<(u64, Row)>,
}

impl Track {
    /// Observed so often.
    pub fn new(every: Cadence) -> Self {
        Self { every, before: None }
    }

    /// The next step, after `step`, at whose end it has to be observed: that of a time that is asked for, or the one
    /// before.
    pub fn next_sample(&self, step: u64) -> u64 {
        let due = self.every.next_after(step);
        if due > step + 1 && self.every.overshoot(due) > 0.0 { due - 1 } else { due }
    }

    /// Whether the next step goes beyond a time that is asked for, so that what is observed before it is needed.
    pub fn precedes(&self, step: u64) -> bool {
        let due = self.every.next_after(step);
        due == step + 1 && self.every.overshoot(due) > 0.0 && self.before.as_ref().is_none_or(|(at, _)| *at != step)
    }

    /// Keeps what is observed before a step.
    pub fn keep(&mut self, step: u64, row: Row) {
        self.before = Some((step, row));
    }

    /// Forgets what was observed: time goes on elsewhere.
    pub fn forget(&mut self) {
        self.before = None;
    }

    /// The rows that are due at a step with what is observed there; `last` is the end.
    pub fn rows(&self, step: u64, last: bool, (time, values): &Row) -> Vec<Row> {
        let due = self.every.is_due(step);
        let overshoot = if due { self.every.overshoot(step) } else { 0.0 };
        let asked = self.every.time_asked(step).filter(|_| due);
        let mut rows = Vec::new();
        match (&self.before, asked) {
            // a time that is a whole number of steps is met in spite of rounding
            (_, Some(asked)) if overshoot == 0.0 => rows.push((asked, values.clone())),
            (Some((at, (from, before))), Some(asked)) if at + 1 == step && *from <= asked && asked < *time => {
                let share = (asked - from) / (time - from);
                let between = before.iter().zip(values).map(|(a, b)| a + share * (b - a)).collect();
                rows.push((asked, between));
            }
            // nothing is known of the beginning of the step: the time is that of its end
            _ if due => rows.push((*time, values.clone())),
            _ => {}
        }
        if last && !due || last && overshoot > 0.0 && rows.last().is_some_and(|(at, _)| at < time) {
            rows.push((*time, values.clone()));
        }
        rows
    }
}

/// When all tables and frames are looked through for what is due.
#[derive(Clone, Copy)]
pub(super) enum Moment {
    /// At the end of a step of a motion, and whether it is the last.
    Step(u64, bool),
    /// At the start or at the end of a static analysis.
    Rest,
    /// On the way there, while loads grow: from a time to a time, in steps that need not be whole. What is observed is
    /// no equilibrium, and has the time it is observed at.
    OnTheWay(f64, f64),
}

impl Moment {
    /// Whether a table needs what is there now.
    pub fn observes(self, track: &Track) -> bool {
        match self {
            Moment::Step(step, _) => self.is_due(&track.every) || track.precedes(step),
            _ => self.is_due(&track.every),
        }
    }

    /// Whether a row or frame is due.
    pub fn is_due(self, every: &Cadence) -> bool {
        match self {
            Moment::Step(step, last) => last || every.is_due(step),
            Moment::Rest => true,
            Moment::OnTheWay(before, now) => every.lies_between(before, now),
        }
    }

    /// The rows that a table gets of what is there now.
    pub fn rows(self, track: &Track, row: &Row) -> Vec<Row> {
        match self {
            Moment::Step(step, last) => track.rows(step, last, row),
            _ => vec![row.clone()],
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    /// Runs over steps, the last of which is the end, and gives all rows; values are 3 t and the step.
    fn table(track: &mut Track, steps: u64, time_step: f64) -> (Vec<Row>, Vec<u64>) {
        let (mut rows, mut samples, mut step) = (Vec::new(), Vec::new(), 0);
        loop {
            let time = step as f64 * time_step;
            let row = (time, vec![3.0 * time, step as f64]);
            samples.push(step);
            rows.extend(track.rows(step, step == steps, &row));
            if track.precedes(step) {
                track.keep(step, row);
            }
            if step == steps {
                return (rows, samples);
            }
            step = track.next_sample(step).min(steps);
        }
    }

    #[test]
    fn rows_are_at_the_times_that_are_asked_for() {
        // 2.3 steps to an interval, and an end that is none
        let (rows, samples) = table(&mut Track::new(Cadence::new(0.23, 0.1)), 10, 0.1);
        let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
        assert_eq!(times, [0.0, 0.23, 0.46, 0.69, 0.92, 1.0]);
        assert_eq!(rows.len() as u64, Cadence::new(0.23, 0.1).rows(10));
        for (time, values) in &rows {
            assert!(
                (values[0] - 3.0 * time).abs() < 1e-12 && (values[1] - 10.0 * time).abs() < 1e-12,
                "{time} {values:?}"
            );
        }
        // both ends of the steps in between, and no others
        assert_eq!(samples, [0, 2, 3, 4, 5, 6, 7, 9, 10]);
    }

    #[test]
    fn whole_numbers_of_steps_are_observed_once() {
        let (rows, samples) = table(&mut Track::new(Cadence::new(0.3, 0.1)), 9, 0.1);
        assert_eq!(rows.iter().map(|row| row.0).collect::<Vec<_>>(), [0.0, 0.3, 0.6, 0.9]);
        assert_eq!(samples, [0, 3, 6, 9]);
        assert_eq!(Cadence::new(0.3, 0.1).rows(9), 4);
    }

    #[test]
    fn what_is_asked_for_more_often_than_there_are_steps_has_a_row_a_step() {
        let (rows, _) = table(&mut Track::new(Cadence::new(0.01, 0.1)), 3, 0.1);
        assert_eq!(rows.iter().map(|row| row.1[1]).collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(Cadence::new(0.01, 0.1).rows(3), 4);
    }

    #[test]
    fn a_row_without_a_beginning_says_the_time_of_its_end() {
        let track = Track::new(Cadence::new(0.25, 0.1));
        assert_eq!(track.rows(3, false, &(0.3, vec![7.0])), [(0.3, vec![7.0])]);
    }
}
