//! What a run leaves behind: field series for ParaView, tables and the summary.
//!
//! | file | writer |
//! |---|---|
//! | `sinew.json` | [`Folder::create`], the mark that a folder is an output of sinew |
//! | `fields.pvd`, `fields_000000.vtu` ... | [`Series`], one VTU file a [`Frame`] |
//! | `skin_BODY.pvd`, `skin_BODY_000000.vtu` ... | [`Series`], the skin of a body that has one |
//! | `skin_BODY_000000.ply` or `.obj` ... | [`write_surface`], the same for others, where the scene asks for it |
//! | `whole_mesh.vtu` | [`write_vtu`], the mesh of before elements were removed, where no frame has it |
//! | `energy.csv`, one table a probe | [`Table`] |
//! | `nodes.csv` | [`nodes::write`] |
//! | `unloaded.msh` | [`write_gmsh`] |
//! | `summary.json` | [`summary::write`] |
//!
//! Every file is readable at every moment: whole files are written under another name and renamed, files that grow do
//! so by whole rows. One process at a time writes into a folder: [`Folder`] holds a [`Lock`]. A run that is interrupted
//! leaves what it had written until then.
//!
//! Without the feature `files` there are no such files, and no [`Folder`] can be made.

#[cfg(not(feature = "files"))]
mod absent;
mod atomic;
mod error;
#[cfg(feature = "files")]
mod files;
mod finite;
mod frame;
pub mod nodes;
pub mod summary;

#[cfg(not(feature = "files"))]
pub use absent::{Folder, Lock, Series, Table, write_surface, write_table, write_vtu};
pub use atomic::replace;
pub use error::OutputError;
#[cfg(feature = "files")]
pub use files::{FIELDS, Folder, Lock, Series, Table, write_gmsh, write_surface, write_table, write_vtu};
pub use finite::not_finite;
pub use frame::{Array, Frame, SurfaceFrame, Values, WHOLE};
pub use nodes::Node;
