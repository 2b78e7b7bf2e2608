//! Rows of a table at the times that are asked for, which lie between steps.
//!
//! A step ends where it ends. Of a time that is asked for within a step, what is observed at both ends of it is
//! interpolated linearly, whose error is of second order in Δt as that of the steps themselves. The last row is that of
//! the end, whether that is asked for or not.

use crate::components::Cadence;
use crate::math::{degrees, turned};
use crate::scene::schema::Quantity;
use glam::DVec3;

/// Rows of a table: time (s) and values.
pub type Row = (f64, Vec<f64>);

/// What is observed again and again.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// How often.
    pub every: Cadence,
    /// Step, time and values at the end of the last step that may be needed for an interpolation.
    before: Option<(u64, Row)>,
    /// Where among the values three are a rotation, axis times angle (degrees).
    turn: Option<usize>,
}

impl Track {
    /// Observed so often.
    pub fn new(every: Cadence) -> Self {
        Self { every, ..Self::default() }
    }

    /// The same, with three values that are a rotation, axis times angle (degrees), from this place on if there is one.
    pub fn with_turn(self, turn: Option<usize>) -> Self {
        Self { turn, ..self }
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

    /// Whether a time that is asked for lies within the step that led to this one, at whose beginning nothing was
    /// observed, as where a run goes on from its end: the row there is of another time.
    pub fn lacks_beginning(&self, step: u64) -> bool {
        let is_known = self.before.as_ref().is_some_and(|(at, _)| at + 1 == step);
        self.every.is_due(step) && self.every.overshoot(step) > 0.0 && !is_known
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
                rows.push((asked, between(self.turn, [before, values], share)));
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

/// Where among what a probe sees three values are a rotation, axis times angle (degrees).
pub fn turn_of(what: &Quantity) -> Option<usize> {
    // place, and then rotation
    matches!(what, Quantity::ToolPose { .. }).then_some(3)
}

/// What is a share of the way from some values to others. Rotations, three values from `turn` on, go the shorter way
/// round, as a step does: their numbers jump at half a turn.
pub fn between(turn: Option<usize>, [before, after]: [&[f64]; 2], share: f64) -> Vec<f64> {
    let mut between: Vec<f64> = before.iter().zip(after).map(|(a, b)| a + share * (b - a)).collect();
    if let Some(turn) = turn.map(|at| at..at + 3).filter(|turn| turn.end <= between.len()) {
        let [from, to] = [before, after].map(|values| turned(DVec3::from_slice(&values[turn.clone()])));
        between[turn].copy_from_slice(&degrees(from.slerp(to, share)).to_array());
    }
    between
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

    /// Whether these rows are of times that are asked for, or of the end.
    pub fn is_on_time(self, track: &Track) -> bool {
        !matches!(self, Moment::Step(step, false) if track.lacks_beginning(step))
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
mod tests;
