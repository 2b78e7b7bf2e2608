//! What is kept of variants, and the table of results.

use super::manifest::Manifest;
use super::{Done, Part, SweepError};
use serde_json::Value;
use sinew::SceneFile;
use sinew::observation::{Heading, header};
use std::path::{Path, PathBuf};

/// What is kept of each variant: numbers of probes, once or at some times.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    /// Each probe with the columns of its numbers.
    probes: Vec<(String, Vec<String>)>,
    /// When they are asked (s); at the end where there are none.
    at: Vec<f64>,
}

/// Whether these are times (s) that ascend.
///
/// # Errors
/// Which are not.
pub fn check_times(times: &[f64]) -> Result<(), String> {
    if let Some(time) = times.iter().find(|time| !(time.is_finite() && **time >= 0.0)) {
        return Err(format!("at: {time} is no time: 0 s or later is wanted"));
    }
    match times.windows(2).find(|pair| pair[0] >= pair[1]) {
        Some(pair) => Err(format!("at: {} s stands after {} s; times must ascend", pair[1], pair[0])),
        None => Ok(()),
    }
}

impl Kept {
    /// Of a scene's probes, at times (s).
    ///
    /// # Errors
    /// A probe that it has not; a time that it has not; times that do not ascend.
    pub fn of(scene: &SceneFile, keep: &[String], at: &[f64]) -> Result<Self, String> {
        check_times(at)?;
        let probes = &scene.scene.probes;
        let columns = keep.iter().map(|name| match probes.get(name) {
            // of its table, less the time
            Some(probe) => Ok((name.clone(), header(&probe.what).iter().skip(1).map(Heading::to_string).collect())),
            None => {
                let there: Vec<&str> = probes.keys().map(String::as_str).collect();
                let there = if there.is_empty() { "none".into() } else { there.join(", ") };
                Err(format!("keep: the scene has no probe {name:?}; it has {there}"))
            }
        });
        let probes = columns.collect::<Result<_, _>>()?;
        let end = scene.scene.duration;
        if let Some(late) = at.iter().find(|&&time| time > end) {
            return Err(format!("at: {late} s is after the scene's end, {end} s"));
        }
        if scene.scene.is_static() && !at.is_empty() {
            return Err("at: a static analysis has no times; leave it out, and probes are asked at rest".into());
        }
        Ok(Self { probes, at: at.to_vec() })
    }

    /// Each probe with its columns.
    pub(super) fn probes(&self) -> &[(String, Vec<String>)] {
        &self.probes
    }

    /// Columns of the table: `tip ux (m)`, with times `tip ux (m) at 0.01 s`.
    fn columns(&self) -> Vec<String> {
        let each = || self.probes.iter().flat_map(|(name, columns)| columns.iter().map(move |c| format!("{name} {c}")));
        match &self.at[..] {
            [] => each().collect(),
            times => times.iter().flat_map(|time| each().map(move |name| format!("{name} at {time} s"))).collect(),
        }
    }

    /// What stands there of a variant, empty where it ended before.
    fn numbers(&self, done: &Done) -> Vec<String> {
        let text = |number: Option<&Value>| number.and_then(Value::as_f64).map_or(String::new(), |n| n.to_string());
        let at_once = |time: Option<usize>| {
            self.probes.iter().flat_map(move |(name, columns)| {
                let kept = done.kept.get(name);
                let kept = time.map_or(kept, |time| kept.and_then(|kept| kept.get(time)));
                (0..columns.len()).map(move |k| text(kept.and_then(|kept| kept.get(k))))
            })
        };
        match self.at.len() {
            0 => at_once(None).collect(),
            times => (0..times).flat_map(|time| at_once(Some(time))).collect(),
        }
    }
}

/// What is done of a part of a sweep, in the files of a folder.
pub struct Results {
    manifest: Manifest,
    /// Number and key of each variant of the part.
    keys: Vec<(usize, String)>,
    rows: Vec<Option<Done>>,
    files: [PathBuf; 2],
}

impl Results {
    /// Opens the files of a part in a folder, which is made where it is not there, for the variants of all numbers and
    /// keys of the sweep.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub fn open(folder: &Path, part: Part, keys: Vec<String>) -> Result<Self, SweepError> {
        std::fs::create_dir_all(folder).map_err(|error| SweepError::Files(folder.into(), error))?;
        let files =
            [("rows", "csv"), ("manifest", "jsonl")].map(|(stem, extension)| folder.join(part.file(stem, extension)));
        let manifest = Manifest::open(&files[1])?;
        let keys: Vec<(usize, String)> = keys.into_iter().enumerate().filter(|(n, _)| part.has(*n)).collect();
        let rows = keys.iter().map(|(number, key)| manifest.find(*number, key)).collect();
        Ok(Self { manifest, keys, rows, files })
    }

    /// Numbers of the variants that are not done.
    pub fn missing(&self) -> Vec<usize> {
        let places = self.keys.iter().zip(&self.rows);
        places.filter(|(_, row)| row.is_none()).map(|((number, _), _)| *number).collect()
    }

    /// What is done, in the order of numbers.
    pub fn done(&self) -> impl Iterator<Item = &Done> {
        self.rows.iter().flatten()
    }

    /// How many variants the part has.
    pub fn count(&self) -> usize {
        self.keys.len()
    }

    /// The table, and the manifest.
    pub fn files(&self) -> &[PathBuf; 2] {
        &self.files
    }

    /// Takes a variant of the part that is done, and writes its line.
    ///
    /// # Errors
    /// The manifest cannot be written.
    pub fn add(&mut self, done: Done) -> Result<(), SweepError> {
        let Ok(place) = self.keys.binary_search_by_key(&done.number, |(number, _)| *number) else { return Ok(()) };
        self.manifest.add(&self.keys[place].1, &done)?;
        self.rows[place] = Some(done);
        Ok(())
    }

    /// Writes the table: number, a column for each place, how it ended, how far it came, and what was kept. Nothing in
    /// it depends on the machine.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write_table(&self, places: &[&str], kept: &Kept) -> Result<(), SweepError> {
        let path = &self.files[0];
        let failed = |error: csv::Error| SweepError::Files(path.into(), error.into());
        let beside = path.with_extension("csv.partial");
        {
            let mut table = csv::Writer::from_path(&beside).map_err(failed)?;
            let columns = kept.columns();
            let header = ["variant"].into_iter().chain(places.iter().copied()).chain(["ended", "time (s)"]);
            table.write_record(header.chain(columns.iter().map(String::as_str))).map_err(failed)?;
            for row in self.done() {
                let values = places.iter().map(|place| row.values.get(*place).map_or(String::new(), |v| v.to_string()));
                let mut record = vec![row.number.to_string()];
                record.extend(values);
                record.extend([row.ended.to_string(), row.time.to_string()]);
                record.extend(kept.numbers(row));
                table.write_record(record).map_err(failed)?;
            }
            table.flush().map_err(|error| SweepError::Files(path.into(), error))?;
        }
        // a table is there whole, or not yet
        std::fs::rename(&beside, path).map_err(|error| SweepError::Files(path.into(), error))
    }
}
