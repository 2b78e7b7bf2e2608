//! The runs of a study, one after the other.

use super::plan::{Fate, Planned};
use super::solver::{Cost, Refusal, Solution, Solver};
use super::study::{Measured, Outcome, Row, StudyObserver};
use std::time::{Duration, Instant};

/// How many times what was predicted a run may take before it is cut off.
const PATIENCE: f64 = 3.0;
/// No run is cut off before it has taken this long (s): what is short takes many times as long on a busy machine.
const SOON: f64 = 5.0;
/// How many times the budget a study may take if predictions were too short.
const OVERTIME: f64 = 1.1;

/// The time of a study.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// When it began.
    pub started: Instant,
    /// What it may take from then on (s).
    pub budget: f64,
}

impl Clock {
    /// What is left (s); less than nothing once all is spent.
    pub fn left(&self) -> f64 {
        self.budget - self.started.elapsed().as_secs_f64()
    }

    /// When everything is cut off. (No study takes longer than a hundred years.)
    pub fn end(&self) -> Instant {
        self.started + Duration::from_secs_f64((OVERTIME * self.budget).min(3e9))
    }
}

/// The runs of a study.
pub struct Work<'a> {
    solver: &'a mut dyn Solver,
    observer: &'a mut dyn StudyObserver,
    clock: Clock,
    done: usize,
    all: usize,
    interrupted: bool,
}

impl<'a> Work<'a> {
    /// Nothing done yet of `all` runs.
    pub fn new(solver: &'a mut dyn Solver, observer: &'a mut dyn StudyObserver, clock: Clock, all: usize) -> Self {
        Self { solver, observer, clock, done: 0, all, interrupted: false }
    }

    /// Whether somebody has ended the study.
    pub fn is_interrupted(&self) -> bool {
        self.interrupted
    }

    /// Runs a configuration if it is to run; its row, and its solution if there is one. `needed`: what a reference is
    /// made of, or the scene itself, may take what time there is; all else is cut off when it takes much longer than
    /// predicted.
    pub fn run(&mut self, planned: &Planned, needed: bool) -> (Row, Option<Solution>) {
        let cost = match &planned.fate {
            Fate::Refused(why) => return (Row::of(planned, Outcome::Refused(why.clone())), None),
            Fate::LeftOut(cost) => {
                let why = format!("predicted {}", rounded(cost.seconds));
                return (Row::of(planned, Outcome::LeftOut(why)), None);
            }
            Fate::Run(cost) => self.now(planned).unwrap_or(*cost),
        };
        if self.interrupted {
            return (Row::of(planned, Outcome::LeftOut("interrupted".into())), None);
        }
        if cost.seconds > self.clock.left() && self.done > 0 {
            let why = format!("the budget is spent; predicted {}", rounded(cost.seconds));
            return (Row::of(planned, Outcome::LeftOut(why)), None);
        }
        self.done += 1;
        self.observer.begins(&planned.label, cost.seconds, self.done, self.all.max(self.done));
        let patience = Instant::now() + Duration::from_secs_f64((PATIENCE * cost.seconds).clamp(SOON, 3e9));
        self.solver.until(if needed { self.clock.end() } else { self.clock.end().min(patience) });
        let (outcome, solution) = match self.solver.solve(&planned.configuration) {
            Ok(solution) => (Outcome::Done(Measured::of(&solution)), Some(solution)),
            Err(Refusal::Refused(why)) => (Outcome::Refused(why), None),
            Err(Refusal::Broke(why)) => (Outcome::Broke(why), None),
            Err(Refusal::TooLong) => {
                let why = format!("cut off, it took longer than the predicted {}", rounded(cost.seconds));
                (Outcome::LeftOut(why), None)
            }
            Err(Refusal::Interrupted) => {
                self.interrupted = true;
                (Outcome::LeftOut("interrupted".into()), None)
            }
        };
        self.observer.ended(&planned.label, &outcome);
        (Row::of(planned, outcome), solution)
    }

    /// Runs what did not fit into the plan if it fits into a share of the time that is left after all; `None` where it
    /// does not.
    pub fn run_if_it_fits(&mut self, planned: &Planned, needed: bool, share: f64) -> Option<(Row, Option<Solution>)> {
        if self.interrupted || !matches!(planned.fate, Fate::LeftOut(_)) {
            return None;
        }
        let cost = self.now(planned).filter(|cost| cost.seconds <= share * self.clock.left())?;
        Some(self.run(&Planned { fate: Fate::Run(cost), ..planned.clone() }, needed))
    }

    /// What a configuration costs, as far as is known by now.
    pub fn now(&mut self, planned: &Planned) -> Option<Cost> {
        self.solver.predict(&planned.configuration).ok()
    }
}

/// Seconds with two digits.
fn rounded(seconds: f64) -> String {
    if seconds >= 10.0 { format!("{seconds:.0} s") } else { format!("{seconds:.2} s") }
}
