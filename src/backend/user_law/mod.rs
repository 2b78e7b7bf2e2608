//! Reading a law or a load of the user's own: one WGSL file, or a formula, with parameters from the scene. The text is
//! compiled with our own fragments as the GPU will, translated for the CPU, and found to be what it should before
//! anything is simulated with it.

mod checks;
mod comparison;
mod deformations;
mod energy;
mod form;
mod formula;
mod in_kernels;
mod interface;
mod limits;
mod load;
mod names;
mod reading;
mod rust;
mod text;

pub use checks::LawCheck;
pub use energy::read_formula;
pub(crate) use form::callable_fragments_of_load;
pub(crate) use in_kernels::with_law;
pub use load::{check_load, read_load};
pub use rust::NamedLaw;

use crate::backend::cpu::OwnKernels;
use crate::materials::{ElasticLaw, IsochoricStress, LawPrograms, UserLaw};
use form::{Form, OF_LAWS};
use reading::Reading;
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

/// What is wrong with a law or a load, or should be known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Complaint {
    /// Whether it can be used all the same.
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
    /// The same law built in, where an energy turns out to be that of one: it has kernels of its own.
    pub built_in: Option<ElasticLaw<f64>>,
    /// Kernels of its own, of a law in Rust.
    pub own_kernels: Option<OwnKernels>,
    /// What was found.
    pub findings: LawCheck,
    /// Warnings.
    pub warnings: Vec<Complaint>,
}

/// Reads a law from the text of its file and the parameters that the scene gives. The file may have the law's energy
/// alone, as `elastic_energy`.
///
/// # Errors
/// All that is wrong with the text, or with the parameters; if they are sound, with the law itself.
pub fn read(path: &str, text: &str, parameters: &BTreeMap<String, f64>) -> Result<Read, Vec<Complaint>> {
    if energy::is_one(text) {
        return energy::read(path, text, parameters, &checks::Told::energy(text));
    }
    let reading = Reading::of(&Form::law(), path, text, parameters)?;
    let program = |number: usize| reading.program(OF_LAWS[number].0);
    let law = LawPrograms {
        path: path.to_owned(),
        text: text.to_owned(),
        isochoric: IsochoricStress::Whole(program(0)?),
        pressure: program(1)?,
        isochoric_energy: program(2)?,
        volumetric_energy: program(3)?,
        moduli: [0.0; 2],
        uniform: reading.uniform,
    };
    let (findings, warnings) = checks::check(&law, &checks::Told::law(text))?;
    let law = LawPrograms { moduli: [findings.shear, findings.bulk], ..law };
    Ok(Read { law: UserLaw::new(law), built_in: None, own_kernels: None, findings, warnings })
}
