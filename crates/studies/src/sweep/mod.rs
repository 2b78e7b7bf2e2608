//! Many variants of a scene: a file says which, any number of machines take a part each, and what is done is kept.
//!
//! A variant that breaks down is a row, like one that ends well. Rows are appended to a manifest of JSON lines as they
//! come in; whoever runs the same sweep again runs what is missing.

mod manifest;
mod rows;
mod table;

pub use manifest::{Done, Ended};
pub use table::{SweepFile, Value, Variants};

use manifest::Manifest;
use sinew::observation::header;
use sinew::scene::{Allowed, Diagnostics};
use sinew::{Ended as Why, Error, Options, SceneFile, Simulation};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long a variant goes on before it asks whether to stop.
const PIECE: Duration = Duration::from_millis(50);
/// The same of one that is led to rest, in pseudo-steps.
const PSEUDO_STEPS: u64 = 64;

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
    /// The scene's text, part of what makes a row the same.
    text: String,
    allowed: Allowed,
    variants: Vec<Vec<Value>>,
    /// Columns of what is kept, by probe.
    columns: Vec<Vec<&'static str>>,
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
        let probes = &base.scene.probes;
        let columns = file.keep.iter().map(|name| match probes.get(name) {
            // of its table, less the time
            Some(probe) => Ok(header(&probe.what).split_off(1)),
            None => {
                let there: Vec<&str> = probes.keys().map(String::as_str).collect();
                Err(SweepError::File(format!(
                    "{}: keep: the scene has no probe {name:?}; it has {}",
                    path.display(),
                    if there.is_empty() { "none".into() } else { there.join(", ") }
                )))
            }
        });
        let columns = columns.collect::<Result<_, _>>()?;
        if let Some(late) = file.at.iter().find(|&&time| time > base.scene.duration) {
            let end = base.scene.duration;
            return Err(SweepError::File(format!(
                "{}: at: {late} s is after the scene's end, {end} s",
                path.display()
            )));
        }
        if base.scene.is_static() && !file.at.is_empty() {
            let what = "at: a static analysis has no times; leave it out, and probes are asked at rest";
            return Err(SweepError::File(format!("{}: {what}", path.display())));
        }
        let variants = file.variants.rows();
        Ok(Self { text: base.text().to_owned(), scene, variants, columns, allowed, file })
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
        let part: Vec<usize> = (0..self.count()).filter(|&number| how.part.has(number)).collect();
        let keys: Vec<String> = part.iter().map(|&number| self.key(number, &how.options)).collect();
        std::fs::create_dir_all(how.out).map_err(|error| SweepError::Files(how.out.into(), error))?;
        let [table, lines] = [("rows", "csv"), ("manifest", "jsonl")]
            .map(|(stem, extension)| how.out.join(how.part.file(stem, extension)));
        let mut manifest = Manifest::open(&lines)?;
        let mut rows: Vec<Option<Done>> =
            part.iter().zip(&keys).map(|(&number, key)| manifest.find(number, key)).collect();
        let before = rows.iter().flatten().count();
        let missing: Vec<usize> = (0..part.len()).filter(|&place| rows[place].is_none()).collect();
        let next = Mutex::new(missing.iter());
        let (send, receive) = mpsc::channel();
        std::thread::scope(|scope| {
            for _ in 0..how.at_once.clamp(1, missing.len().max(1)) {
                let (send, next, part) = (send.clone(), &next, &part);
                scope.spawn(move || {
                    loop {
                        let place = next.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some(&place) = place.filter(|_| !(how.stop)()) else { break };
                        let row = self.row(part[place], how);
                        let goes_on = matches!(row, Ok(Some(_)));
                        if send.send((place, row)).is_err() || !goes_on {
                            break;
                        }
                    }
                });
            }
            drop(send);
            for (place, row) in receive {
                let Some(row) = row? else { continue };
                manifest.add(&keys[place], &row)?;
                tell(&row);
                rows[place] = Some(row);
            }
            Ok(())
        })?;
        let rows: Vec<Done> = rows.into_iter().flatten().collect();
        rows::write(&table, &self.places(), &self.columns_of_table(), &rows)?;
        Ok(Outcome { rows, before, variants: part.len(), files: [table, lines] })
    }

    /// What makes two rows the same: version, scene, values, what is kept and when, and how it ran. What mesh files
    /// hold is not looked at.
    fn key(&self, number: usize, options: &Options) -> String {
        let Options { backend, precision, scheme, .. } = options;
        let SweepFile { keep, at, .. } = &self.file;
        let sets = self.sets(number);
        let how = format!("{} {backend:?} {precision:?} {scheme:?}", env!("CARGO_PKG_VERSION"));
        manifest::key(&format!("{how}\n{:?}\n{sets:?}\n{keep:?}\n{at:?}", self.text))
    }

    /// What `--set` would be given.
    fn sets(&self, number: usize) -> Vec<String> {
        let places = self.places();
        places.iter().zip(&self.variants[number]).map(|(place, value)| format!("{place}={value}")).collect()
    }

    /// Runs a variant; `None` where it was told to stop.
    fn row(&self, number: usize, how: &How<'_>) -> Result<Option<Done>, SweepError> {
        let started = Instant::now();
        let values = self.variants[number].clone();
        let mut row =
            Done { number, values, ended: Ended::Finished, error: None, time: 0.0, seconds: 0.0, kept: vec![] };
        let done = match SceneFile::load_allowing(&self.scene, &self.sets(number), self.allowed) {
            Ok(scene) => self.simulate(&scene, how, &mut row),
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
        for &time in &self.file.at {
            loop {
                if (how.stop)() {
                    return Ok(false);
                }
                let advanced = simulation.advance_for(PIECE, time)?;
                row.time = simulation.time();
                if advanced.why != Why::Budget {
                    break;
                }
            }
            self.ask(&mut simulation, row)?;
        }
        while self.file.at.is_empty() && !simulation.is_finished() {
            if (how.stop)() {
                return Ok(false);
            }
            simulation.advance_towards_end(PSEUDO_STEPS)?;
            row.time = simulation.time();
        }
        if self.file.at.is_empty() {
            self.ask(&mut simulation, row)?;
        }
        Ok(true)
    }

    /// Keeps what probes see now.
    fn ask(&self, simulation: &mut Simulation, row: &mut Done) -> Result<(), Error> {
        let mut seen = Vec::new();
        for (name, columns) in self.file.keep.iter().zip(&self.columns) {
            let numbers = simulation.probe(name)?;
            if numbers.len() != columns.len() {
                return Err(Error::Broken("a column of a probe"));
            }
            // what is no number is none: of a gap where nothing is near, for instance
            seen.extend(numbers.into_iter().map(|number| number.is_finite().then_some(number)));
        }
        row.kept.push(seen);
        Ok(())
    }

    /// Columns of what is kept: `tip ux (m)`, with times `tip ux (m) at 0.01 s`.
    fn columns_of_table(&self) -> Vec<String> {
        let names = self.file.keep.iter().zip(&self.columns);
        let at_once: Vec<String> =
            names.flat_map(|(name, columns)| columns.iter().map(move |column| format!("{name} {column}"))).collect();
        match &self.file.at[..] {
            [] => at_once,
            times => times.iter().flat_map(|t| at_once.iter().map(move |name| format!("{name} at {t} s"))).collect(),
        }
    }
}
