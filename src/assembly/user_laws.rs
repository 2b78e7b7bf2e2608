//! Laws of the user's own, read from formulas in materials and from the files that they name.

pub(super) use crate::backend::user_law::Read;

use super::own_texts;
use crate::backend::user_law::{About, Complaint, read as read_law, read_formula};
use crate::scene::SceneFile;
use crate::scene::diagnostic::{Diagnostics, Severity};
use crate::scene::schema::OwnLaw;
use crate::scene::syntax::Path;
use std::collections::BTreeMap;

/// The laws of all materials that have one, by the material's name. Complaints go to `diagnostics`.
pub(super) fn read(scene: &SceneFile, diagnostics: &mut Diagnostics) -> BTreeMap<String, Read> {
    let mut found = BTreeMap::new();
    for (name, material) in &scene.scene.materials {
        let Some(law) = &material.law else { continue };
        let place = Path::default().name("materials").name(name).name("law");
        if diagnostics.has_error_in(place.clone()) {
            continue;
        }
        if let Some(read) = one(scene, law, &place, diagnostics) {
            found.insert(name.clone(), read);
        }
    }
    found
}

fn one(scene: &SceneFile, law: &OwnLaw, place: &Path, diagnostics: &mut Diagnostics) -> Option<Read> {
    if let Some(energy) = &law.energy {
        let (read, complaints) = told_apart(read_formula(energy, &law.parameters));
        for complaint in complaints {
            tell(complaint, energy, place, diagnostics);
        }
        return read;
    }
    let file = own_texts::read(scene, &law.file, place, diagnostics)?;
    let (read, complaints) = told_apart(read_law(&law.file, &file.text, &law.parameters));
    for complaint in complaints {
        own_texts::tell(complaint, &file, place, diagnostics);
    }
    read
}

/// A law, and what is to be told of it.
fn told_apart(read: Result<Read, Vec<Complaint>>) -> (Option<Read>, Vec<Complaint>) {
    match read {
        Ok(mut read) => {
            let warnings = std::mem::take(&mut read.warnings);
            (Some(read), warnings)
        }
        Err(complaints) => (None, complaints),
    }
}

/// Tells what is wrong with a formula that the scene has at `place`.
fn tell(complaint: Complaint, energy: &str, place: &Path, diagnostics: &mut Diagnostics) {
    let (formula, parameters) = (place.name("energy"), place.name("parameters"));
    let diagnostic = match complaint.about {
        About::Bytes(bytes) => diagnostics.error_within(formula, energy, bytes, complaint.message),
        About::File => diagnostics.error_at(formula, complaint.message),
        About::Parameters => diagnostics.error_at(parameters, complaint.message),
        About::Parameter(ref name) => diagnostics.error_at(parameters.name(name), complaint.message),
    };
    if complaint.warning {
        diagnostic.severity = Severity::Warning;
    }
    diagnostic.label(complaint.label).notes(complaint.notes);
}
