//! The hard cases: what must stay stable, or fail honestly. `sinew hard` runs them; `docs/stability.md` is their
//! record.
//!
//! A case is a scene in `scenes/hard/` (its gates stand at its head) and a function that runs it in a configuration and
//! measures. Nothing is dropped: a case that ends in an honest failure where it should pass is shown as that.

mod cases;
mod configuration;
mod implicit;
mod known;
mod monitor;
mod report;
mod trial;

pub use cases::CASES;
pub use configuration::CaseConfiguration;
pub use implicit::Implicitly;
pub use known::{SHORTFALLS, Shortfall, known};
pub use monitor::Monitor;
pub use report::{by_case, csv, markdown};
pub use trial::{Gate, Trial};

use serde::Serialize;
use sinew::Error;
use sinew::mesh::ElementKind;
use std::time::Instant;

/// One of the hard cases.
pub struct Case {
    /// H01 to H70; those of contact from H36 on, some of which are missing yet.
    pub id: &'static str,
    /// What it is, as a file name has it: `squeezed_cube`.
    pub name: &'static str,
    /// What happens.
    pub title: &'static str,
    /// Its gates.
    pub passes_when: &'static str,
    /// The text of its scene.
    pub scene: &'static str,
    /// Whether a configuration is one of its own, or would only repeat another.
    pub on: fn(&CaseConfiguration) -> bool,
    /// What it means under implicit steps.
    pub implicitly: Implicitly,
    /// Which rows take minutes, so that everyday tests run one of them or none.
    pub slow: Slow,
    /// Runs it and measures.
    pub run: fn(&mut Trial<'_>) -> Result<(), Error>,
}

/// Which rows of a case take minutes. `sinew hard` leaves nothing out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slow {
    /// Those of a GPU in software.
    pub software: bool,
    /// Those of implicit steps, of which one is enough.
    pub implicit: bool,
}

impl Slow {
    pub(crate) const NOTHING: Self = Self { software: false, implicit: false };
    pub(crate) const IN_SOFTWARE: Self = Self { software: true, implicit: false };
    pub(crate) const BOTH: Self = Self { software: true, implicit: true };
}

impl Case {
    /// The file of its scene.
    pub fn file(&self) -> String {
        format!("scenes/hard/{}_{}.ron", self.id.to_lowercase(), self.name)
    }

    /// Whether a configuration has a row of its own; of what is not meant under implicit steps one says so.
    pub fn has_row(&self, configuration: &CaseConfiguration) -> bool {
        let said = !configuration.implicit
            || !matches!(self.implicitly, Implicitly::NotMeant(_))
            || configuration.elements == ElementKind::Hex8;
        (self.on)(configuration) && said
    }
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseVerdict {
    /// All gates passed.
    Passed,
    /// It could not be simulated to the end and said so: where, when, why (G5).
    FailedHonestly,
    /// A gate did not pass.
    Failed,
    /// It has no meaning there, and says why.
    NotMeant,
}

impl std::fmt::Display for CaseVerdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            CaseVerdict::Passed => "passed",
            CaseVerdict::FailedHonestly => "failed honestly",
            CaseVerdict::Failed => "FAILED",
            CaseVerdict::NotMeant => "not meant",
        })
    }
}

/// A case in one configuration: what came out.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The case.
    pub case: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Elements.
    pub elements: &'static str,
    /// Backend and number type.
    pub machine: &'static str,
    /// How it ended.
    pub verdict: CaseVerdict,
    /// How it should: with a pass, or as is known and explained.
    pub expected: CaseVerdict,
    /// All that was measured.
    pub gates: Vec<Gate>,
    /// What an honest failure said.
    pub message: Option<String>,
    /// Why this is how it has to end today, where it is not a pass.
    pub known: Option<&'static str>,
    /// Wall time (s).
    pub seconds: f64,
}

impl Row {
    /// The gate that used most of what is allowed.
    pub fn tightest(&self) -> Option<&Gate> {
        self.gates.iter().max_by(|a, b| a.used.total_cmp(&b.used))
    }
}

/// Runs a case in a configuration.
pub fn run(case: &Case, configuration: &CaseConfiguration, full: bool) -> Row {
    if let (true, Implicitly::NotMeant(why)) = (configuration.implicit, &case.implicitly) {
        return not_meant(case, configuration, why);
    }
    let started = Instant::now();
    // finer meshes and longer runs are those of explicit steps
    let full = full && !configuration.implicit;
    let mut trial = Trial { case, configuration, full, gates: Vec::new() };
    let ended = (case.run)(&mut trial);
    let gates = trial.gates;
    let all_passed = gates.iter().all(|gate| gate.passed) && !gates.is_empty();
    let (verdict, message) = match ended {
        Ok(()) if all_passed => (CaseVerdict::Passed, None),
        Ok(()) => (CaseVerdict::Failed, None),
        Err(error @ (Error::Unstable(_) | Error::NotConverged(_))) => {
            (CaseVerdict::FailedHonestly, Some(error.to_string()))
        }
        Err(error) => (CaseVerdict::Failed, Some(error.to_string())),
    };
    let known = known(case.id, configuration, full);
    let expected = known.map_or(CaseVerdict::Passed, |known| known.verdict);
    let known = known.filter(|known| known.verdict == verdict).map(|known| known.why);
    let (elements, machine) = (configuration.elements_name(), configuration.machine());
    let seconds = started.elapsed().as_secs_f64();
    Row { case: case.id, title: case.title, elements, machine, verdict, expected, gates, message, known, seconds }
}

/// The row of a case that says why it is not run.
fn not_meant(case: &Case, configuration: &CaseConfiguration, why: &str) -> Row {
    Row {
        case: case.id,
        title: case.title,
        elements: "all",
        machine: configuration.machine(),
        verdict: CaseVerdict::NotMeant,
        expected: CaseVerdict::NotMeant,
        gates: Vec::new(),
        message: Some(why.into()),
        known: None,
        seconds: 0.0,
    }
}
