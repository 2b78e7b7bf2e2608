//! Reading a law of the user's own: one WGSL file with parameters from the scene. The text is compiled with our own
//! fragments as the GPU will, translated for the CPU, and found to be a law before anything is simulated with it.

mod checks;
mod comparison;
mod deformations;
mod interface;
mod limits;
mod names;
mod text;

pub use checks::Findings;
pub(crate) use names::declared_names;

use crate::materials::program::Untranslatable;
use crate::materials::{LawPrograms, UserLaw};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a complaint is about.
#[derive(Clone, Debug, PartialEq)]
pub enum About {
    /// These bytes of the file.
    Bytes(Range<usize>),
    /// The file as a whole.
    File,
    /// A parameter that the scene gives.
    Parameter(String),
    /// The parameters that the scene gives, all of them.
    Parameters,
}

/// What is wrong with a law, or should be known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Complaint {
    /// Whether the law can be used all the same.
    pub warning: bool,
    /// Where.
    pub about: About,
    /// One sentence without a full stop.
    pub message: String,
    /// A word on the place.
    pub label: String,
    /// What is allowed, what to do.
    pub notes: Vec<String>,
}

impl Complaint {
    fn new(about: About, message: impl Into<String>) -> Self {
        Self { warning: false, about, message: message.into(), label: String::new(), notes: Vec::new() }
    }

    fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

/// A law that has been read, what was found when it was tried, and what should be known of it.
pub struct Read {
    /// The law.
    pub law: UserLaw<f64>,
    /// What was found.
    pub findings: Findings,
    /// Warnings.
    pub warnings: Vec<Complaint>,
}

/// The functions of a law: name, types of the arguments, type of the result, and what it is.
const FUNCTIONS: [(&str, &str, &str, &str); 4] = [
    ("elastic_isochoric", "Kinematics", "Sym3", "fn elastic_isochoric(k: Kinematics) -> Sym3"),
    ("elastic_pressure", "f32", "f32", "fn elastic_pressure(volume_change: f32) -> f32"),
    ("elastic_isochoric_energy", "Kinematics", "f32", "fn elastic_isochoric_energy(k: Kinematics) -> f32"),
    ("elastic_volumetric_energy", "f32", "f32", "fn elastic_volumetric_energy(volume_change: f32) -> f32"),
];

/// The one variable that a law may have: `var<uniform> elastic`.
const PARAMETERS: &str = "elastic";

/// Reads a law from the text of its file and the parameters that the scene gives.
///
/// # Errors
/// All that is wrong with the text, or with the parameters; if they are sound, with the law itself.
pub fn read(path: &str, text: &str, parameters: &BTreeMap<String, f64>) -> Result<Read, Vec<Complaint>> {
    limits::check(text).map_err(|complaint| vec![complaint])?;
    let uniform = interface::check(path, text, parameters)?;
    let whole = text::in_double_precision(text);
    let own = whole.len() - text.len();
    let complaint = |error: Untranslatable| {
        let bytes = error.at.filter(|range| range.start >= own).map(|range| range.start - own..range.end - own);
        let about = bytes.map_or(About::File, About::Bytes);
        vec![Complaint { notes: error.notes, ..Complaint::new(about, error.message) }]
    };
    let source = crate::materials::program::Source::read(&whole).map_err(complaint)?;
    let values = BTreeMap::from([(PARAMETERS.to_owned(), uniform.values)]);
    let program = |name: &str| source.translate(name, &values).map_err(complaint);
    let mut law = LawPrograms {
        path: path.to_owned(),
        text: text.to_owned(),
        uniform: uniform.bytes,
        isochoric: program(FUNCTIONS[0].0)?,
        pressure: program(FUNCTIONS[1].0)?,
        isochoric_energy: program(FUNCTIONS[2].0)?,
        volumetric_energy: program(FUNCTIONS[3].0)?,
        moduli: [0.0; 2],
    };
    let (findings, warnings) = checks::check(&law, text)?;
    law.moduli = [findings.shear, findings.bulk];
    Ok(Read { law: UserLaw::new(law), findings, warnings })
}
