//! A study as tables: CSV and Markdown. (JSON is the study itself.)

use super::advice::{percent, seconds, told};
use super::plan::Varied;
use super::reference::ReferenceSource;
use super::study::{Outcome, Row, Study};
use std::collections::BTreeSet;

/// The cells of a row as people read them: name, elements, steps, Δt, time, ratio to the scene as it is written, error.
pub struct Cells {
    /// The configuration.
    pub label: String,
    /// Elements, steps, wall time per simulated second, times that of the scene as written; empty where it did not run.
    pub numbers: [String; 4],
    /// The error in the quantity judged by, or why there is none.
    pub error: String,
    /// Whether it is on the Pareto front.
    pub on_front: bool,
}

/// The headings of [`Cells`]; `per_second`: whether something is simulated in time.
pub fn headings(study: &Study) -> [String; 6] {
    let timed = study.rows.iter().filter_map(Row::measured).all(|measured| measured.simulated.is_some());
    let time = if timed { "time a second" } else { "time" };
    ["configuration", "elements", "steps", time, "cost", &format!("error of {}", study.judged_by)].map(String::from)
}

/// The rows of a study for people: in its order, effects left out.
pub fn cells(study: &Study) -> Vec<Cells> {
    let written = study.rows.iter().find(|row| row.varied == Varied::Nothing).and_then(Row::measured);
    let rows = study.rows.iter().filter(|row| row.varied != Varied::Effect);
    rows.map(|row| {
        let error = match (&row.outcome, row.errors.get(&study.judged_by)) {
            (Outcome::Done(_), Some(error)) => told(error),
            (Outcome::Done(_), None) => "—".into(),
            (Outcome::LeftOut(why), _) => format!("left out: {why}"),
            (Outcome::Refused(why), _) => format!("refused: {why}"),
            (Outcome::Broke(why), _) => format!("broke down: {why}"),
        };
        let numbers = match row.measured() {
            None => Default::default(),
            Some(m) => [
                m.elements.to_string(),
                m.steps.to_string(),
                seconds(m.seconds_per_second),
                written
                    .map_or_else(|| "—".into(), |w| format!("×{}", ratio(m.seconds_per_second / w.seconds_per_second))),
            ],
        };
        Cells { label: row.label.clone(), numbers, error, on_front: row.on_front }
    })
    .collect()
}

/// Two digits: `0.13`, `1.9`, `64`.
fn ratio(value: f64) -> String {
    match value {
        v if v >= 9.95 => format!("{v:.0}"),
        v if v >= 0.995 => format!("{v:.1}"),
        v if v >= 0.0995 => format!("{v:.2}"),
        v if v >= 9.95e-4 => format!("{v:.3}"),
        v => format!("{v:.1e}"),
    }
}

/// The parts of the error, in words.
pub fn split(study: &Study) -> Vec<(&'static str, String)> {
    let split = &study.findings.split;
    let at_rest = study.rows.iter().filter_map(Row::measured).any(|measured| measured.simulated.is_none());
    let parts = [
        ("space", split.space),
        ("time", split.time),
        ("round-off", split.round_off),
        ("model", split.model),
        ("hourglass", split.hourglass),
    ];
    let mut lines: Vec<(&'static str, String)> = Vec::new();
    for (name, part) in parts {
        let bound = if name == "space" && split.space_is_a_bound { "below " } else { "" };
        let told = |part| format!("{bound}{}", percent(part));
        lines.push((name, part.map_or_else(|| unknown(name, study.source, at_rest), told)));
    }
    lines
}

/// Why a part of the error has no number.
fn unknown(part: &str, source: ReferenceSource, at_rest: bool) -> String {
    match (part, source) {
        ("time", _) if at_rest => "none: what is sought is at rest",
        ("model", ReferenceSource::SelfMade) => "not seen: the reference shares it",
        ("model", ReferenceSource::Values | ReferenceSource::Files) => "none that can be told",
        ("hourglass", _) => "not varied",
        _ => "not known",
    }
    .into()
}

/// All rows and all quantities, for programs: one line a configuration.
pub fn csv(study: &Study) -> String {
    let part = |place| if study.made_of.contains(&place) { "reference" } else { "study" };
    let rows = || study.rows.iter().enumerate().map(|(place, row)| (part(place), row));
    let quantities: BTreeSet<&String> = study.rows.iter().flat_map(|row| row.errors.keys()).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = [
        "configuration",
        "part",
        "varied",
        "element",
        "mesh",
        "step divided by",
        "number type",
        "solver",
        "hourglass",
        "outcome",
        "why",
        "elements",
        "nodes",
        "steps",
        "time step (s)",
        "simulated (s)",
        "wall time (s)",
        "wall time per simulated second (s)",
        "predicted (s)",
        "hourglass over strain energy",
        "backend",
        "on front",
    ]
    .map(String::from)
    .to_vec();
    for quantity in &quantities {
        header.extend([format!("{quantity} error"), format!("{quantity} uncertainty")]);
    }
    // writing into memory does not fail
    let _ = writer.write_record(&header);
    for (part, row) in rows() {
        let (outcome, why) = match &row.outcome {
            Outcome::Done(_) => ("done", ""),
            Outcome::LeftOut(why) => ("left out", why.as_str()),
            Outcome::Refused(why) => ("refused", why.as_str()),
            Outcome::Broke(why) => ("broke down", why.as_str()),
        };
        let c = &row.configuration;
        let mut line: Vec<String> = vec![
            row.label.clone(),
            part.into(),
            format!("{:?}", row.varied),
            c.element_name(),
            c.mesh.value().to_string(),
            c.step.to_string(),
            c.digits.to_string(),
            c.method.to_string(),
            c.hourglass.to_string(),
            outcome.into(),
            why.into(),
        ];
        let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        let predicted = number(row.predicted.map(|cost| cost.seconds));
        match row.measured() {
            Some(m) => line.extend([
                m.elements.to_string(),
                m.nodes.to_string(),
                m.steps.to_string(),
                m.time_step.to_string(),
                number(m.simulated),
                m.seconds.to_string(),
                m.seconds_per_second.to_string(),
                predicted,
                m.hourglass_share.to_string(),
                m.backend.clone(),
            ]),
            None => {
                line.extend(vec![String::new(); 7]);
                line.extend([predicted, String::new(), String::new()]);
            }
        }
        line.push(row.on_front.to_string());
        for quantity in &quantities {
            let error = row.errors.get(*quantity);
            line.extend([number(error.map(|e| e.error)), number(error.map(|e| e.uncertainty))]);
        }
        let _ = writer.write_record(&line);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// What effects cost and change, for programs.
pub fn effects_csv(study: &Study) -> String {
    let mut text = String::from("effect,share of the time,relative change when switched off\n");
    for effect in &study.findings.effects {
        text += &format!("\"{}\",{},{}\n", effect.effect.replace('"', "\"\""), effect.costs, effect.changes);
    }
    text
}

/// A page on the study, with the plot beside it.
pub fn markdown(study: &Study, title: &str, command: &str) -> String {
    let mut text = format!("# What accuracy costs: {title}\n\n`{command}`\n\n![error against time](accuracy.png)\n\n");
    for estimate in &study.estimates {
        text += &format!("**{}** as written: {}.\n\n", estimate.quantity, estimate.sentence());
    }
    for sentence in &study.unseen {
        text += &format!("Not contained: {sentence}.\n\n");
    }
    for sentence in &study.findings.advice {
        text += &format!("{sentence}\n");
    }
    text += &format!("\nErrors are relative, in {}. Reference: {}.", study.judged_by, study.reference);
    if let Some(uncertainty) = study.reference_uncertainty.filter(|uncertainty| *uncertainty > 0.0) {
        text += &format!(
            " It may itself be off by {}; errors below three times that are told as bounds.",
            percent(uncertainty)
        );
    }
    text += "\n\n";
    let headings = headings(study);
    text += &format!("| {} | front |\n|---|--:|--:|--:|--:|--:|---|\n", headings.join(" | "));
    for row in cells(study) {
        let front = if row.on_front { "●" } else { "" };
        text +=
            &format!("| {} | {} | {} | {front} |\n", row.label, row.numbers.join(" | "), row.error.replace('|', "\\|"));
    }
    text += "\n| part of the error as written | |\n|---|--:|\n";
    for (part, size) in split(study) {
        text += &format!("| {part} | {size} |\n");
    }
    if !study.findings.orders.is_empty() {
        text += "\n| observed order | | rows |\n|---|--:|--:|\n";
        for order in &study.findings.orders {
            text += &format!("| {} | {:.2} | {} |\n", order.of, order.order, order.rows);
        }
    }
    if !study.findings.effects.is_empty() {
        text += "\n| effect | costs of the time | changes the result by |\n|---|--:|--:|\n";
        for effect in &study.findings.effects {
            text += &format!("| {} | {} | {} |\n", effect.effect, percent(effect.costs), percent(effect.changes));
        }
    }
    for note in &study.notes {
        text += &format!("\nNote: {note}.\n");
    }
    text
}
