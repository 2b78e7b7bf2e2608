//! Laws of the user's own, read from the files that materials name.

pub(super) use crate::backend::user_law::Read;

use crate::backend::user_law::{About, Complaint, read as read_law};
use crate::scene::SceneFile;
use crate::scene::diagnostic::{Diagnostic, Diagnostics, Severity, TextFile};
use crate::scene::schema::OwnLaw;
use crate::scene::syntax::Path;
use std::collections::BTreeMap;
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
    let text = match std::fs::read_to_string(scene.folder.join(&law.file)) {
        Ok(text) => text,
        Err(error) => {
            let reason = match error.kind() {
                std::io::ErrorKind::NotFound => format!("there is no file `{}`", law.file),
                std::io::ErrorKind::InvalidData => format!("`{}` is not a text in UTF-8", law.file),
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
