//! `sinew bench`: what a step costs.

use super::arguments::{BenchArguments, ELEMENTS};
use super::failure::Failure;
use super::{Outcome, interrupt, terminal};
use sinew::mesh::ElementKind;
use sinew::output::{Folder, OutputError, replace, summary};
use sinew_pictures::plot::{png, svg};
use sinew_studies::bench::{
    Effects, Load, Machine, Plan, Record, compare, cpu_to_gpu, csv, drawing, line, markdown, measure, split_to_fused,
};
use std::io::Write;
use std::path::Path;

/// What counts as slower: quiet machines repeat themselves to some hundredths.
const SLOWER: f64 = 1.1;

/// Measures, prints a table as it grows, writes files, compares.
pub fn command(arguments: &BenchArguments) -> Outcome {
    if !(arguments.seconds > 0.0 && arguments.seconds <= 600.0) {
        return Err(Failure::Options(format!("--seconds is {}; above 0 and up to 600 is allowed", arguments.seconds)));
    }
    let then = arguments.compare.as_deref().map(read).transpose()?;
    let plan = plan(arguments);
    let threads = if arguments.backends.contains(&"cpu".to_string()) { &plan.threads[..] } else { &[] };
    let mut record = Record { machine: threads.iter().map(|&n| Machine::measure(n)).collect(), rows: Vec::new() };
    terminal::say(&markdown(&record))?;
    interrupt::listen();
    for group in plan.groups() {
        if interrupt::is_asked() {
            break;
        }
        let rows = measure(&group, arguments.seconds, &record.machine)?;
        terminal::say(&rows.iter().map(line).collect::<String>())?;
        record.rows.extend(rows);
    }
    let interrupted = interrupt::is_asked();
    interrupt::rest();
    if let Some(path) = &arguments.out {
        write(path, &record)?;
    }
    let mut slower = 0;
    for change in then.iter().flat_map(|then| compare(then, &record)) {
        let case = &change.case;
        let word = if change.ratio() > SLOWER { "SLOWER" } else { "      " };
        slower += usize::from(change.ratio() > SLOWER);
        terminal::say(&format!(
            "{word} {:.2} times as long: {:?}, {}, {}, {}, {}, {} cells: {:.2} ns, was {:.2}\n",
            change.ratio(),
            case.element,
            case.effects.name(),
            case.load.name(),
            case.on(),
            case.scheme,
            case.cells,
            change.ns[1],
            change.ns[0]
        ))?;
    }
    match slower {
        _ if interrupted => Err(Failure::Interrupted),
        0 => Ok(()),
        n => Err(Failure::Broke(format!("{n} cases take over a tenth longer than before"))),
    }
}

fn plan(arguments: &BenchArguments) -> Plan {
    // the parser lets no other word through
    let element =
        |name: &String| ELEMENTS.iter().find(|(word, _)| word == name).map_or_else(ElementKind::default, |of| of.1);
    let effects = |name: &String| match name.as_str() {
        "fibres" => Effects::Fibres,
        "viscosity" => Effects::Viscosity,
        "fibres-viscosity" => Effects::FibresViscosity,
        _ => Effects::None,
    };
    let load = |name: &String| match name.as_str() {
        "none" => Load::None,
        "rust" => Load::Rust,
        "wgsl" => Load::Wgsl,
        _ => Load::Gravity,
    };
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let mut threads: Vec<usize> = arguments.threads.iter().map(|&n| n.into()).collect();
    if threads.is_empty() {
        threads = if cores > 1 { vec![1, cores] } else { vec![1] };
    }
    Plan {
        cells: arguments.cells.clone(),
        elements: arguments.elements.iter().map(element).collect(),
        effects: arguments.effects.iter().map(effects).collect(),
        backends: arguments.backends.clone(),
        precisions: arguments.precisions.clone(),
        threads,
        instructions: arguments.instructions.clone(),
        schemes: arguments.schemes.clone(),
        fuse: arguments.fuse.iter().map(|word| word == "on").collect(),
        loads: arguments.loads.iter().map(load).collect(),
    }
}

fn read(path: &Path) -> Result<Record, Failure> {
    let wrong = |why: String| Failure::Options(format!("{}: {why}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| wrong(format!("this is no bench.json: {error}")))
}

fn write(path: &Path, record: &Record) -> Outcome {
    let mut folder = Folder::create_for(path, "sinew bench")?;
    let mut put = |name: &str, bytes: &[u8]| -> Outcome {
        let path = folder.claim(name)?;
        replace(&path, |file| file.write_all(bytes).map_err(OutputError::system("write", &path)))?;
        Ok(())
    };
    put("bench.csv", csv(record).as_bytes())?;
    put("bench.md", markdown(record).as_bytes())?;
    let plots = [("bench", drawing(record)), ("cpu_to_gpu", cpu_to_gpu(record)), ("fused", split_to_fused(record))];
    for (name, plot) in plots {
        let Some(plot) = plot else { continue };
        put(&format!("{name}.svg"), svg(&plot).as_bytes())?;
        put(&format!("{name}.png"), &png(&plot, 1.5).map_err(Failure::Plot)?)?;
    }
    summary::write(&folder.claim("bench.json")?, record)?;
    Ok(())
}
