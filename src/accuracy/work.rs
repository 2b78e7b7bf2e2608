//! The runs of a study, one after the other.

use super::plan::{Fate, Planned};
use super::solver::{Refusal, Solution, Solver};
use super::study::{Measured, Outcome, Row, Watch};
use std::time::Instant;

/// The runs of a study.
pub struct Work<'a> {
    solver: &'a mut dyn Solver,
    watch: &'a mut dyn Watch,
    started: Instant,
    budget: f64,
    done: usize,
    all: usize,
    interrupted: bool,
}

impl<'a> Work<'a> {
    /// Nothing done yet of `all` runs, which may take `budget` from now on (s).
    pub fn new(solver: &'a mut dyn Solver, watch: &'a mut dyn Watch, budget: f64, all: usize) -> Self {
        Self { solver, watch, started: Instant::now(), budget, done: 0, all, interrupted: false }
    }

    /// Whether somebody has ended the study.
    pub fn is_interrupted(&self) -> bool {
        self.interrupted
    }

    /// Runs a configuration if it is to run; its row, and its solution if there is one.
    pub fn run(&mut self, planned: &Planned) -> (Row, Option<Solution>) {
        let cost = match &planned.fate {
            Fate::Refused(why) => return (Row::of(planned, Outcome::Refused(why.clone())), None),
            Fate::LeftOut(cost) => {
                let why = format!("predicted {}", rounded(cost.seconds));
                return (Row::of(planned, Outcome::LeftOut(why)), None);
            }
            Fate::Run(cost) => cost,
        };
        if self.interrupted {
            return (Row::of(planned, Outcome::LeftOut("interrupted".into())), None);
        }
        // predictions are no promises: a quarter more than the budget is the end
        let spent = self.started.elapsed().as_secs_f64();
        if spent + cost.seconds > 1.25 * self.budget {
            let why = format!("the budget is spent; predicted {}", rounded(cost.seconds));
            return (Row::of(planned, Outcome::LeftOut(why)), None);
        }
        self.done += 1;
        self.watch.begins(&planned.label, cost.seconds, self.done, self.all);
        let (outcome, solution) = match self.solver.solve(&planned.configuration) {
            Ok(solution) => (Outcome::Done(Measured::of(&solution)), Some(solution)),
            Err(Refusal::Refused(why)) => (Outcome::Refused(why), None),
            Err(Refusal::Broke(why)) => (Outcome::Broke(why), None),
            Err(Refusal::Interrupted) => {
                self.interrupted = true;
                (Outcome::LeftOut("interrupted".into()), None)
            }
        };
        self.watch.ended(&planned.label, &outcome);
        (Row::of(planned, outcome), solution)
    }
}

/// Seconds with two digits.
fn rounded(seconds: f64) -> String {
    if seconds >= 10.0 { format!("{seconds:.0} s") } else { format!("{seconds:.2} s") }
}
