//! What stands for reading mesh files in a sinew without the feature `files`.

use super::{Mesh, MeshError};
use std::path::Path;

impl Mesh {
    /// Says that mesh files cannot be read.
    ///
    /// # Errors
    /// [`MeshError::NotBuilt`], always.
    pub fn read(path: impl AsRef<Path>, flip_inverted: bool) -> Result<Mesh, MeshError> {
        Self::from_bytes(path, &[], flip_inverted)
    }

    /// As [`Self::read`].
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_bytes(path: impl AsRef<Path>, _: &[u8], _: bool) -> Result<Mesh, MeshError> {
        Err(MeshError::NotBuilt { file: path.as_ref().into() })
    }
}
