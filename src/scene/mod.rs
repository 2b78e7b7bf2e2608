//! Scene files: their words, how they are read, and what is said when they are wrong.

mod adjust;
mod beside;
pub mod check;
pub mod diagnostic;
mod excerpt;
pub mod limits;
pub mod load;
mod partial;
pub mod schema;
pub mod set;
pub mod source;
pub mod suggest;
pub mod syntax;
pub mod validate;
pub mod words;

pub(crate) use adjust::other_than_parameters;
pub use beside::{FileKind, FileSource, Outside};
pub use diagnostic::{Diagnostic, Diagnostics, Severity, TextFile};
pub use limits::Allowed;
pub use load::SceneFile;
pub use suggest::{choice, list, nearest};
pub use validate::{validate, validate_picture};
