//! Scene files: their words, how they are read, and what is said when they are wrong.

mod adjust;
#[doc(hidden)]
pub mod check;
pub mod diagnostic;
mod excerpt;
mod file_access;
#[doc(hidden)]
pub mod limits;
#[doc(hidden)]
pub mod load;
mod load_parts;
mod partial;
mod parts;
pub mod schema;
#[doc(hidden)]
pub mod set;
#[doc(hidden)]
pub mod source;
#[doc(hidden)]
pub mod suggest;
#[doc(hidden)]
pub mod syntax;
#[doc(hidden)]
pub mod validate;
#[doc(hidden)]
pub mod words;

pub(crate) use adjust::other_than_parameters;
pub use diagnostic::{Diagnostic, Diagnostics, Severity, TextFile};
pub use file_access::{FileKind, FileSource, Outside};
pub use limits::Allowed;
pub use load::SceneFile;
pub use suggest::{choice, list, nearest};
pub use validate::{validate, validate_picture};
