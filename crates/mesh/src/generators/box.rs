//! A cuboid.

use super::grid::{Grid, SIDES};
use super::{ElementKind, positive};
use crate::{Mesh, MeshError};
use glam::DVec3;

/// A cuboid with one corner in the origin.
///
/// `size`: its edges (m); `cells`: cells along each of them. Sets of faces and nodes: `x0`, `x1`, `y0`, `y1`, `z0`,
/// `z1`.
pub fn box_mesh(size: DVec3, cells: (u32, u32, u32), elements: ElementKind) -> Result<Mesh, MeshError> {
    positive("Box", "size.x", size.x)?;
    positive("Box", "size.y", size.y)?;
    positive("Box", "size.z", size.z)?;
    let cells = [cells.0, cells.1, cells.2];
    let grid = Grid::new("Box", "cells", cells, elements)?;
    let share = |index: f64, axis: usize| size[axis] * (index / f64::from(cells[axis]));
    let mut mesh = grid.mesh(|index| DVec3::from_array([0, 1, 2].map(|axis| share(index[axis], axis))))?;
    for (name, side) in ["x0", "x1", "y0", "y1", "z0", "z1"].into_iter().zip(SIDES) {
        grid.name_faces(&mut mesh, name, &[side], |_| true);
    }
    Ok(mesh)
}
