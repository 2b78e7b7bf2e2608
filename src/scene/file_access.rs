//! Files that a scene names: beside it, in its folder or below, or in memory.

use super::load::SceneFile;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read as _};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

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

/// Where the files that a scene names are.
#[derive(Clone, Debug, Default)]
pub enum FileSource {
    /// In the scene's folder or below.
    #[default]
    Disk,
    /// In memory, by the names that the scene gives them: in a browser, or where a program has made them.
    Memory(Arc<BTreeMap<String, Vec<u8>>>),
}

/// What a scene's name of a file stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A file.
    File,
    /// A folder.
    Folder,
    /// Nothing.
    Nothing,
}

/// Where files are that a scene names, and which of them it may read.
#[derive(Clone, Copy)]
pub(super) struct FileAccess<'a> {
    pub(super) folder: &'a Path,
    pub(super) files: &'a FileSource,
    /// Whether files may lie outside the folder.
    pub(super) outside: bool,
}

impl SceneFile {
    fn file_access(&self) -> FileAccess<'_> {
        FileAccess { folder: &self.folder, files: &self.files, outside: self.allowed.outside }
    }

    /// Where a file is that the scene names, its path relative to the scene's folder. Links are followed: what counts
    /// is where a file really is. A file in memory is where its name says.
    ///
    /// # Errors
    /// The file lies outside the folder, and that is not [allowed](super::limits::Allowed::outside).
    pub fn file(&self, name: &str) -> Result<PathBuf, Outside> {
        self.file_access().file(name)
    }

    /// What a file holds that the scene names, if that is no more than `most` bytes.
    ///
    /// # Errors
    /// The file lies outside the scene's folder, is not there, is no plain file, is longer, or cannot be read.
    pub fn bytes(&self, name: &str, most: u64) -> io::Result<Cow<'_, [u8]>> {
        self.file_access().bytes(name, most)
    }

    /// What a file holds that another file of the scene names, its path relative to that one's folder; what is wrong in
    /// words.
    pub(super) fn bytes_beside(&self, file: &str, name: &str) -> Result<Vec<u8>, String> {
        let bytes = self.bytes(&beside(file, name), u64::MAX).map_err(|error| error.to_string())?;
        Ok(bytes.into_owned())
    }

    /// What a name stands for, and the names of the files that are where it should be.
    ///
    /// # Errors
    /// As [`Self::file`].
    pub fn look_up(&self, name: &str) -> Result<(FileKind, Vec<String>), Outside> {
        self.file_access().look_up(name)
    }
}

impl<'a> FileAccess<'a> {
    pub(super) fn file(&self, name: &str) -> Result<PathBuf, Outside> {
        if let FileSource::Memory(_) = self.files {
            return Ok(name.into());
        }
        let full = self.folder.join(name);
        if self.outside || is_inside(self.folder, name, &full) {
            return Ok(full);
        }
        Err(Outside { name: name.to_string() })
    }

    pub(super) fn bytes(&self, name: &str, most: u64) -> io::Result<Cow<'a, [u8]>> {
        let path = self.file(name).map_err(|outside| io::Error::new(ErrorKind::PermissionDenied, outside))?;
        let bytes: Cow<'a, [u8]> = match self.files {
            FileSource::Memory(files) => in_memory(files, name).map(|bytes| bytes.into()).ok_or(ErrorKind::NotFound)?,
            FileSource::Disk => {
                let kind = std::fs::metadata(&path)?;
                if !kind.is_file() {
                    // reading a pipe could wait for ever
                    return Err(if kind.is_dir() { ErrorKind::IsADirectory } else { ErrorKind::Unsupported }.into());
                }
                let mut bytes = Vec::new();
                // one byte more tells that there are too many
                std::fs::File::open(path)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
                bytes.into()
            }
        };
        if bytes.len() as u64 > most {
            return Err(ErrorKind::FileTooLarge.into());
        }
        Ok(bytes)
    }

    pub(super) fn look_up(&self, name: &str) -> Result<(FileKind, Vec<String>), Outside> {
        let full = self.file(name)?;
        Ok(match self.files {
            FileSource::Memory(files) => {
                let found = if in_memory(files, name).is_some() { FileKind::File } else { FileKind::Nothing };
                (found, files.keys().cloned().collect())
            }
            FileSource::Disk if full.is_file() => (FileKind::File, Vec::new()),
            FileSource::Disk if full.is_dir() => (FileKind::Folder, Vec::new()),
            FileSource::Disk => {
                let folder = full.parent().unwrap_or(self.folder);
                let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
                let entries = std::fs::read_dir(folder).into_iter().flatten();
                let mut there: Vec<String> =
                    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
                there.sort();
                (FileKind::Nothing, there)
            }
        })
    }
}

/// What the scene would call a file that another one of its files names.
pub(super) fn beside(file: &str, name: &str) -> String {
    Path::new(file).with_file_name(name).to_string_lossy().into_owned()
}

/// A file in memory, by its name or another that means the same: `tools/../lens.msh`.
fn in_memory<'a>(files: &'a BTreeMap<String, Vec<u8>>, name: &str) -> Option<&'a Vec<u8>> {
    files.get(name).or_else(|| files.get(&shortest(name)))
}

/// A relative path without ways down and up again: `lens.msh` of `tools/../lens.msh`.
pub(super) fn shortest(name: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "." => {}
            ".." if parts.last().is_some_and(|last| !matches!(*last, "" | "..")) => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
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
