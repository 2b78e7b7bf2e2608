//! A block with eight corners of any place.

use super::ElementKind;
use super::grid::{Grid, SIDES};
use crate::{Mesh, MeshError};
use glam::DVec3;

/// The neighbours of each corner along the first, second and third edge direction, in VTK order of corners.
const NEIGHBOURS: [[usize; 3]; 8] =
    [[1, 3, 4], [0, 2, 5], [3, 1, 6], [2, 0, 7], [5, 7, 0], [4, 6, 1], [7, 5, 2], [6, 4, 3]];

/// A box mapped trilinearly onto eight corners: edges and lines of cells stay straight, faces may be twisted.
///
/// `corners` (m) in VTK order: four round the bottom, counter-clockwise seen from the top, then the four above them;
/// `cells`: along the edges 0–1, 0–3 and 0–4. Sets of faces and nodes: `x0`, `x1` where these edges begin and end, in
/// the same way `y0`, `y1`, `z0`, `z1`.
pub fn hexahedron_mesh(corners: [DVec3; 8], cells: (u32, u32, u32), elements: ElementKind) -> Result<Mesh, MeshError> {
    for (i, corner) in corners.into_iter().enumerate() {
        let refuse = |value: String, allowed: &str| {
            Err(MeshError::Parameter { name: "Hexahedron", parameter: CORNERS[i], value, allowed: allowed.into() })
        };
        if !corner.is_finite() {
            return refuse(format!("{corner}"), "it must be a finite position (m)");
        }
        if opening(&corners, i) <= 0.0 {
            return refuse(
                format!("({}, {}, {})", corner.x, corner.y, corner.z),
                "there the block is flat or inside out: four corners go round the bottom, counter-clockwise seen from \
                 the top, then the four above them",
            );
        }
    }
    let cells = [cells.0, cells.1, cells.2];
    let grid = Grid::new("Hexahedron", "cells", cells, elements)?;
    let mut mesh = grid.mesh(|index| {
        let [r, s, t] = [0, 1, 2].map(|axis| index[axis] / f64::from(cells[axis]));
        let quad = |a: usize| corners[a].lerp(corners[a + 1], r).lerp(corners[a + 3].lerp(corners[a + 2], r), s);
        quad(0).lerp(quad(4), t)
    })?;
    for (name, side) in ["x0", "x1", "y0", "y1", "z0", "z1"].into_iter().zip(SIDES) {
        grid.name_faces(&mut mesh, name, &[side], |_| true);
    }
    Ok(mesh)
}

const CORNERS: [&str; 8] =
    ["corners[0]", "corners[1]", "corners[2]", "corners[3]", "corners[4]", "corners[5]", "corners[6]", "corners[7]"];

/// Volume that the three edges at a corner span (m³), positive where the block is the right way round.
fn opening(corners: &[DVec3; 8], corner: usize) -> f64 {
    let [a, b, c] = NEIGHBOURS[corner].map(|other| corners[other] - corners[corner]);
    // an odd number of edges that run backwards mirrors the three
    let backwards = [1, 2, 5, 6].contains(&corner) as i32 + [2, 3, 6, 7].contains(&corner) as i32 + (corner > 3) as i32;
    a.dot(b.cross(c)) * if backwards % 2 == 0 { 1.0 } else { -1.0 }
}
