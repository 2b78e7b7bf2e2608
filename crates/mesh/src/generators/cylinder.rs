//! A cylinder.

use super::grid::{Grid, SIDES};
use super::round::{centred, disc};
use super::{ElementKind, positive};
use crate::{Mesh, MeshError};
use glam::{DVec2, DVec3};

/// A cylinder about the z axis that stands on z = 0.
///
/// `radius`, `height` (m); `across`: cells across the diameter, `along`: along the axis. Sets of faces and nodes:
/// `bottom`, `top`, `side`.
pub fn cylinder_mesh(
    radius: f64,
    height: f64,
    across: u32,
    along: u32,
    elements: ElementKind,
) -> Result<Mesh, MeshError> {
    positive("Cylinder", "radius", radius)?;
    positive("Cylinder", "height", height)?;
    let grid = Grid::new("Cylinder", "across×across×along", [across, across, along], elements)?;
    let grid = grid.outward([true, true, false]);
    let mut mesh = grid.mesh(|[i, j, k]| {
        let flat = radius * disc(DVec2::new(centred(i, across), centred(j, across)));
        flat.extend(height * (k / f64::from(along)))
    })?;
    let everywhere = |_: DVec3| true;
    grid.name_faces(&mut mesh, "bottom", &SIDES[4..5], everywhere);
    grid.name_faces(&mut mesh, "top", &SIDES[5..6], everywhere);
    grid.name_faces(&mut mesh, "side", &SIDES[0..4], everywhere);
    Ok(mesh)
}
