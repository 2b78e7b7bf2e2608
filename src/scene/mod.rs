//! Scene files: their words, how they are read, and what is said when they are wrong.

mod adjust;
#[doc(hidden)]
pub mod check;
pub(crate) mod copied_material;
#[doc(hidden)]
pub mod diagnostic;
mod excerpt;
mod file_access;
#[doc(hidden)]
pub mod limits;
#[doc(hidden)]
pub mod load;
mod load_parts;
mod named_files;
mod partial;
mod parts;
// its words are described in docs/scene.md; they grow with every version
#[doc(hidden)]
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
pub(crate) use copied_material::{CopiedMaterial, Part};
pub use diagnostic::{Diagnostic, Diagnostics, Placed, Severity, TextFile};
pub use file_access::FileSource;
pub use limits::Allowed;
pub use load::SceneFile;

#[doc(hidden)]
pub use file_access::{FileKind, Outside};
#[doc(hidden)]
pub use named_files::NamedFile;
#[doc(hidden)]
pub use suggest::{choice, list, nearest};
#[doc(hidden)]
pub use validate::{validate, validate_picture};
