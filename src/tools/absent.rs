//! What stands for reading files of tools in a sinew without the feature `files`.

use super::Triangles;
use crate::mesh::MeshError;
use std::path::Path;

impl Triangles {
    /// Says that files cannot be read.
    ///
    /// # Errors
    /// [`MeshError::NotBuilt`], always.
    pub fn from_bytes(path: impl AsRef<Path>, _: &[u8]) -> Result<Self, MeshError> {
        Err(MeshError::NotBuilt { file: path.as_ref().into() })
    }
}
