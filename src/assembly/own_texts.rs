//! Files of the user's own texts, laws and systems, and what is said of them.

use crate::backend::user_law::{About, Complaint};
use crate::scene::diagnostic::{Diagnostic, Diagnostics, Severity, TextFile};
use crate::scene::limits::LAW_BYTES;
use crate::scene::syntax::Path;
use crate::scene::{Outside, SceneFile};
use std::sync::Arc;

/// The text of a file that the scene names at `place`. Complaints go to `diagnostics`.
pub(super) fn read(
    scene: &SceneFile,
    name: &str,
    place: &Path,
    diagnostics: &mut Diagnostics,
) -> Option<Arc<TextFile>> {
    if let Err(outside) = scene.file(name) {
        let message = format!("`{}` lies outside the scene's folder", outside.name);
        diagnostics.error_at(place.name("file"), message).note(Outside::HOW);
        return None;
    }
    let text = scene.bytes(name, LAW_BYTES).and_then(|bytes| {
        String::from_utf8(bytes.into_owned())
            .map_err(|error| std::io::Error::new(std::io::ErrorKind::InvalidData, error))
    });
    match text {
        Ok(text) => Some(Arc::new(TextFile { name: name.to_owned(), text })),
        Err(error) => {
            let reason = match error.kind() {
                std::io::ErrorKind::NotFound => format!("there is no file `{name}`"),
                std::io::ErrorKind::InvalidData => format!("`{name}` is not a text in UTF-8"),
                std::io::ErrorKind::FileTooLarge => {
                    format!("`{name}` has more than {LAW_BYTES} bytes, the most that are allowed")
                }
                _ => format!("cannot read `{name}`: {error}"),
            };
            diagnostics.error_at(place.name("file"), reason).note("paths are relative to the scene file");
            None
        }
    }
}

/// Tells what is wrong with a text that the scene names at `place`.
pub(super) fn tell(complaint: Complaint, file: &Arc<TextFile>, place: &Path, diagnostics: &mut Diagnostics) {
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
