//! A study: everything a plan holds is run, measured against a reference, and summed up.

use super::configuration::Configuration;
use super::estimate::{Estimate, estimates};
use super::findings::{Findings, findings};
use super::outlook::more;
use super::pareto::front;
use super::plan::{Fate, Plan, Planned, REFERENCE_SHARE, Varied, plan};
use super::reference::{Error, FIELD, Reference, ReferenceSource};
use super::refinement::{self, made, refined};
use super::solver::{Choices, Cost, Refusal, Solution, Solver};
use super::work::{Clock, Work};
use serde::Serialize;
use sinew::scene::suggest::{choice, list};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What is asked of a study.
#[derive(Clone, Debug)]
pub struct Settings {
    /// When it began: reading the scene and looking for mistakes take part of the budget.
    pub started: Instant,
    /// Wall time it may take from then on (s).
    pub budget: f64,
    /// The error that is good enough, relative.
    pub target: f64,
    /// The quantity that configurations are judged by; `None`: the displacement field, or the first that has a
    /// reference.
    pub judged_by: Option<String>,
    /// What to measure against; `None`: a reference made for the study.
    pub reference: Option<Reference>,
}

/// What happens while a study runs.
pub trait StudyObserver {
    /// Costs are being predicted.
    fn predicts(&mut self) {}
    /// Everything has been predicted.
    fn planned(&mut self, plan: &Plan);
    /// A configuration begins: its name, what it should take (s), its number and how many there are.
    fn begins(&mut self, label: &str, seconds: f64, number: usize, all: usize);
    /// It has ended.
    fn ended(&mut self, label: &str, outcome: &Outcome);
}

/// How a configuration ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Outcome {
    /// With a solution.
    Done(Measured),
    /// It was not run.
    LeftOut(String),
    /// It cannot be run.
    Refused(String),
    /// It broke down.
    Broke(String),
}

/// What was measured of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Wall time of the steps (s).
    pub seconds: f64,
    /// How often they were timed; `seconds` is the best.
    pub timed: u32,
    /// Wall time per simulated second (s); wall time where nothing is simulated in time.
    pub seconds_per_second: f64,
    /// Simulated time (s).
    pub simulated: Option<f64>,
    /// Steps.
    pub steps: u64,
    /// Elements.
    pub elements: u64,
    /// Nodes.
    pub nodes: u64,
    /// Δt (s).
    pub time_step: f64,
    /// Where it ran.
    pub backend: String,
    /// Hourglass energy over strain energy at the end.
    pub hourglass_share: f64,
}

/// A configuration and what it came to.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// How it is called.
    pub label: String,
    /// What it varies.
    pub varied: Varied,
    /// The configuration.
    pub configuration: Configuration,
    /// What it should have taken, all in all.
    pub predicted: Option<Cost>,
    /// How it ended.
    pub outcome: Outcome,
    /// Errors by quantity.
    pub errors: BTreeMap<String, Error>,
    /// Whether no other is both cheaper and more accurate.
    pub on_front: bool,
}

/// A study that has come to its end, or to the point where it was interrupted.
#[derive(Debug, Serialize)]
pub struct Study {
    /// The quantity that configurations are judged by.
    pub judged_by: String,
    /// The error that is good enough, relative.
    pub target: f64,
    /// Wall time it might take, was predicted to, and took (s).
    pub budget: f64,
    /// What was predicted (s).
    pub predicted: f64,
    /// What it took (s).
    pub took: f64,
    /// Where the reference comes from.
    pub source: ReferenceSource,
    /// A sentence on it.
    pub reference: String,
    /// Its uncertainty in the quantity judged by, relative.
    pub reference_uncertainty: Option<f64>,
    /// How far the scene as it is written is off, by quantity; the quantity judged by first.
    pub estimates: Vec<Estimate>,
    /// What these do not contain, one sentence each.
    pub unseen: Vec<String>,
    /// What a larger budget would add, in a sentence.
    pub more: Option<String>,
    /// The runs that the reference was made of, by their places in `rows`, from the coarsest mesh on.
    pub made_of: Vec<usize>,
    /// The configurations.
    pub rows: Vec<Row>,
    /// What follows.
    pub findings: Findings,
    /// What the author should know.
    pub notes: Vec<String>,
    /// Whether somebody ended it early.
    pub interrupted: bool,
}

impl Row {
    /// What was measured, if it ended with a solution.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Done(measured) => Some(measured),
            _ => None,
        }
    }

    pub(super) fn of(planned: &Planned, outcome: Outcome) -> Self {
        let predicted = match planned.fate {
            Fate::Run(cost) | Fate::LeftOut(cost) => Some(cost),
            Fate::Refused(_) => None,
        };
        let (label, configuration) = (planned.label.clone(), planned.configuration.clone());
        let errors = BTreeMap::new();
        Self { label, varied: planned.varied, configuration, predicted, outcome, errors, on_front: false }
    }
}

/// Runs a study.
///
/// # Errors
/// That the scene as it is written cannot be solved, or that a quantity is asked for that it does not have.
pub fn study(solver: &mut dyn Solver, settings: &Settings, observer: &mut dyn StudyObserver) -> Result<Study, Refusal> {
    let clock = Clock { started: settings.started, budget: settings.budget };
    // a budget too small for anything still has a plan that says so
    solver.until(clock.end().max(Instant::now() + PLANNING));
    observer.predicts();
    let choices = solver.choices()?;
    check_names(&choices, settings)?;
    let plan = plan(solver, &choices, (clock.budget, clock.started), settings.reference.is_none())?;
    observer.planned(&plan);
    let running = plan.rows.iter().filter(|row| matches!(row.fate, Fate::Run(_))).count();
    let mut work = Work::new(solver, observer, clock, running);
    let needed = |place: usize| place == 0 || plan.reference.contains(&place);

    let mut done: Vec<Option<(Row, Option<Solution>)>> = plan.rows.iter().map(|_| None).collect();
    let (basis, rest) = plan.order.split_at(plan.basis());
    for &place in basis {
        done[place] = Some(work.run(&plan.rows[place], needed(place)));
    }
    // what has run tells better what a finer mesh would take
    let came_to_an_end = |place: &usize| done[*place].as_ref().is_some_and(|(_, solution)| solution.is_some());
    let mut finest = plan.reference.last().copied().filter(came_to_an_end);
    while let Some(place) = finest.and_then(|place| refinement::finer(&choices, &plan.rows, place)) {
        finest = work.run_if_it_fits(&plan.rows[place], true, REFERENCE_SHARE).map(|run| {
            done[place] = Some(run);
            place
        });
    }
    for &place in rest {
        if done[place].is_none() {
            done[place] = Some(work.run(&plan.rows[place], needed(place)));
        }
    }
    for &place in &plan.order {
        let ran = done[place].as_ref().is_some_and(|(_, solution)| solution.is_some());
        if !ran && let Some(run) = work.run_if_it_fits(&plan.rows[place], needed(place), 1.0) {
            done[place] = Some(run);
        }
    }
    let (mut rows, solutions): (Vec<Row>, Vec<Option<Solution>>) = done.into_iter().flatten().unzip();
    let refined = refined(&choices, &rows, &solutions, settings.reference.is_none());
    let reference = match &settings.reference {
        Some(given) => given.clone(),
        None => made(&refined, &choices, &rows, &solutions)
            .unwrap_or_else(|| Reference::none(plan.no_reference.as_deref().unwrap_or(TOO_FEW))),
    };
    for (row, solution) in rows.iter_mut().zip(&solutions) {
        row.errors = solution.as_ref().map(|solution| reference.errors(solution)).unwrap_or_default();
    }
    let more = more(&mut work, &choices, &plan, &rows, reference.source);
    let interrupted = work.is_interrupted();
    let judged_by = judged_by(settings, &rows);
    let points: Vec<(f64, f64)> = rows.iter().map(|row| point(row, &judged_by)).collect();
    for (row, on_front) in rows.iter_mut().zip(front(&points)) {
        row.on_front = on_front;
    }
    let findings = findings(&rows, &solutions, &reference, &judged_by, settings.target);
    let known = rows.iter().find_map(|row| row.errors.get(&judged_by));
    Ok(Study {
        reference_uncertainty: known.map(|error| error.uncertainty),
        estimates: estimates(&rows, &solutions, &reference, &refined, &judged_by),
        unseen: if reference.source == ReferenceSource::SelfMade { choices.unseen } else { Vec::new() },
        more,
        judged_by,
        target: settings.target,
        budget: settings.budget,
        predicted: plan.predicted,
        took: clock.started.elapsed().as_secs_f64(),
        source: reference.source,
        reference: reference.told,
        made_of: refined.places,
        rows,
        findings,
        notes: choices.notes,
        interrupted,
    })
}

/// Predictions may take this long, whatever the budget.
const PLANNING: Duration = Duration::from_secs(10);

/// Why there is no reference though one was planned.
const TOO_FEW: &str = "fewer than two of the meshes it is made of came to an end";

/// Where a row stands in the plot: wall time per simulated second, and the error that can be vouched for. What solves
/// another problem stands nowhere.
fn point(row: &Row, judged_by: &str) -> (f64, f64) {
    let error = row.errors.get(judged_by).filter(|_| row.varied.is_ranked());
    match (row.measured(), error) {
        (Some(measured), Some(error)) => (measured.seconds_per_second, error.vouched()),
        _ => (f64::NAN, f64::NAN),
    }
}

fn judged_by(settings: &Settings, rows: &[Row]) -> String {
    let known: Vec<&String> = rows.iter().flat_map(|row| row.errors.keys()).collect();
    let field = || known.iter().find(|name| *name.as_str() == *FIELD[0]).copied();
    let named = settings.judged_by.as_ref();
    named.or_else(field).or(known.first().copied()).cloned().unwrap_or_else(|| FIELD[0].into())
}

/// Whether all quantities that somebody names are there.
fn check_names(choices: &Choices, settings: &Settings) -> Result<(), Refusal> {
    let named = settings.reference.iter().flat_map(|reference| reference.entries.keys()).chain(&settings.judged_by);
    for name in named {
        let channel = [".over_time", ".amplitude", ".period"].iter().find_map(|kind| name.strip_suffix(kind));
        let channel = channel.unwrap_or(name);
        if !FIELD.contains(&name.as_str()) && !choices.quantities.iter().any(|known| known == channel) {
            let known: Vec<&str> = choices.quantities.iter().map(String::as_str).chain(FIELD).collect();
            let notes = choice(name, known.iter().copied());
            let kinds = "each also as .over_time, and .amplitude and .period where it swings";
            let told = notes.first().filter(|_| notes.len() > 1).map_or(String::new(), |hint| format!(" {hint};"));
            return Err(Refusal::Refused(format!(
                "there is no quantity `{name}` in the scene;{told} there are {} ({kinds})",
                list(&known)
            )));
        }
    }
    Ok(())
}

impl Measured {
    pub(super) fn of(solution: &Solution) -> Self {
        Self {
            seconds: solution.seconds,
            timed: solution.timed,
            seconds_per_second: solution.seconds_per_second(),
            simulated: solution.simulated,
            steps: solution.steps,
            elements: solution.elements,
            nodes: solution.nodes,
            time_step: solution.time_step,
            backend: solution.backend.clone(),
            hourglass_share: solution.hourglass_share,
        }
    }
}
