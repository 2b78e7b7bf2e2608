//! What stands for result files in a sinew without the feature `files`: there is no folder to write into, so nothing of
//! it is ever called.

use super::{Frame, OutputError, SurfaceFrame};
use crate::scene::schema::SkinFormat;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A folder that a run may write into, of which there is none.
pub enum Folder {}

/// A folder's lock, of which there is none.
pub enum Lock {}

/// A series of frames, of which there is none.
pub enum Series {}

/// A table that grows, of which there is none.
pub enum Table {}

fn not_built<T>(path: &Path) -> Result<T, OutputError> {
    Err(OutputError::NotBuilt { path: path.into() })
}

impl Folder {
    /// Says that result files cannot be written.
    ///
    /// # Errors
    /// [`OutputError::NotBuilt`], always.
    pub fn create(path: &Path) -> Result<Folder, OutputError> {
        not_built(path)
    }

    /// As [`Folder::create`].
    ///
    /// # Errors
    /// As [`Folder::create`].
    pub fn create_for(path: &Path, _: &str) -> Result<Folder, OutputError> {
        not_built(path)
    }
}

/// Says that result files cannot be written.
///
/// # Errors
/// [`OutputError::NotBuilt`], always.
pub fn write_vtu(path: &Path, _: &Frame<'_>) -> Result<(), OutputError> {
    not_built(path)
}

/// As [`write_vtu`].
///
/// # Errors
/// As [`write_vtu`].
pub fn write_table(path: &Path, _: &[&str], _: impl Iterator<Item = impl Serialize>) -> Result<(), OutputError> {
    not_built(path)
}

/// As [`write_vtu`].
///
/// # Errors
/// As [`write_vtu`].
pub fn write_surface(path: &Path, _: SkinFormat, _: &SurfaceFrame<'_>) -> Result<(), OutputError> {
    not_built(path)
}

/// Methods that cannot be called.
#[allow(missing_docs, reason = "as those of the same names with the feature `files`")]
impl Folder {
    pub fn lock(&self) -> Arc<Lock> {
        match *self {}
    }

    pub fn path(&self) -> &Path {
        match *self {}
    }

    pub fn claim(&mut self, _: &str) -> Result<PathBuf, OutputError> {
        match *self {}
    }
}

#[allow(missing_docs, reason = "as those of the same names with the feature `files`")]
impl Series {
    pub fn create(folder: &Folder) -> Result<Series, OutputError> {
        match *folder {}
    }

    pub fn named(folder: &Path, _: &str) -> Result<Series, OutputError> {
        not_built(folder)
    }

    pub fn write(&mut self, _: &Frame<'_>) -> Result<PathBuf, OutputError> {
        match *self {}
    }

    pub fn frame_count(&self) -> usize {
        match *self {}
    }
}

#[allow(missing_docs, reason = "as those of the same names with the feature `files`")]
impl Table {
    pub fn create<S: AsRef<str>>(path: &Path, _: &[S]) -> Result<Table, OutputError> {
        not_built(path)
    }

    pub fn row(&mut self, _: &[f64]) -> Result<(), OutputError> {
        match *self {}
    }

    pub fn path(&self) -> &Path {
        match *self {}
    }
}
