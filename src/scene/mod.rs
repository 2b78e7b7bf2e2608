//! Scene files: their words, how they are read, and what is said when they are wrong.

pub mod check;
pub mod diagnostic;
pub mod load;
mod partial;
pub mod schema;
pub mod set;
pub mod source;
pub mod suggest;
pub mod syntax;
pub mod validate;
pub mod words;

pub use diagnostic::{Diagnostic, Diagnostics, Severity};
pub use load::SceneFile;
pub use suggest::{choice, list};
pub use validate::validate;
