//! Where a mesh stands in the scene.

use super::{Mesh, MeshError};
use glam::{DMat3, DVec3};

impl Mesh {
    /// Scales the mesh about the origin, turns it about the axes x, then y, then z through the origin
    /// (`rotate_degrees`), and moves it by `translate` (m). Vectors of elements turn with it.
    #[doc(hidden)]
    pub fn place(&mut self, scale: f64, rotate_degrees: DVec3, translate: DVec3) -> Result<(), MeshError> {
        let refuse = |parameter, value, allowed: &str| {
            Err(MeshError::Parameter { name: "place", parameter, value, allowed: allowed.into() })
        };
        if !(scale > 0.0 && scale.is_finite()) {
            return refuse("scale", format!("{scale}"), "it must be a finite number above 0");
        }
        if !rotate_degrees.is_finite() {
            return refuse("rotate", format!("{rotate_degrees}"), "angles must be finite (degrees)");
        }
        if !translate.is_finite() {
            return refuse("translate", format!("{translate}"), "it must be finite (m)");
        }
        let turn = rotation_about_axes(rotate_degrees);
        for point in &mut self.points {
            *point = turn * (scale * *point) + translate;
        }
        for vector in self.element_vectors.values_mut().flatten() {
            *vector = turn * *vector;
        }
        Ok(())
    }
}

/// The rotation about the axes x, then y, then z through the origin (degrees).
#[doc(hidden)]
pub fn rotation_about_axes(degrees: DVec3) -> DMat3 {
    let turn = |angle: f64, about: fn(f64) -> DMat3| {
        if angle == 0.0 { DMat3::IDENTITY } else { about(angle.to_radians()) }
    };
    turn(degrees.z, DMat3::from_rotation_z)
        * turn(degrees.y, DMat3::from_rotation_y)
        * turn(degrees.x, DMat3::from_rotation_x)
}

/// The angles (degrees) of which [`rotation_about_axes`] makes a rotation. Where that about y is 90 degrees, those
/// about x and z are not the only ones that do.
#[doc(hidden)]
pub fn angles_about_axes(turn: DMat3) -> DVec3 {
    let at = |row: usize, column: usize| turn.col(column)[row];
    let z = at(1, 0).atan2(at(0, 0));
    let (sine, cosine) = z.sin_cos();
    let y = (-at(2, 0)).atan2(cosine * at(0, 0) + sine * at(1, 0));
    // as R_z R_y have been taken away, also where the last row says nothing of it
    let x = (sine * at(0, 2) - cosine * at(1, 2)).atan2(cosine * at(1, 1) - sine * at(0, 1));
    DVec3::new(x.to_degrees(), y.to_degrees(), z.to_degrees())
}

#[cfg(test)]
mod tests;
