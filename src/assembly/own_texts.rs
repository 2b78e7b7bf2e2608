//! Files of the user's own texts, laws and systems, and what is said of them.

use crate::backend::user_law::{About, Complaint};
use crate::scene::diagnostic::{Diagnostic, Diagnostics, Severity, TextFile};
use crate::scene::limits::LAW_BYTES;
use crate::scene::syntax::Path;
use crate::scene::{Outside, SceneFile};
use std::io::Read as _;
use std::sync::Arc;

/// The text of a file that the scene names at `place`. Complaints go to `diagnostics`.
pub(super) fn read(
    scene: &SceneFile,
    name: &str,
    place: &Path,
    diagnostics: &mut Diagnostics,
) -> Option<Arc<TextFile>> {
    let path = match scene.file(name) {
        Ok(path) => path,
        Err(outside) => {
            let message = format!("`{}` lies outside the scene's folder", outside.name);
            diagnostics.error_at(place.name("file"), message).note(Outside::HOW);
            return None;
        }
    };
    match text_of(&path) {
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

/// What a file of a bearable length holds.
fn text_of(path: &std::path::Path) -> std::io::Result<String> {
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
