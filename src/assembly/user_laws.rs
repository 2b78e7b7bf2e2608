//! Laws of the user's own, read from formulas in materials and from the files that they name.

pub(super) use crate::backend::user_law::Read;

use super::own_texts;
use crate::backend::user_law::{About, Complaint, NamedLaw, read as read_law, read_formula};
use crate::scene::SceneFile;
use crate::scene::diagnostic::{Diagnostics, Severity};
use crate::scene::schema::OwnLaw;
use crate::scene::syntax::Path;
use std::collections::BTreeMap;

/// The laws of all materials that have one, by the material's name. Complaints go to `diagnostics`.
/// `in_rust` are those that a scene can name.
pub(super) fn read(scene: &SceneFile, in_rust: &[NamedLaw], diagnostics: &mut Diagnostics) -> BTreeMap<String, Read> {
    let mut found = BTreeMap::new();
    for (name, material) in &scene.scene.materials {
        let Some(law) = &material.law else { continue };
        let place = Path::default().name("materials").name(name).name("law");
        if diagnostics.has_error_in(place.clone()) {
            continue;
        }
        if let Some(read) = one(scene, in_rust, law, &place, diagnostics) {
            found.insert(name.clone(), read);
        }
    }
    found
}

fn one(
    scene: &SceneFile,
    in_rust: &[NamedLaw],
    law: &OwnLaw,
    place: &Path,
    diagnostics: &mut Diagnostics,
) -> Option<Read> {
    if let Some(name) = &law.rust {
        let Some(named) = in_rust.iter().find(|law| law.name == *name) else {
            let names = in_rust.iter().map(|law| law.name.as_str());
            unknown(name, names, &place.name("rust"), diagnostics);
            return None;
        };
        let (read, complaints) = told_apart(named.read(&law.parameters));
        for complaint in complaints {
            let at = match &complaint.about {
                About::Parameters => place.name("parameters"),
                About::Parameter(name) => place.name("parameters").name(name),
                About::Bytes(_) | About::File => place.name("rust"),
            };
            tell_at(complaint, at, diagnostics);
        }
        return read;
    }
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

/// Tells that a program has no law of a name.
fn unknown<'a>(name: &str, names: impl Iterator<Item = &'a str>, place: &Path, diagnostics: &mut Diagnostics) {
    let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    diagnostics.error_at(place.clone(), format!("this program has no law `{name}`")).note(match names.is_empty() {
        true => "a program of one's own adds laws in Rust to its registry: see docs/laws.md".to_owned(),
        false => format!("it has {}", names.join(", ")),
    });
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
    match complaint.about.clone() {
        About::Bytes(bytes) => {
            let diagnostic = diagnostics.error_within(formula, energy, bytes, complaint.message);
            if complaint.warning {
                diagnostic.severity = Severity::Warning;
            }
            diagnostic.label(complaint.label).notes(complaint.notes);
        }
        About::File => tell_at(complaint, formula, diagnostics),
        About::Parameters => tell_at(complaint, parameters, diagnostics),
        About::Parameter(name) => tell_at(complaint, parameters.name(name), diagnostics),
    }
}

fn tell_at(complaint: Complaint, place: Path, diagnostics: &mut Diagnostics) {
    let diagnostic = diagnostics.error_at(place, complaint.message);
    if complaint.warning {
        diagnostic.severity = Severity::Warning;
    }
    diagnostic.label(complaint.label).notes(complaint.notes);
}
