//! What can go wrong while results are written.

use std::io;
use std::path::{Path, PathBuf};

/// A result could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The system refused: disk full, no permission, folder gone.
    #[error("cannot {action} {}: {source}", path.display())]
    System {
        /// What was tried: "write", "create".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The output folder holds something that sinew did not write.
    #[error(
        "{} is not empty and no output of sinew (it holds {found} but no sinew.json); name a new or an empty folder",
        path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// One of the names in it.
        found: String,
    },
    /// The output folder's path leads to a file.
    #[error("{} is a file; the output needs a folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// Another process writes into the output folder.
    #[error("{} is being written by another sinew ({by}); wait until it has ended, or name another folder", path.display())]
    Held {
        /// The folder.
        path: PathBuf,
        /// Who it is, as far as known: process, since when, scene.
        by: String,
    },
    /// A name that cannot be a file in the output folder.
    #[error("\"{name}\" cannot be the name of an output file; allowed are letters, digits, '_', '-', '.' and ' '")]
    FileName {
        /// The name.
        name: String,
    },
    /// An array has the wrong number of values.
    #[error(
        "{}: array \"{array}\" has {found} values; {rows} rows of {components} components need {}",
        path.display(), rows * components
    )]
    ArrayLength {
        /// The file.
        path: PathBuf,
        /// The array's name.
        array: String,
        /// How many values it has.
        found: usize,
        /// How many rows there are.
        rows: usize,
        /// Values a row.
        components: usize,
    },
    /// An element names a point that does not exist.
    #[error("{}: an element names point {point}, but there are {points} points, counted from 0", path.display())]
    NoSuchPoint {
        /// The file.
        path: PathBuf,
        /// The point that the element names.
        point: u32,
        /// How many points there are.
        points: usize,
    },
    /// A row of a table has the wrong number of cells.
    #[error("{}: a row of {found} cells in a table of {columns} columns", path.display())]
    RowLength {
        /// The file.
        path: PathBuf,
        /// Cells in the row.
        found: usize,
        /// Columns of the table.
        columns: usize,
    },
    /// This sinew was built without the feature `files`.
    #[error("{}: this sinew was built without writing result files (feature `files`)", path.display())]
    NotBuilt {
        /// The file or folder.
        path: PathBuf,
    },
    /// Something cannot be expressed in the file's format.
    #[error("{}: {reason}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What cannot be expressed.
        reason: String,
    },
}

impl OutputError {
    /// The system's reason, with what was tried and where.
    pub fn system(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> OutputError + use<> {
        let path = path.to_path_buf();
        move |source| OutputError::System { action, path, source }
    }
}
