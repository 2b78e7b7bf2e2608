//! What is done, a JSON line a variant: whoever goes on reads it.

use super::{SweepError, Value};
use serde::{Deserialize, Serialize};
use sinew::scene::Diagnostics;
use sinew::{Error, Options, SceneFile, Simulation};
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
    /// What the guards warned of, and since when: its numbers are that uncertain.
    #[serde(default)]
    pub warnings: Vec<String>,
}

/// What the guards of a run have warned of so far, as [`Done::warnings`] has it.
pub fn warned(simulation: &Simulation) -> Vec<String> {
    let warnings = simulation.guards().warnings;
    warnings.iter().map(|notice| format!("from t = {} s: {}", notice.time, notice.message)).collect()
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

/// Makes the keys of a sweep's rows: what makes two the same. That is the version, the text of the scene, what is put
/// in as `--set` has it, names of what is kept and when (s), how it runs, and what files hold that a variant names.
pub struct Keys {
    /// What all rows have in common, as a text.
    common: String,
    /// Of files that have been read, by name, a hash of what they hold; none where it cannot be read.
    files: BTreeMap<String, Option<u64>>,
}

impl Keys {
    /// Of a scene as it stands; `keep` and `at` (s) say what is kept.
    pub fn new(scene: &SceneFile, keep: &[String], at: &[f64], options: &Options) -> Self {
        let Options { backend, precision, scheme, grabs, .. } = options;
        let how = format!("{} {backend:?} {precision:?} {scheme:?} {grabs}", env!("CARGO_PKG_VERSION"));
        let mut keys = Self { common: String::new(), files: BTreeMap::new() };
        keys.common = format!("{how}\n{:?}\n{keep:?}\n{at:?}\n{}", scene.text(), keys.files_of(scene));
        keys
    }

    /// Of the variant in which these values are put in. `read` gives its scene, and is asked where a value may name
    /// another file.
    pub fn of(&mut self, sets: &[String], read: impl FnOnce() -> Result<SceneFile, Diagnostics>) -> String {
        let others = match sets.iter().any(|set| may_name_a_file(set)) {
            // where values make no sense nothing is read
            true => read().map(|scene| format!("{:?} {}", scene.text(), self.files_of(&scene))).unwrap_or_default(),
            false => String::new(),
        };
        let what = format!("{}\n{sets:?}\n{others}", self.common);
        format!("{:016x}", XxHash64::oneshot(0, what.as_bytes()))
    }

    /// The files that a scene names, and what they hold, as a text.
    fn files_of(&mut self, scene: &SceneFile) -> String {
        let mut found = BTreeMap::new();
        for name in scene.named_files().iter().flat_map(|file| file.names()) {
            let hash = *self.files.entry(name.clone()).or_insert_with(|| hash_of(&name, scene));
            found.insert(name, hash);
        }
        format!("{found:?}")
    }
}

/// Whether what is put in is neither a number nor a word for yes or no.
fn may_name_a_file(set: &str) -> bool {
    let value = set.split_once('=').map_or(set, |(_, value)| value).trim();
    value.parse::<f64>().is_err() && value.parse::<bool>().is_err()
}

fn hash_of(file: &str, scene: &SceneFile) -> Option<u64> {
    scene.bytes(file, u64::MAX).ok().map(|bytes| XxHash64::oneshot(0, &bytes))
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const SCENE: &str = r#"(
        title: "Skin", duration: 0.1,
        materials: {"skin": (density: 1100, law: (file: "a.wgsl", parameters: {"mu": 2000}))},
        bodies: {"strip": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: "skin")},
    )"#;

    /// Keys of the scene as it stands and with another law, where files hold this.
    fn keys(files: [(&str, &str); 2]) -> [String; 2] {
        let files = BTreeMap::from(files.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec())));
        let read = |sets: &[String]| SceneFile::from_memory("skin.ron", SCENE, files.clone(), sets);
        let scene = read(&[]).unwrap();
        let mut keys = Keys::new(&scene, &["grip".into()], &[0.1], &Options::default());
        ["materials.skin.density=1100", "materials.skin.law.file=b.wgsl"].map(|set| {
            let sets = [set.to_owned()];
            keys.of(&sets, || read(&sets))
        })
    }

    #[test]
    fn a_row_is_another_one_where_a_file_that_it_names_holds_something_else() {
        let before = keys([("a.wgsl", "1"), ("b.wgsl", "2")]);
        assert_eq!(keys([("a.wgsl", "1"), ("b.wgsl", "2")]), before);
        let of_b = keys([("a.wgsl", "1"), ("b.wgsl", "3")]);
        assert!(of_b[0] == before[0] && of_b[1] != before[1], "{before:?} {of_b:?}");
        let of_a = keys([("a.wgsl", "3"), ("b.wgsl", "2")]);
        assert_ne!(of_a[0], before[0]);
    }
}
