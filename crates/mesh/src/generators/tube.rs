//! A thick-walled tube, or a sector of one.

use super::grid::{Grid, SIDES};
use super::{ElementKind, positive};
use crate::{Mesh, MeshError};
use glam::DVec3;

/// A tube about the z axis that stands on z = 0, from the x axis on counter-clockwise.
///
/// `inner`, `outer` radius, `height` (m); `angle` (degrees, above 0, at most 360): 360 closes the ring; `cells`:
/// through the wall, around and along the axis. Sets of faces and nodes: `inner`, `outer`, `bottom`, `top`; of a sector
/// also `start` (in the plane y = 0) and `end`.
pub fn tube_mesh(
    inner: f64,
    outer: f64,
    height: f64,
    angle: f64,
    cells: (u32, u32, u32),
    elements: ElementKind,
) -> Result<Mesh, MeshError> {
    positive("Tube", "inner", inner)?;
    positive("Tube", "outer", outer)?;
    positive("Tube", "height", height)?;
    let refuse = |parameter, value, allowed| Err(MeshError::Parameter { name: "Tube", parameter, value, allowed });
    if outer <= inner {
        return refuse("outer", format!("{outer} m"), format!("it must be more than `inner`, {inner} m"));
    }
    if !(angle > 0.0 && angle <= 360.0) {
        return refuse("angle", format!("{angle}°"), "it must be above 0° and at most 360°".into());
    }
    let (through, around, along) = cells;
    let least = cells_around(angle);
    if around < least {
        let allowed = format!("an angle of {angle}° needs at least {least} cells around, or the wall is flat");
        return refuse("cells", format!("{through}×{around}×{along}"), allowed);
    }
    let closed = angle == 360.0;
    let grid = Grid::new("Tube", "cells", [through, around, along], elements)?;
    let grid = if closed { grid.ring() } else { grid };
    let mut mesh = grid.mesh(|[i, j, k]| {
        let radius = inner + (outer - inner) * (i / f64::from(through));
        let (x, y) = direction(angle * j / f64::from(around));
        DVec3::new(radius * x, radius * y, height * (k / f64::from(along)))
    })?;
    let names = ["inner", "outer", "start", "end", "bottom", "top"];
    for (name, side) in names.into_iter().zip(SIDES) {
        if !(closed && ["start", "end"].contains(&name)) {
            grid.name_faces(&mut mesh, name, &[side], |_| true);
        }
    }
    Ok(mesh)
}

/// The fewest cells around a tube: each turns by less than a half.
#[doc(hidden)]
pub fn cells_around(angle: f64) -> u32 {
    1 + (angle / 180.0).floor() as u32
}

/// The direction at an angle (degrees), with exact zeros on the axes: planes of symmetry stay planes.
fn direction(angle: f64) -> (f64, f64) {
    let (y, x) = angle.to_radians().sin_cos();
    let exact = |part: f64| if part.abs() < 1e-15 { 0.0 } else { part };
    (exact(x), exact(y))
}
