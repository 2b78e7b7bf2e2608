//! What is wrong with a file, before its name is added.

use crate::{FilePosition, MeshError};
use std::path::Path;

/// A fault found while a file is read, before its name is added.
#[derive(Debug)]
#[doc(hidden)]
pub struct Fault {
    /// Where in the file.
    pub at: FilePosition,
    /// What is wrong.
    pub what: String,
    /// What is allowed, or what to do.
    pub allowed: String,
}

impl Fault {
    /// A fault of the file as a whole.
    pub fn whole(what: impl Into<String>, allowed: impl Into<String>) -> Self {
        Fault { at: FilePosition::File, what: what.into(), allowed: allowed.into() }
    }

    /// The error that names the file.
    pub fn in_file(self, file: &Path) -> MeshError {
        MeshError::Format { file: file.to_path_buf(), at: self.at, what: self.what, allowed: self.allowed }
    }
}
