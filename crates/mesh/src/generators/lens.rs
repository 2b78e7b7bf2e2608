//! A biconvex lens.

use super::grid::{Grid, SIDES};
use super::round::{blend, centred, disc};
use super::{ElementKind, positive};
use crate::{Mesh, MeshError};
use glam::DVec3;

/// Size of the inner cuboid against the lens's own half-axes, across and through.
const INNER: DVec3 = DVec3::new(0.6, 0.6, 0.75);

/// A biconvex lens about the origin, its axis along z: two spherical caps on a common circle in the plane z = 0.
///
/// `diameter` of the common circle, `thickness` on the axis (m); `across`: cells across the diameter, `through`:
/// through the thickness. The top and bottom of the grid become the middle of each cap, its four sides the band around
/// the rim, so that cells do not lose their thickness there. The sharp rim is met exactly when `through` is even; an
/// odd number leaves a blunt edge of one cell.
///
/// Sets of faces and nodes: `front` (faces of the cap z > 0), `back` (z < 0), `rim` (the band of the grid's sides, part
/// of both caps; with an odd `through` the blunt edge belongs to `rim` alone).
pub fn lens_mesh(
    diameter: f64,
    thickness: f64,
    across: u32,
    through: u32,
    elements: ElementKind,
) -> Result<Mesh, MeshError> {
    positive("Lens", "diameter", diameter)?;
    positive("Lens", "thickness", thickness)?;
    if thickness > diameter {
        let allowed = format!("it must be at most the diameter, {diameter} m: caps end at half spheres");
        let value = format!("{thickness} m");
        return Err(MeshError::Parameter { name: "Lens", parameter: "thickness", value, allowed });
    }
    let grid = Grid::new("Lens", "across×across×through", [across, across, through], elements)?.outward([true; 3]);
    let cap = Cap::new(diameter, thickness);
    // the caps are shared by `across` cells on top and `through` cells in the band
    let top = f64::from(across) / (f64::from(across) + f64::from(through));
    let inner = INNER * DVec3::new(diameter, diameter, thickness) / 2.0;
    let mut mesh = grid.mesh(|[i, j, k]| {
        let q = DVec3::new(centred(i, across), centred(j, across), centred(k, through));
        blend(q, inner, |q| cap.surface(q, top))
    })?;
    let size = thickness * 1e-9;
    grid.name_faces(&mut mesh, "front", &SIDES, |centre| centre.z > size);
    grid.name_faces(&mut mesh, "back", &SIDES, |centre| centre.z < -size);
    grid.name_faces(&mut mesh, "rim", &SIDES[0..4], |_| true);
    Ok(mesh)
}

/// A spherical cap on a circle in z = 0.
struct Cap {
    /// Radius of the sphere (m).
    sphere: f64,
    /// Height of its centre above z = 0 (m), below 0 for a flat cap.
    centre: f64,
    /// Angle between the axis and the rim, seen from the centre (rad).
    opening: f64,
}

impl Cap {
    fn new(diameter: f64, thickness: f64) -> Self {
        let (circle, height) = (diameter / 2.0, thickness / 2.0);
        let sphere = (circle * (circle / height) + height) / 2.0;
        Cap { sphere, centre: height - sphere, opening: 2.0 * (height / circle).atan() }
    }

    /// From the cube's surface to the lens's; `top` is the share of the arc from axis to rim that the cube's top takes.
    fn surface(&self, q: DVec3, top: f64) -> DVec3 {
        let flat = disc(q.truncate());
        let share = if q.z.abs() < 1.0 { 1.0 - (1.0 - top) * q.z.abs() } else { top * flat.length() };
        let (sin, cos) = (share * self.opening).sin_cos();
        let height = if share < 1.0 { (self.centre + self.sphere * cos).max(0.0) } else { 0.0 };
        (self.sphere * sin * flat.normalize_or_zero()).extend(height.copysign(q.z))
    }
}
