//! What can be wrong with a mesh, said so that its author can put it right.

use super::soundness::Finding;
use std::fmt;
use std::path::PathBuf;

/// Why a mesh was refused.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// The file could not be opened or read.
    #[error("{}: cannot be read: {source}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file breaks the rules of its format, or uses a part of it that is not supported.
    #[error("{}{at}: {what}; {allowed}", file.display())]
    Format {
        /// The file.
        file: PathBuf,
        /// Where in the file.
        at: FilePosition,
        /// What is wrong.
        what: String,
        /// What is allowed, or what to do.
        allowed: String,
    },
    /// The mesh was read, but elements or points make it impossible to simulate.
    #[error("{name}: the mesh cannot be simulated:{}{}", list(findings), list(notes))]
    Unsound {
        /// The file, or the name of the body.
        name: String,
        /// All errors that were found.
        findings: Vec<Finding>,
        /// What is to be known about how it was read.
        notes: Vec<String>,
    },
    /// This sinew was built without the feature `files`.
    #[error("{}: this sinew was built without reading mesh files (feature `files`)", file.display())]
    NotBuilt {
        /// The file.
        file: PathBuf,
    },
    /// A parameter of a generator or of a placement is outside its range.
    #[error("{name}: {parameter} is {value}; {allowed}")]
    Parameter {
        /// What the parameter belongs to: `Box`, `Lens`, `place` ...
        name: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// The file as a whole.
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A byte, counted from 0: in binary parts.
    Byte(usize),
}

impl fmt::Display for FilePosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilePosition::File => Ok(()),
            FilePosition::Line(line) => write!(f, ":{line}"),
            FilePosition::Byte(byte) => write!(f, ": byte {byte}"),
        }
    }
}

fn list(sentences: &[impl fmt::Display]) -> String {
    sentences.iter().map(|sentence| format!("\n  {sentence}")).collect()
}
