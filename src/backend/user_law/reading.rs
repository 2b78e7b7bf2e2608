//! A text of the user's own, found to have its form, read for the CPU.

use super::form::Form;
use super::interface::{self, Parameters};
use super::{About, Complaint, limits, text};
use crate::materials::program::{DerivedLaw, Program, ProgramSource, Untranslatable};
use std::collections::BTreeMap;

/// A text of a form, ready to be translated function by function.
pub(super) struct Reading {
    source: ProgramSource,
    /// Bytes of our own text before that of the user.
    ours: usize,
    /// The parameters' values, by the name of the variable that holds them.
    values: BTreeMap<String, Vec<f64>>,
    /// The parameters as they lie in the uniform buffer, in f32.
    pub(super) uniform: Vec<u8>,
}

impl Reading {
    /// Checks a text's size and form, and the parameters that the scene gives.
    pub(super) fn of(
        form: &Form,
        path: &str,
        text: &str,
        given: &BTreeMap<String, f64>,
    ) -> Result<Self, Vec<Complaint>> {
        limits::check(text, form.word).map_err(|complaint| vec![complaint])?;
        let Parameters { values, bytes } = interface::check(form, path, text, given)?;
        let whole = text::in_double_precision(form, text);
        let ours = whole.len() - text.len();
        let source = ProgramSource::read(&whole).map_err(|error| complaints(error, ours))?;
        let values = BTreeMap::from([(form.parameters.to_owned(), values)]);
        Ok(Self { source, ours, values, uniform: bytes })
    }

    /// One of its functions.
    pub(super) fn program(&self, name: &str) -> Result<Program, Vec<Complaint>> {
        self.source.translate(name, &self.values).map_err(|error| complaints(error, self.ours))
    }

    /// The law that follows from one of its functions, an energy.
    pub(super) fn derived(&self, name: &str) -> Result<DerivedLaw, Vec<Complaint>> {
        self.source.derive(name, &self.values).map_err(|error| complaints(error, self.ours))
    }
}

/// What cannot be translated, at its place in the user's text, which begins after so many bytes of our own.
fn complaints(error: Untranslatable, ours: usize) -> Vec<Complaint> {
    let bytes = error.at.filter(|range| range.start >= ours).map(|range| range.start - ours..range.end - ours);
    let about = bytes.map_or(About::File, About::Bytes);
    vec![Complaint { notes: error.notes, ..Complaint::new(about, error.message) }]
}
