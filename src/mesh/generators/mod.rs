//! Meshes made from a few numbers: one file a shape.
//!
//! All of them deform a grid of cells; a cell is one hexahedron or six tetrahedra. Points run along x fastest, then y,
//! then z; the elements of a cell follow each other.

mod r#box;
mod cylinder;
mod ellipsoid;
mod grid;
mod hexahedron;
mod lens;
mod round;
mod tube;

pub use r#box::box_mesh;
pub use cylinder::cylinder_mesh;
pub use ellipsoid::ellipsoid_mesh;
pub use hexahedron::hexahedron_mesh;
pub use lens::lens_mesh;
pub(crate) use tube::cells_around;
pub use tube::tube_mesh;

use super::{CellKind, MeshError};
use serde::{Deserialize, Serialize};

/// Kinds of elements. Generators make six tetrahedra or one hexahedron of a cell.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementKind {
    /// Four-node tetrahedra: quick, and stiff near incompressibility (locking).
    #[default]
    Tet4,
    /// Four-node tetrahedra with averaged nodal pressure: they hardly lock.
    Tet4NodalPressure,
    /// Eight-node hexahedra with one point and hourglass control: quick, and they do not lock.
    Hex8,
    /// Eight-node hexahedra with eight points and mean dilatation: accurate, and slower.
    Hex8MeanDilatation,
}

impl ElementKind {
    /// All kinds.
    pub const ALL: [ElementKind; 4] = [Self::Tet4, Self::Tet4NodalPressure, Self::Hex8, Self::Hex8MeanDilatation];

    /// The kind of its cells.
    pub const fn cell(self) -> CellKind {
        match self {
            Self::Tet4 | Self::Tet4NodalPressure => CellKind::Tet4,
            Self::Hex8 | Self::Hex8MeanDilatation => CellKind::Hex8,
        }
    }

    /// How many of them generators make of a cell of their grid; none where they cannot.
    pub const fn a_cell(self) -> Option<u32> {
        match self.cell() {
            CellKind::Tet4 => Some(6),
            CellKind::Hex8 => Some(1),
            CellKind::Point | CellKind::Line | CellKind::Triangle | CellKind::Quad => None,
        }
    }
}

/// Refuses a length that is not a positive number.
fn positive(name: &'static str, parameter: &'static str, value: f64) -> Result<(), MeshError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let allowed = "it must be a finite length above 0 m".to_string();
    Err(MeshError::Parameter { name, parameter, value: format!("{value}"), allowed })
}
