//! An ellipsoid.

use super::grid::{Grid, SIDES};
use super::round::{ball, centred};
use super::{ElementKind, positive};
use crate::{Mesh, MeshError};
use glam::DVec3;

/// An ellipsoid about the origin.
///
/// `radii`: half-axes (m); `across`: cells across each axis. Set of faces and nodes: `surface`.
pub fn ellipsoid_mesh(radii: DVec3, across: u32, elements: ElementKind) -> Result<Mesh, MeshError> {
    positive("Ellipsoid", "radii.x", radii.x)?;
    positive("Ellipsoid", "radii.y", radii.y)?;
    positive("Ellipsoid", "radii.z", radii.z)?;
    let grid = Grid::new("Ellipsoid", "across×across×across", [across; 3], elements)?.outward([true; 3]);
    let mut mesh = grid.mesh(|index| radii * ball(DVec3::from_array(index.map(|i| centred(i, across)))))?;
    grid.name_faces(&mut mesh, "surface", &SIDES, |_| true);
    Ok(mesh)
}
