//! What came out, as tables.

use super::{CaseVerdict, Row};

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
        let verdict = if row.verdict == CaseVerdict::Passed { "passed".into() } else { format!("**{}**", row.verdict) };
        let (elements, machine, seconds) = (row.elements, row.machine, row.seconds);
        text += &format!(
            "| {} | {elements} | {machine} | {verdict} | {} | {seconds:.2} |\n",
            row.case,
            figure(row).replace('|', "\\|")
        );
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
