//! Many variants of a scene: a file says which, any number of machines take a part each, and what is done is kept.
//!
//! A variant that breaks down is a row, like one that ends well. Rows are appended to a manifest of JSON lines as they
//! come in; whoever runs the same sweep again runs what is missing.

mod manifest;
mod rows;
mod table;

pub use manifest::{Done, Ended, Keys, warned};
pub use rows::{Kept, Results, check_times};
pub use table::{SweepFile, Value, Variants};

use serde_json::Value as Json;
use sinew::scene::{Allowed, Diagnostics};
use sinew::{Error, Options, SceneFile, Simulation};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// About how long a variant goes on before it asks whether to stop.
const PIECE: Duration = Duration::from_millis(50);

/// What is wrong with a sweep, or kept it from going on.
#[derive(Debug)]
pub enum SweepError {
    /// The file: where in it, and what.
    File(String),
    /// The scene as it stands in its file.
    Scene(Box<Diagnostics>),
    /// Results cannot be read or written: which file, and why.
    Files(PathBuf, std::io::Error),
    /// What a variant needs is not there: a GPU, threads.
    Engine(Box<Error>),
}

impl fmt::Display for SweepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SweepError::File(what) => f.write_str(what),
            SweepError::Scene(diagnostics) => f.write_str(&diagnostics.render(false)),
            SweepError::Files(path, error) => write!(f, "{}: {error}", path.display()),
            SweepError::Engine(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for SweepError {}

/// A part of a sweep: 3 of 16 is every sixteenth variant from the third on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// From 1 on.
    pub which: usize,
    /// How many there are.
    pub of: usize,
}

impl Part {
    /// All of it.
    pub const WHOLE: Part = Part { which: 1, of: 1 };

    /// Whether a variant belongs to it; variants are counted from 0.
    pub fn has(self, number: usize) -> bool {
        number % self.of == self.which - 1
    }

    /// A file's name: that of the whole, and of a part with its number.
    fn file(self, stem: &str, extension: &str) -> String {
        match self {
            Part::WHOLE => format!("{stem}.{extension}"),
            Part { which, of } => {
                format!("{stem}_{which:0width$}_of_{of}.{extension}", width = of.to_string().len())
            }
        }
    }
}

/// A sweep that is known to be sound: its scene is, and has the probes that are kept.
pub struct Sweep {
    file: SweepFile,
    scene: PathBuf,
    /// As it stands there.
    base: SceneFile,
    allowed: Allowed,
    variants: Vec<Vec<Value>>,
    kept: Kept,
}

/// How a sweep is run.
pub struct How<'a> {
    /// Of each simulation; it has one thread.
    pub options: Options,
    /// Variants that run at once.
    pub at_once: usize,
    /// Which of them.
    pub part: Part,
    /// The folder of the results, made if it is not there.
    pub out: &'a Path,
    /// Whether to stop; what is done is kept.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// What came of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Rows of the part in the order of the table, less those that are missing because it was stopped.
    pub rows: Vec<Done>,
    /// How many of them were there already.
    pub before: usize,
    /// Variants of the part.
    pub variants: usize,
    /// The table of results, and the manifest.
    pub files: [PathBuf; 2],
}

impl Sweep {
    /// Reads a sweep, and its scene.
    ///
    /// # Errors
    /// What is wrong with the file, and where; what is wrong with the scene as it stands; a probe that it has not.
    pub fn load(path: &Path, allowed: Allowed) -> Result<Self, SweepError> {
        let file = SweepFile::load(path)?;
        let scene = path.parent().unwrap_or(Path::new("")).join(&file.scene);
        let base =
            SceneFile::load_allowing(&scene, &[], allowed).map_err(|wrong| SweepError::Scene(Box::new(wrong)))?;
        let kept = Kept::of(&base, &file.keep, &file.at);
        let kept = kept.map_err(|what| SweepError::File(format!("{}: {what}", path.display())))?;
        let variants = file.variants.rows();
        Ok(Self { base, scene, variants, kept, allowed, file })
    }

    /// How many variants there are.
    pub fn count(&self) -> usize {
        self.variants.len()
    }

    /// Where values are put in, in the order of [`Done::values`].
    pub fn places(&self) -> Vec<&str> {
        self.file.variants.places()
    }

    /// Runs what is missing of a part, and writes its table. `tell` hears of each row as it comes in.
    ///
    /// # Errors
    /// Results that cannot be read or written; a GPU that is not there or fails. What is done is kept.
    pub fn run(&self, how: &How<'_>, mut tell: impl FnMut(&Done)) -> Result<Outcome, SweepError> {
        let SweepFile { keep, at, .. } = &self.file;
        let mut keys = Keys::new(&self.base, keep, at, &how.options);
        let keys = (0..self.count()).map(|number| keys.of(&self.sets(number), || self.read(number)));
        let mut results = Results::open(how.out, how.part, keys.collect())?;
        let missing = results.missing();
        let before = results.count() - missing.len();
        let next = Mutex::new(missing.iter());
        let (send, receive) = mpsc::channel();
        std::thread::scope(|scope| {
            for _ in 0..how.at_once.clamp(1, missing.len().max(1)) {
                let (send, next) = (send.clone(), &next);
                scope.spawn(move || {
                    loop {
                        let number = next.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some(&number) = number.filter(|_| !(how.stop)()) else { break };
                        let row = self.row(number, how);
                        let goes_on = matches!(row, Ok(Some(_)));
                        if send.send(row).is_err() || !goes_on {
                            break;
                        }
                    }
                });
            }
            drop(send);
            for row in receive {
                let Some(row) = row? else { continue };
                tell(&row);
                results.add(row)?;
            }
            Ok(())
        })?;
        results.write_table(&self.places(), &self.kept)?;
        let (variants, files) = (results.count(), results.files().clone());
        Ok(Outcome { rows: results.done().cloned().collect(), before, variants, files })
    }

    /// What `--set` would be given.
    fn sets(&self, number: usize) -> Vec<String> {
        let places = self.places();
        places.iter().zip(&self.variants[number]).map(|(place, value)| format!("{place}={value}")).collect()
    }

    /// The scene of a variant.
    fn read(&self, number: usize) -> Result<SceneFile, Diagnostics> {
        SceneFile::load_allowing(&self.scene, &self.sets(number), self.allowed)
    }

    /// Runs a variant; `None` where it was told to stop.
    fn row(&self, number: usize, how: &How<'_>) -> Result<Option<Done>, SweepError> {
        let started = Instant::now();
        let places = self.places().into_iter().map(str::to_owned);
        let values = places.zip(self.variants[number].iter().cloned()).collect();
        let (ended, kept, warnings) = (Ended::Finished, BTreeMap::new(), Vec::new());
        let mut row = Done { number, values, ended, error: None, time: 0.0, seconds: 0.0, kept, warnings };
        let done = match self.read(number) {
            // it may end before the scene as it stands does
            Ok(scene) => match Kept::of(&scene, &self.file.keep, &self.file.at) {
                Ok(_) => self.simulate(&scene, how, &mut row),
                Err(what) => {
                    (row.ended, row.error) = (Ended::SceneError, Some(what));
                    Ok(true)
                }
            },
            Err(wrong) => Err(Error::Scene(Box::new(wrong))),
        };
        match done {
            Ok(true) => {}
            Ok(false) => return Ok(None),
            Err(error) => match Ended::of(&error) {
                Some(ended) => (row.ended, row.error) = (ended, Some(error.to_string())),
                // says nothing of the variant
                None => return Err(SweepError::Engine(Box::new(error))),
            },
        }
        row.seconds = started.elapsed().as_secs_f64();
        Ok(Some(row))
    }

    /// Takes a variant to its end, asking probes on the way. False: it was told to stop.
    fn simulate(&self, scene: &SceneFile, how: &How<'_>, row: &mut Done) -> Result<bool, Error> {
        let mut simulation = Simulation::new(scene, &how.options)?;
        let done = self.to_the_end(&mut simulation, how, row);
        // also where it broke down
        (row.time, row.warnings) = (simulation.time(), warned(&simulation));
        done
    }

    fn to_the_end(&self, simulation: &mut Simulation, how: &How<'_>, row: &mut Done) -> Result<bool, Error> {
        let names: Vec<String> = self.kept.probes().iter().map(|(name, _)| name.clone()).collect();
        if self.file.at.is_empty() {
            let arrived = in_pieces(simulation, how, |simulation, most| {
                simulation.advance_towards_end(most)?;
                Ok(!simulation.is_finished())
            })?;
            if arrived {
                let seen = names.iter().map(|name| simulation.probe(name)).collect::<Result<_, _>>()?;
                self.keep(seen, row)?;
            }
            return Ok(arrived);
        }
        let mut left = &self.file.at[..];
        while let Some(&next) = left.first() {
            let arrived = in_pieces(simulation, how, |simulation, most| {
                let before = simulation.step_count();
                simulation.advance_short_of(next, most)?;
                Ok(simulation.step_count() - before == most)
            })?;
            if !arrived {
                return Ok(false);
            }
            let seen = simulation.probes_at(&names, left)?;
            left = &left[seen.len()..];
            seen.into_iter().try_for_each(|seen| self.keep(seen, row))?;
        }
        Ok(true)
    }

    /// Keeps what the probes saw, of each its numbers.
    fn keep(&self, seen: Vec<Vec<f64>>, row: &mut Done) -> Result<(), Error> {
        for ((name, columns), numbers) in self.kept.probes().iter().zip(seen) {
            if numbers.len() != columns.len() {
                return Err(Error::Broken("a column of a probe"));
            }
            // what is no number is null: of a gap where nothing is near, for instance
            let numbers = Json::from(numbers);
            if self.file.at.is_empty() {
                row.kept.insert(name.clone(), numbers);
            } else if let Json::Array(times) = row.kept.entry(name.clone()).or_insert_with(|| Json::Array(Vec::new())) {
                times.push(numbers);
            }
        }
        Ok(())
    }
}

/// Takes steps by `take`, which is given how many it may take at most and says whether there are more to come. False:
/// it was told to stop.
fn in_pieces(
    simulation: &mut Simulation,
    how: &How<'_>,
    take: impl Fn(&mut Simulation, u64) -> Result<bool, Error>,
) -> Result<bool, Error> {
    let mut most: u64 = 1;
    while !(how.stop)() {
        let started = Instant::now();
        if !take(simulation, most)? {
            return Ok(true);
        }
        most = if started.elapsed() < PIECE / 2 { most.saturating_mul(2) } else { (most / 2).max(1) };
    }
    Ok(false)
}
