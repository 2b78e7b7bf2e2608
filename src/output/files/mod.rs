//! What only a sinew with the feature `files` writes; `absent.rs` stands for it in one without.

mod folder;
mod gmsh;
mod lock;
mod pvd;
mod surface;
mod table;
mod vtu;

pub use folder::Folder;
pub use gmsh::write as write_gmsh;
pub use lock::Lock;
pub use pvd::{FIELDS, Series};
pub use surface::write as write_surface;
pub use table::{Table, write as write_table};
pub use vtu::write as write_vtu;
