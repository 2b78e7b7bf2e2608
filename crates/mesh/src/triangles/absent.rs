//! What stands for reading files of triangles where the feature `files` is off.

use super::Triangles;
use crate::MeshError;
use std::path::Path;

impl Triangles {
    /// Says that files cannot be read.
    ///
    /// # Errors
    /// [`MeshError::NotBuilt`], always.
    pub fn from_bytes_beside(
        path: impl AsRef<Path>,
        _: &[u8],
        _: &dyn Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Self, MeshError> {
        Err(MeshError::NotBuilt { file: path.as_ref().into() })
    }
}
