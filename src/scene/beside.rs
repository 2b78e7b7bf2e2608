//! Files that a scene names: beside it, in its folder or below.

use super::load::SceneFile;
use std::path::{Component, Path, PathBuf};

/// A file that a scene names and may not read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` lies outside the scene's folder; {HOW}")]
pub struct Outside {
    /// The path as the scene gives it.
    pub name: String,
}

impl Outside {
    /// What to do about it.
    pub const HOW: &'static str = HOW;
}

const HOW: &str =
    "put it into the folder or below, or allow it: --allow-outside, in a program Allowed { outside: true, .. }";

impl SceneFile {
    /// Where a file is that the scene names, its path relative to the scene's folder. Links are followed: what counts
    /// is where a file really is.
    ///
    /// # Errors
    /// The file lies outside the folder, and that is not [allowed](super::limits::Allowed::outside).
    pub fn file(&self, name: &str) -> Result<PathBuf, Outside> {
        let full = self.folder.join(name);
        if self.allowed.outside || is_inside(&self.folder, name, &full) {
            return Ok(full);
        }
        Err(Outside { name: name.to_string() })
    }
}

fn is_inside(folder: &Path, name: &str, full: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (folder.canonicalize(), full.canonicalize()) {
        (Ok(folder), Ok(full)) => full.starts_with(folder),
        // a file that is not there is judged by its name
        _ => stays_below(name),
    }
}

/// Whether no part of a relative path leads above its beginning.
fn stays_below(name: &str) -> bool {
    let mut depth = 0_usize;
    for part in Path::new(name).components() {
        depth = match part {
            Component::Normal(_) => depth + 1,
            Component::CurDir => depth,
            Component::ParentDir if depth > 0 => depth - 1,
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return false,
        };
    }
    true
}
