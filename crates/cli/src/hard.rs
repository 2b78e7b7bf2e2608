//! `sinew hard`: the hard cases, and a table of how they end.

use super::arguments::{BackendName, HardArguments};
use super::failure::Failure;
use super::terminal::{self, Paint};
use super::{Outcome, interrupt};
use sinew::backend::gpu::{Choice, Gpu};
use sinew::output::{Folder, OutputError, replace, summary};
use sinew_studies::hard::{CASES, Case, CaseConfiguration, CaseVerdict, Row, by_case, csv, markdown, run};
use std::io::Write;
use std::path::Path;

/// Runs cases, says how each ends, and writes the tables.
pub fn command(arguments: &HardArguments) -> Outcome {
    let cases = chosen(&arguments.cases)?;
    // a software one too: this is about what comes out, not about speed
    let gpu = arguments.backend != BackendName::Cpu && Gpu::open(&Choice::Best).is_ok();
    if arguments.backend == BackendName::Gpu && !gpu {
        return Err(Failure::Options("there is no GPU, nor a software one: use --backend cpu".into()));
    }
    let paint = Paint::of_stdout();
    let configurations: Vec<CaseConfiguration> = CaseConfiguration::all(gpu)
        .into_iter()
        .filter(|c| arguments.backend != BackendName::Gpu || c.is_gpu())
        .collect();
    let (mut rows, mut unexpected) = (Vec::new(), 0);
    interrupt::listen();
    for case in cases {
        terminal::say(&format!(
            "{} {}\n  passes when: {}\n",
            paint.bold(&case.id.to_uppercase()),
            case.title,
            case.passes_when
        ))?;
        for configuration in configurations.iter().filter(|configuration| case.has_row(configuration)) {
            if interrupt::is_asked() {
                break;
            }
            let row = run(case, configuration, arguments.full);
            unexpected += usize::from(row.verdict != row.expected);
            terminal::say(&line(&row, paint))?;
            rows.push(row);
        }
    }
    let interrupted = interrupt::is_asked();
    interrupt::rest();
    if let Some(path) = &arguments.out {
        write(path, &rows)?;
    }
    terminal::say(&format!("\n{}\n", counted(&rows, unexpected)))?;
    match unexpected {
        _ if interrupted => Err(Failure::Interrupted),
        0 => Ok(()),
        _ => Err(Failure::Broke("hard cases did not end as they should".into())),
    }
}

/// The cases of some names; all for none.
fn chosen(names: &[String]) -> Result<Vec<&'static Case>, Failure> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let find = |name: &String| {
        let wanted = name.to_lowercase();
        CASES.iter().find(|case| case.id == wanted || case.name == wanted).ok_or_else(|| {
            let all: Vec<String> =
                CASES.iter().map(|case| format!("{} {}", case.id.to_uppercase(), case.name)).collect();
            Failure::Options(format!("there is no hard case {name:?}; there are {}", all.join(", ")))
        })
    };
    names.iter().map(find).collect()
}

fn line(row: &Row, paint: Paint) -> String {
    let verdict = match row.verdict {
        CaseVerdict::Passed | CaseVerdict::NotMeant => row.verdict.to_string(),
        _ => paint.red(&row.verdict.to_string()),
    };
    let mut text = format!("  {:18} {:17}  {verdict} in {:.2} s", row.elements, row.machine, row.seconds);
    if row.verdict == CaseVerdict::Passed {
        let tightest = row.tightest().map(|gate| format!(": {} {:.3e} ({})", gate.what, gate.figure, gate.allowed));
        text += &tightest.unwrap_or_default();
    }
    for gate in row.gates.iter().filter(|gate| !gate.passed) {
        text += &format!("\n      {}: {:.4e} ({})", gate.what, gate.figure, gate.allowed);
    }
    for word in row.message.iter().map(String::as_str).chain(row.known.map(|known| known as &str)) {
        text += &format!("\n      {word}");
    }
    text + "\n"
}

/// "40 passed, 2 failed honestly, 1 failed, 3 not meant; all as expected".
fn counted(rows: &[Row], unexpected: usize) -> String {
    let count = |verdict: CaseVerdict| rows.iter().filter(|row| row.verdict == verdict).count();
    let (passed, honest, failed) =
        (count(CaseVerdict::Passed), count(CaseVerdict::FailedHonestly), count(CaseVerdict::Failed));
    let not_meant = count(CaseVerdict::NotMeant);
    let expected = if unexpected == 0 { "all as expected".into() } else { format!("{unexpected} not as expected") };
    format!("{passed} passed, {honest} failed honestly, {failed} failed, {not_meant} not meant; {expected}")
}

/// `hard.json` is this.
#[derive(serde::Serialize)]
struct Table<'a> {
    rows: &'a [Row],
}

fn write(path: &Path, rows: &[Row]) -> Outcome {
    let mut folder = Folder::create_for(path, "sinew hard")?;
    let tables = format!("{}\n{}", by_case(rows), markdown(rows));
    for (name, text) in [("hard.md", tables), ("hard.csv", csv(rows))] {
        let path = folder.claim(name)?;
        replace(&path, |file| file.write_all(text.as_bytes()).map_err(OutputError::system("write", &path)))?;
    }
    summary::write(&folder.claim("hard.json")?, &Table { rows })?;
    Ok(())
}
