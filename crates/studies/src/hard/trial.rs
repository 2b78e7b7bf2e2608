//! A hard case under one configuration: its scene, and the gates that what comes out has to pass.

use super::{Case, CaseConfiguration, Implicitly};
use sinew::Error;
use sinew::Simulation;
use sinew::output::OutputError;
use sinew::scene::SceneFile;
use sinew::scene::schema::{Contact, ContactLaw};
use sinew::systems::Registry;
use std::path::Path;

/// A gate: a figure and what is allowed.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Gate {
    /// What was measured.
    pub what: String,
    /// What came out.
    pub figure: f64,
    /// What is allowed, in words.
    pub allowed: String,
    /// Whether it is.
    pub passed: bool,
    /// How much of what is allowed was used: above 1 is too much; the gate with the most is shown in tables.
    #[serde(skip)]
    pub used: f64,
}

/// A case at work.
pub struct Trial<'a> {
    /// The case.
    pub case: &'a Case,
    /// How it is run.
    pub configuration: &'a CaseConfiguration,
    /// Whether in full, or in a size for everyday.
    pub full: bool,
    /// What was measured so far.
    pub gates: Vec<Gate>,
}

impl<'a> Trial<'a> {
    /// The case's scene with this configuration's elements and with values put in.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn scene(&self, sets: &[String]) -> Result<SceneFile, Error> {
        let mut all = Vec::new();
        if self.case.scene.contains("elements: ") {
            all.push(format!("bodies.body.mesh.elements={}", self.configuration.elements_name()));
        }
        all.extend_from_slice(sets);
        self.scene_in(Path::new("."), all)
    }

    /// The case's scene with values put in, and with what makes it one of implicit steps where it is to be.
    fn scene_in(&self, folder: &Path, mut sets: Vec<String>) -> Result<SceneFile, Error> {
        if self.is_implicit() {
            sets.retain(|set| !set.starts_with("integration"));
            sets.splice(0..0, self.implicit_sets());
        }
        let read = |sets: &[String]| SceneFile::from_text(&self.case.file(), self.case.scene, folder, sets);
        let scene = read(&sets)?;
        let Implicitly::BySprings(_, share) = self.case.implicitly else { return Ok(scene) };
        for (number, contact) in scene.scene.contacts.iter().enumerate().filter(|_| self.is_implicit()) {
            if contact.law() == ContactLaw::Kinematic {
                sets.push(format!("contacts[{number}].law=Penalty(share: {share:?})"));
            }
            // a spring has one force
            if let Contact::Between { sweeps: 2.., .. } | Contact::Itself { sweeps: 2.., .. } = contact {
                sets.push(format!("contacts[{number}].sweeps=1"));
            }
        }
        Ok(read(&sets)?)
    }

    /// Whether by implicit steps.
    pub fn is_implicit(&self) -> bool {
        self.configuration.implicit
    }

    /// What makes the scene one of implicit steps, where it is to be.
    fn implicit_sets(&self) -> Vec<String> {
        match self.case.implicitly {
            Implicitly::By(set) | Implicitly::BySprings(set, _) if self.is_implicit() => {
                vec!["integration=()".into(), set.into()]
            }
            _ => Vec::new(),
        }
    }

    /// A simulation of the scene.
    ///
    /// # Errors
    /// All that is wrong with it; what the GPU says.
    pub fn start(&self, sets: &[String]) -> Result<Simulation, Error> {
        Simulation::new(&self.scene(sets)?, &self.configuration.options)
    }

    /// The same with systems of the case's own.
    ///
    /// # Errors
    /// As [`Trial::start`].
    pub fn start_with(&self, sets: &[String], registry: &Registry) -> Result<Simulation, Error> {
        Simulation::with_systems(&self.scene(sets)?, &self.configuration.options, registry)
    }

    /// A simulation of the scene with a file beside it.
    ///
    /// # Errors
    /// As [`Trial::start`]; a folder for the file that cannot be made.
    pub fn start_beside(&self, name: &str, text: &str, sets: &[String]) -> Result<Simulation, Error> {
        let place = std::env::temp_dir();
        let folder = tempfile::tempdir().map_err(OutputError::system("create a folder in", &place))?;
        let path = folder.path().join(name);
        std::fs::write(&path, text).map_err(OutputError::system("write", &path))?;
        Simulation::new(&self.scene_in(folder.path(), sets.to_vec())?, &self.configuration.options)
    }

    /// Whether all is to be tried that the case knows, finer meshes too: in full, and where that is quickest.
    pub fn is_thorough(&self) -> bool {
        self.full || self.configuration.is_quickest()
    }

    /// One of two numbers: the first in f64, the second in f32.
    pub fn bound(&self, f64: f64, f32: f64) -> f64 {
        if self.configuration.is_f64() { f64 } else { f32 }
    }

    /// The size of the figure may be so much at most; what is not a number is too much.
    pub fn most(&mut self, what: impl Into<String>, figure: f64, limit: f64) {
        let used = if limit > 0.0 {
            figure.abs() / limit
        } else if figure == 0.0 {
            0.0
        } else {
            f64::INFINITY
        };
        self.gate(what, figure, format!("at most {limit:.3e}"), used);
    }

    /// The figure must be so much at least.
    pub fn least(&mut self, what: impl Into<String>, figure: f64, limit: f64) {
        let used =
            if figure >= limit { (1.0 - (figure - limit) / limit.abs().max(1e-300)).max(0.0) } else { f64::INFINITY };
        self.gate(
            what,
            figure,
            format!("at least {limit:.3e}"),
            used.min(if figure >= limit { 1.0 } else { f64::INFINITY }),
        );
    }

    /// The figure must be near what is expected, within a share of that.
    pub fn near(&mut self, what: impl Into<String>, figure: f64, expected: f64, share: f64) {
        let used = (figure - expected).abs() / (share * expected.abs());
        self.gate(what, figure, format!("{expected:.6e} within {share:.1e} of it"), used);
    }

    /// The figure must be between two numbers.
    pub fn within(&mut self, what: impl Into<String>, figure: f64, low: f64, high: f64) {
        let used = (figure - 0.5 * (low + high)).abs() / (0.5 * (high - low));
        self.gate(what, figure, format!("from {low:.6e} to {high:.6e}"), used);
    }

    /// How deep something is inside (m): springs of implicit steps give way, and it is told.
    pub fn depth(&mut self, what: impl Into<String>, figure: f64, limit: f64) {
        match self.is_implicit() {
            true => self.report(what, figure),
            false => self.most(what, figure, limit),
        }
    }

    /// A figure that is told, whatever it is.
    pub fn report(&mut self, what: impl Into<String>, figure: f64) {
        self.gate(what, figure, "reported".into(), 0.0);
    }

    /// Something that is so or not.
    pub fn holds(&mut self, what: impl Into<String>, so: bool) {
        self.gate(what, f64::from(so), "1: so".into(), if so { 0.0 } else { f64::INFINITY });
    }

    /// The scene must be refused, in words that contain all of these.
    pub fn refused(&mut self, what: &str, made: Result<Simulation, Error>, words: &[&str]) {
        let message = match made {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        };
        let missing: Vec<&str> = words.iter().copied().filter(|word| !message.contains(word)).collect();
        let so = !message.is_empty() && missing.is_empty();
        let what =
            if so { format!("{what} is refused") } else { format!("{what} is refused with {missing:?}: {message:?}") };
        self.holds(what, so);
    }

    /// The run must end in an honest failure that names these words.
    pub fn stops(&mut self, what: &str, ended: Result<(), Error>, words: &[&str]) {
        let (honest, message) = match &ended {
            Err(error @ (Error::Unstable(_) | Error::NotConverged(_))) => (true, error.to_string()),
            Err(error) => (false, error.to_string()),
            Ok(()) => (false, "it went on to the end".into()),
        };
        let so = honest && words.iter().all(|word| message.contains(word));
        self.holds(if so { format!("{what} stops honestly") } else { format!("{what} stops honestly: {message}") }, so);
    }

    fn gate(&mut self, what: impl Into<String>, figure: f64, allowed: String, used: f64) {
        let used = if used.is_nan() { f64::INFINITY } else { used };
        self.gates.push(Gate { what: what.into(), figure, allowed, passed: used <= 1.0, used });
    }
}
