//! `sinew sweep`: many variants of a scene, or a part of them.

use super::arguments::{SweepArguments, allowed, default_folder};
use super::failure::Failure;
use super::terminal;
use super::wording::{counted, quantity};
use super::{Outcome, interrupt};
use sinew_studies::sweep::{Done, Ended, How, Sweep, SweepError};

/// Runs what is missing of a sweep, and tells what came of it.
pub fn command(arguments: &SweepArguments) -> Outcome {
    let sweep = Sweep::load(&arguments.sweep, allowed(arguments.allow_outside))?;
    let out = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.sweep));
    let places = sweep.places();
    interrupt::listen();
    let how = How {
        options: arguments.options(),
        at_once: arguments.at_once(),
        part: arguments.part,
        out: &out,
        stop: &interrupt::is_asked,
    };
    let outcome = sweep.run(&how, |row| {
        let values = places.iter().filter_map(|place| Some(format!("{place}={}", row.values.get(*place)?)));
        let values = values.collect::<Vec<_>>().join(" ");
        let took = quantity(row.seconds, "s");
        terminal::detail(&format!("variant {}: {values}: {} after {took}\n", row.number, row.ended));
    })?;
    let files = outcome.files.each_ref().map(|file| file.file_name().unwrap_or(file.as_os_str()).to_string_lossy());
    terminal::say(&format!(
        "{}\noutputs     {}: {}\n",
        in_words(&outcome.rows, outcome.before),
        out.display(),
        files.join(", ")
    ))?;
    if outcome.rows.len() < outcome.variants {
        let missing = counted((outcome.variants - outcome.rows.len()) as u64, "variant");
        terminal::note(&format!("{missing} missing: the same command goes on\n"));
        return Err(Failure::Interrupted);
    }
    // where no values make sense it is the sweep that does not
    match outcome.rows.iter().find(|row| row.ended != Ended::SceneError) {
        Some(_) => Ok(()),
        None => Err(Failure::Options(format!(
            "the values of no variant make sense in the scene; of the first:\n{}",
            outcome.rows.first().and_then(|row| row.error.as_deref()).unwrap_or_default()
        ))),
    }
}

/// How variants ended, the first that did not end well, and the first that was warned of.
fn in_words(rows: &[Done], before: usize) -> String {
    let of = |ended: Ended| rows.iter().filter(|row| row.ended == ended).count();
    let mut parts = Vec::new();
    for (ended, word) in [
        (Ended::Finished, "finished"),
        (Ended::Unstable, "broke down"),
        (Ended::NotConverged, "found no rest"),
        (Ended::SceneError, "with values that make no sense"),
    ] {
        if of(ended) > 0 {
            parts.push(format!("{} {word}", of(ended)));
        }
    }
    if before > 0 {
        parts.push(format!("{before} of them there already"));
    }
    let warned = rows.iter().filter(|row| !row.warnings.is_empty()).count();
    if warned > 0 {
        parts.push(format!("{warned} of them warned of"));
    }
    let mut text = format!("{}: {}", counted(rows.len() as u64, "variant"), parts.join(", "));
    if let Some(row) = rows.iter().find(|row| row.ended != Ended::Finished) {
        let line = row.error.as_deref().unwrap_or_default().lines().next().unwrap_or_default();
        text += &format!("\nvariant {}   {line}", row.number);
    }
    if let Some((row, warning)) = rows.iter().find_map(|row| Some((row, row.warnings.first()?))) {
        text += &format!("\nvariant {}   warning: {warning}", row.number);
    }
    text
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Scene(diagnostics) => Failure::Engine(Box::new(sinew::Error::Scene(diagnostics))),
            SweepError::Engine(error) => Failure::Engine(error),
            SweepError::File(what) => Failure::Options(what),
            error @ SweepError::Files(..) => Failure::Results(error.to_string()),
        }
    }
}
