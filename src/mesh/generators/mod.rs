//! Meshes made from a few numbers: one file a shape.
//!
//! All of them deform a grid of cells; a cell is one hexahedron or six tetrahedra. Points run along x fastest, then y,
//! then z; the elements of a cell follow each other.

mod r#box;
mod cylinder;
mod ellipsoid;
mod grid;
mod lens;
mod round;

pub use r#box::box_mesh;
pub use cylinder::cylinder_mesh;
pub use ellipsoid::ellipsoid_mesh;
pub use lens::lens_mesh;

use super::MeshError;
use serde::{Deserialize, Serialize};

/// Kinds of elements that generators make.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum ElementKind {
    /// Four-node tetrahedra, six a cell.
    #[default]
    Tet4,
    /// Eight-node hexahedra, one a cell.
    Hex8,
}

/// Refuses a length that is not a positive number.
fn positive(name: &'static str, parameter: &'static str, value: f64) -> Result<(), MeshError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let allowed = "it must be a finite length above 0 m".to_string();
    Err(MeshError::Parameter { name, parameter, value: format!("{value}"), allowed })
}
