//! Laws of the user's own, read from the files that materials name.

pub(super) use crate::backend::user_law::Read;

use crate::backend::user_law::{About, Complaint, read as read_law};
use crate::scene::diagnostic::{Diagnostic, Diagnostics, Severity, TextFile};
use crate::scene::limits::LAW_BYTES;
use crate::scene::schema::OwnLaw;
use crate::scene::syntax::Path;
use crate::scene::{Outside, SceneFile};
use std::collections::BTreeMap;
use std::io::Read as _;
use std::sync::Arc;

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
    let path = match scene.file(&law.file) {
        Ok(path) => path,
        Err(outside) => {
            let message = format!("`{}` lies outside the scene's folder", outside.name);
            diagnostics.error_at(place.name("file"), message).note(Outside::HOW);
            return None;
        }
    };
    let text = match read_text(&path) {
        Ok(text) => text,
        Err(error) => {
            let reason = match error.kind() {
                std::io::ErrorKind::NotFound => format!("there is no file `{}`", law.file),
                std::io::ErrorKind::InvalidData => format!("`{}` is not a text in UTF-8", law.file),
                std::io::ErrorKind::FileTooLarge => {
                    format!("`{}` has more than {LAW_BYTES} bytes, the most that are allowed", law.file)
                }
                _ => format!("cannot read `{}`: {error}", law.file),
            };
            diagnostics.error_at(place.name("file"), reason).note("paths are relative to the scene file");
            return None;
        }
    };
    let file = Arc::new(TextFile { name: law.file.clone(), text });
    let (read, complaints) = match read_law(&law.file, &file.text, &law.parameters) {
        Ok(mut read) => {
            let warnings = std::mem::take(&mut read.warnings);
            (Some(read), warnings)
        }
        Err(complaints) => (None, complaints),
    };
    for complaint in complaints {
        tell(complaint, &file, place, diagnostics);
    }
    read
}

/// What a file of a bearable length holds.
fn read_text(path: &std::path::Path) -> std::io::Result<String> {
    let mut text = String::new();
    let kind = std::fs::metadata(path)?;
    if !kind.is_file() {
        // reading a pipe could wait for ever
        let kind = if kind.is_dir() { std::io::ErrorKind::IsADirectory } else { std::io::ErrorKind::Unsupported };
        return Err(kind.into());
    }
    std::fs::File::open(path)?.take(LAW_BYTES + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LAW_BYTES {
        return Err(std::io::ErrorKind::FileTooLarge.into());
    }
    Ok(text)
}

fn tell(complaint: Complaint, file: &Arc<TextFile>, place: &Path, diagnostics: &mut Diagnostics) {
    let parameters = place.name("parameters");
    let diagnostic = match complaint.about {
        About::Bytes(ref bytes) => diagnostics.push(Diagnostic::error(bytes.clone(), complaint.message)),
        About::File => diagnostics.push(Diagnostic::error(None, complaint.message)),
        About::Parameters => diagnostics.error_at(parameters, complaint.message),
        About::Parameter(ref name) => diagnostics.error_at(parameters.name(name), complaint.message),
    };
    if matches!(complaint.about, About::Bytes(_) | About::File) {
        diagnostic.file = Some(Arc::clone(file));
    }
    if complaint.warning {
        diagnostic.severity = Severity::Warning;
    }
    diagnostic.label(complaint.label).notes(complaint.notes);
}
