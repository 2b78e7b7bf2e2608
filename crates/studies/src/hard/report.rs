//! What came out, as tables.

use super::{CaseVerdict, Row};
use std::fmt::Write;

/// Figure of the tightest gate, or what a failure said.
fn figure(row: &Row) -> String {
    let gate = row.tightest().map(|gate| format!("{} {:.3e} ({})", gate.what, gate.figure, gate.allowed));
    match (&row.message, gate) {
        (Some(message), _) => message.clone(),
        (None, gate) => gate.unwrap_or_else(|| "nothing was measured".into()),
    }
}

/// A Markdown table: a row a case and configuration.
pub fn markdown(rows: &[Row]) -> String {
    let mut text =
        String::from("| case | elements | on | verdict | tightest gate | time (s) |\n|---|---|---|---|---|---|\n");
    for row in rows {
        let verdict = match row.verdict {
            CaseVerdict::Passed | CaseVerdict::NotMeant => row.verdict.to_string(),
            _ => format!("**{}**", row.verdict),
        };
        let (elements, machine, seconds) = (row.elements, row.machine, row.seconds);
        text += &format!(
            "| {} | {elements} | {machine} | {verdict} | {} | {seconds:.2} |\n",
            row.case,
            figure(row).replace('|', "\\|")
        );
    }
    text
}

/// A Markdown table: a row a case, a column a machine, and how many of the elements pass there.
pub fn by_case(rows: &[Row]) -> String {
    let (mut cases, mut machines) = (Vec::new(), Vec::new());
    for row in rows {
        if !cases.contains(&(row.case, row.title)) {
            cases.push((row.case, row.title));
        }
        if !machines.contains(&row.machine) {
            machines.push(row.machine);
        }
    }
    let mut text = format!("| case | {} |\n|---{}|\n", machines.join(" | "), "|---".repeat(machines.len()));
    for (case, title) in cases {
        let _ = write!(text, "| {} {title}", case.to_uppercase());
        for &machine in &machines {
            let here: Vec<&Row> = rows.iter().filter(|row| row.case == case && row.machine == machine).collect();
            let _ = write!(text, " | {}", cell(&here).replace('|', "\\|"));
        }
        text += " |\n";
    }
    text
}

/// How a case ended on a machine: `all 4`, or which elements did not pass and why.
fn cell(rows: &[&Row]) -> String {
    let passed = rows.iter().filter(|row| row.verdict == CaseVerdict::Passed).count();
    let mut text = match rows {
        [] => return String::new(),
        [row] if row.verdict == CaseVerdict::NotMeant => {
            return format!("not meant: {}", row.message.as_deref().unwrap_or_default());
        }
        [row] if row.verdict == CaseVerdict::Passed => return "passed".into(),
        _ if passed == rows.len() => return format!("all {passed}"),
        [first, _, ..] if rows.iter().all(|row| row.verdict == first.verdict && row.known == first.known) => {
            let why = first.known.map(|why| format!(": {why}")).unwrap_or_default();
            return format!("none of {}: **{}**{why}", rows.len(), first.verdict.to_string().to_lowercase());
        }
        _ => format!("{passed} of {}", rows.len()),
    };
    for row in rows.iter().filter(|row| row.verdict != CaseVerdict::Passed) {
        let why = row.known.map(|why| format!(": {why}")).unwrap_or_default();
        let _ = write!(text, "; {} **{}**{why}", row.elements, row.verdict.to_string().to_lowercase());
    }
    text
}

/// All gates of all rows as CSV.
pub fn csv(rows: &[Row]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // memory takes everything
    let _ = writer.write_record([
        "case", "elements", "on", "verdict", "gate", "figure", "allowed", "passed", "seconds", "message",
    ]);
    for row in rows {
        for gate in &row.gates {
            let (figure, passed, seconds) = (gate.figure.to_string(), gate.passed.to_string(), row.seconds.to_string());
            let verdict = row.verdict.to_string();
            let message = row.message.clone().unwrap_or_default();
            let _ = writer.write_record([
                row.case,
                row.elements,
                row.machine,
                &verdict,
                &gate.what,
                &figure,
                &gate.allowed,
                &passed,
                &seconds,
                &message,
            ]);
        }
        if row.gates.is_empty() {
            let (verdict, seconds) = (row.verdict.to_string(), row.seconds.to_string());
            let message = row.message.clone().unwrap_or_default();
            let _ = writer.write_record([
                row.case,
                row.elements,
                row.machine,
                &verdict,
                "",
                "",
                "",
                "",
                &seconds,
                &message,
            ]);
        }
    }
    writer.into_inner().ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default()
}
