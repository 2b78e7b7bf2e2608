//! Tables of an earlier run as a reference: `probe_NAME.csv`, `nodes.csv`, `nodes_BODY.csv`.

use super::points::PointReference;
use super::reference::{EXACTLY, Reference, ReferenceQuantity, ReferenceSource};
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// No result is larger, and squares of numbers must stay numbers.
const LARGEST: f64 = 1e100;

/// Reads tables, or all tables of output folders, as a reference for samples at `samples` times from 0 to `duration`
/// (s); with 0 samples only the end counts, whenever that was.
///
/// # Errors
/// What cannot be read, with its file and what is wanted instead.
pub fn read(paths: &[PathBuf], duration: f64, samples: u64) -> Result<Reference, String> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            let entries =
                std::fs::read_dir(path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
            let inside = entries.filter_map(|entry| Some(entry.ok()?.path()));
            files.extend(inside.filter(|file| kind(file).is_some()));
        } else {
            files.push(path.clone());
        }
    }
    files.sort();
    let mut reference = Reference {
        source: ReferenceSource::Files,
        told: format!("{}{EXACTLY}", shown(paths)),
        entries: BTreeMap::new(),
        field: None,
        points: None,
    };
    for file in &files {
        match kind(file) {
            Some(Kind::Probe(name)) => {
                let table = Table::read(file)?;
                reference.entries.extend(probe(&name, &table, file, duration, samples)?);
            }
            Some(Kind::Nodes(body)) => {
                let points = nodes(&Table::read(file)?, file)?;
                reference.points.get_or_insert_with(PointReference::default).bodies.insert(body, points);
            }
            None => {
                return Err(format!(
                    "{} cannot be a reference: wanted are probe_NAME.csv, nodes.csv and nodes_BODY.csv of a run, or its folder",
                    file.display()
                ));
            }
        }
    }
    if reference.entries.is_empty() && reference.points.is_none() {
        let what = "holds no probe_NAME.csv, nodes.csv or nodes_BODY.csv";
        return Err(format!("{} {what}: run a scene with probes there first", shown(paths)));
    }
    Ok(reference)
}

fn shown(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

enum Kind {
    Probe(String),
    Nodes(String),
}

fn kind(file: &Path) -> Option<Kind> {
    let name = file.file_name()?.to_str()?.strip_suffix(".csv")?;
    if name == "nodes" {
        return Some(Kind::Nodes(String::new()));
    }
    let nodes = name.strip_prefix("nodes_").map(|body| Kind::Nodes(body.into()));
    nodes.or_else(|| name.strip_prefix("probe_").map(|probe| Kind::Probe(probe.into())))
}

/// A table of numbers with a header.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(file: &Path) -> Result<Self, String> {
        let wrong = |what: String| format!("{}: {what}", file.display());
        let mut reader = csv::Reader::from_path(file).map_err(|error| wrong(error.to_string()))?;
        let header = reader.headers().map_err(|error| wrong(error.to_string()))?.iter().map(String::from).collect();
        let mut rows = Vec::new();
        for (number, record) in reader.records().enumerate() {
            let record = record.map_err(|error| wrong(error.to_string()))?;
            let numbers: Option<Vec<f64>> =
                record.iter().map(|cell| cell.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
            let row = numbers.ok_or_else(|| wrong(format!("row {} has something else than numbers", number + 1)))?;
            if let Some(large) = row.iter().find(|value| value.abs() > LARGEST) {
                return Err(wrong(format!("row {} has {large:e}; numbers up to {LARGEST:e} are allowed", number + 1)));
            }
            rows.push(row);
        }
        if rows.is_empty() {
            return Err(wrong("the table has no rows".into()));
        }
        Ok(Self { header, rows })
    }
}

/// Quantities of a probe's table. Its last row must be at the end of the scene.
fn probe(
    name: &str,
    table: &Table,
    file: &Path,
    duration: f64,
    samples: u64,
) -> Result<BTreeMap<String, ReferenceQuantity>, String> {
    let wrong = |what: String| Err(format!("{}: {what}", file.display()));
    if table.header.first().is_none_or(|column| !column.starts_with("time")) {
        return wrong("the first column must be `time (s)`".into());
    }
    let times: Vec<f64> = table.rows.iter().map(|row| row[0]).collect();
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        return wrong("times must grow from row to row".into());
    }
    let end = times[times.len() - 1];
    if samples > 0 && (end - duration).abs() > 1e-6 * duration {
        return wrong(format!("it ends at {end} s and the scene at {duration} s; a reference must cover the scene"));
    }
    let at = |time: f64, column: usize| {
        let after = times.partition_point(|&t| t < time - 1e-9 * duration).min(times.len() - 1);
        let before = after.saturating_sub(1);
        let (a, b) = (&table.rows[before], &table.rows[after]);
        let share = if after > before { ((time - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0) } else { 0.0 };
        a[column] + share * (b[column] - a[column])
    };
    let columns = 1..table.header.len();
    let length = |row: &Vec<f64>| columns.clone().map(|column| row[column] * row[column]).sum::<f64>().sqrt();
    let largest = table.rows.iter().map(length).fold(0.0, f64::max);
    let last = table.rows.last().map_or(0.0, length);
    let mut entries = BTreeMap::new();
    for column in columns.clone() {
        let title = &table.header[column];
        let quantity = format!("{name}.{}", title.split(" (").next().unwrap_or(title));
        let scale = Some(if last > 0.01 * largest { last } else { largest }).filter(|scale| *scale > 0.0);
        let values = vec![table.rows.last().map_or(0.0, |row| row[column])];
        entries.insert(quantity.clone(), ReferenceQuantity { values, uncertainty: 0.0, scale, order: None });
        if samples > 0 && times.len() as u64 >= samples / 4 && times[0] == 0.0 {
            let values: Vec<f64> =
                (0..=samples).map(|number| at(duration * number as f64 / samples as f64, column)).collect();
            // straight lines between rows: off by an eighth of the second difference
            let bends = table.rows.windows(3).map(|r| (r[0][column] - 2.0 * r[1][column] + r[2][column]).abs() / 8.0);
            let uncertainty = if times.len() as u64 == samples + 1 { 0.0 } else { bends.fold(0.0, f64::max) };
            let scale = Some(largest).filter(|scale| *scale > 0.0);
            entries
                .insert(format!("{quantity}.over_time"), ReferenceQuantity { values, uncertainty, scale, order: None });
        }
    }
    Ok(entries)
}

/// Rest positions and displacements of a table of nodes.
fn nodes(table: &Table, file: &Path) -> Result<Vec<(DVec3, DVec3)>, String> {
    let column = |name: &str| {
        let found = table.header.iter().position(|column| column == name);
        found.ok_or_else(|| format!("{}: the column `{name}` is missing", file.display()))
    };
    let mut columns = [0; 6];
    for (place, name) in ["X", "Y", "Z", "ux", "uy", "uz"].into_iter().enumerate() {
        columns[place] = column(name)?;
    }
    let vector = |row: &[f64], first: usize| DVec3::from_array([0, 1, 2].map(|axis| row[columns[first + axis]]));
    Ok(table.rows.iter().map(|row| (vector(row, 0), vector(row, 3))).collect())
}
