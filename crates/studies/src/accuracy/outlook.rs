//! What a larger budget would add.

use super::configuration::Factor;
use super::plan::Plan;
use super::reference::ReferenceSource;
use super::refinement;
use super::solver::Choices;
use super::study::{Outcome, Row};
use super::work::Work;

/// The scene itself or the next finer mesh of a reference, whichever is cheaper, if it was left out: what it would
/// cost.
pub fn more(
    work: &mut Work<'_>,
    choices: &Choices,
    plan: &Plan,
    rows: &[Row],
    source: ReferenceSource,
) -> Option<String> {
    let left_out = |place: &usize| matches!(rows[*place].outcome, Outcome::LeftOut(_));
    let mut all: Vec<(f64, usize)> = Vec::new();
    for place in (0..rows.len()).filter(left_out) {
        all.extend(work.now(&plan.rows[place]).map(|cost| (cost.seconds, place)));
    }
    let finer = |&&(_, place): &&(f64, usize)| {
        let row = &rows[place].configuration;
        place == 0 || (row.mesh >= Factor::ONE && *row == refinement::way(choices, row.mesh))
    };
    let next = all.iter().filter(finer).min_by(|a, b| a.0.total_cmp(&b.0));
    let (seconds, place) = next.filter(|_| matches!(source, ReferenceSource::SelfMade | ReferenceSource::None))?;
    let budget = rounded_up(plan.budget + 1.15 * seconds);
    Some(format!("--budget {budget} would add `{}`, which takes about {}", rows[*place].label, time(*seconds)))
}

/// A budget as somebody would type it: `90s`, `12min`, `3h`.
fn rounded_up(seconds: f64) -> String {
    match seconds {
        s if s < 180.0 => format!("{:.0}s", (s / 10.0).ceil() * 10.0),
        s if s < 10800.0 => format!("{:.0}min", (s / 60.0).ceil()),
        s => format!("{:.0}h", (s / 3600.0).ceil()),
    }
}

/// Seconds, minutes or hours.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 180.0 => format!("{s:.0} s"),
        s if s < 10800.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}
