//! What is done, a JSON line a variant: whoever goes on reads it.

use super::{SweepError, Value};
use serde::{Deserialize, Serialize};
use sinew::{Error, Options};
use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use twox_hash::XxHash64;

/// What became of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// Its number in the sweep, counted from 0.
    pub number: usize,
    /// What was put in, by place.
    pub values: BTreeMap<String, Value>,
    /// How it ended.
    pub ended: Ended,
    /// What was said then.
    pub error: Option<String>,
    /// How far it came (s).
    pub time: f64,
    /// What it took on the wall (s).
    pub seconds: f64,
    /// What was kept, by name: of a probe its numbers, or a list of them for each time, of which there are fewer where
    /// it ended early. What is no number is null.
    pub kept: BTreeMap<String, serde_json::Value>,
}

/// How a variant ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ended {
    /// As the scene says.
    Finished,
    /// What was simulated is no longer physical.
    Unstable,
    /// No equilibrium was found.
    NotConverged,
    /// The values make no sense in the scene.
    SceneError,
}

impl Ended {
    /// How an error ends a variant; `None` where it says nothing of it.
    pub(super) fn of(error: &Error) -> Option<Self> {
        match error {
            Error::Scene(_) => Some(Ended::SceneError),
            Error::Unstable(_) => Some(Ended::Unstable),
            Error::NotConverged(_) => Some(Ended::NotConverged),
            _ => None,
        }
    }
}

impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

/// A line of the file.
#[derive(Serialize, Deserialize)]
struct Line {
    key: String,
    #[serde(flatten)]
    done: Done,
}

/// What makes two rows the same, as a key: version, text of the scene, what is put in as `--set` has it, names of what
/// is kept and when (s), and how it runs. What mesh files hold is not looked at.
pub fn key(scene: &str, sets: &[String], keep: &[String], at: &[f64], options: &Options) -> String {
    let Options { backend, precision, scheme, grabs, .. } = options;
    let how = format!("{} {backend:?} {precision:?} {scheme:?} {grabs}", env!("CARGO_PKG_VERSION"));
    let what = format!("{how}\n{scene:?}\n{sets:?}\n{keep:?}\n{at:?}");
    format!("{:016x}", XxHash64::oneshot(0, what.as_bytes()))
}

/// The file, open to be added to.
pub(super) struct Manifest {
    path: PathBuf,
    file: File,
    lines: HashMap<usize, Line>,
}

impl Manifest {
    /// Opens a file, or begins it. Lines that were cut off are passed over.
    pub fn open(path: &Path) -> Result<Self, SweepError> {
        let failed = |error| SweepError::Files(path.into(), error);
        let mut bytes = Vec::new();
        match File::open(path) {
            Ok(mut file) => drop(file.read_to_end(&mut bytes).map_err(failed)?),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(failed(error)),
        }
        let mut file = OpenOptions::new().create(true).append(true).open(path).map_err(failed)?;
        if bytes.last().is_some_and(|&last| last != b'\n') {
            file.write_all(b"\n").map_err(failed)?;
        }
        let text = String::from_utf8_lossy(&bytes);
        let lines = text.lines().filter_map(|line| serde_json::from_str::<Line>(line).ok());
        Ok(Self { path: path.into(), file, lines: lines.map(|line| (line.done.number, line)).collect() })
    }

    /// What became of a variant, if that is known under this key.
    pub fn find(&self, number: usize, key: &str) -> Option<Done> {
        self.lines.get(&number).filter(|line| line.key == key).map(|line| line.done.clone())
    }

    /// Adds a line.
    pub fn add(&mut self, key: &str, done: &Done) -> Result<(), SweepError> {
        let line = Line { key: key.into(), done: done.clone() };
        let failed = |error| SweepError::Files(self.path.clone(), error);
        let mut text = serde_json::to_string(&line).map_err(|error| failed(error.into()))?;
        text.push('\n');
        // in one piece: who reads meanwhile sees whole lines
        self.file.write_all(text.as_bytes()).map_err(failed)
    }
}
