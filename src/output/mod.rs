//! What a run leaves behind: field series for ParaView, tables and the summary.
//!
//! | file | writer |
//! |---|---|
//! | `sinew.json` | [`Folder::create`], the mark that a folder is an output of sinew |
//! | `fields.pvd`, `fields_000000.vtu` ... | [`Series`], one VTU file a [`Frame`] |
//! | `whole_mesh.vtu` | [`write_vtu`], the mesh of before elements were removed, where no frame has it |
//! | `energy.csv`, one table a probe | [`Table`] |
//! | `nodes.csv` | [`nodes::write`] |
//! | `unloaded.msh` | [`write_gmsh`] |
//! | `summary.json` | [`summary::write`] |
//!
//! Every file is readable at every moment: whole files are written under another name and renamed, files that grow do
//! so by whole rows. One process at a time writes into a folder: [`Folder`] holds a [`Lock`]. A run that is interrupted
//! leaves what it had written until then.

mod atomic;
mod error;
mod finite;
mod folder;
mod gmsh;
mod lock;
pub mod nodes;
mod pvd;
pub mod summary;
mod table;
mod vtu;

pub use atomic::replace;
pub use error::OutputError;
pub use finite::not_finite;
pub use folder::{Folder, WHOLE};
pub use gmsh::write as write_gmsh;
pub use lock::Lock;
pub use nodes::Node;
pub use pvd::{FIELDS, Series};
pub use table::Table;
pub use vtu::{Array, Frame, Values, write as write_vtu};
