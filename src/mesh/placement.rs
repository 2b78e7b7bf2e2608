//! Where a mesh stands in the scene.

use super::{Mesh, MeshError};
use glam::{DMat3, DVec3};

impl Mesh {
    /// Scales the mesh about the origin, turns it about the axes x, then y, then z through the origin
    /// (`rotate_degrees`), and moves it by `translate` (m). Vectors of elements turn with it.
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
        let turn = |angle: f64, about: fn(f64) -> DMat3| {
            if angle == 0.0 { DMat3::IDENTITY } else { about(angle.to_radians()) }
        };
        let turn = turn(rotate_degrees.z, DMat3::from_rotation_z)
            * turn(rotate_degrees.y, DMat3::from_rotation_y)
            * turn(rotate_degrees.x, DMat3::from_rotation_x);
        for point in &mut self.points {
            *point = turn * (scale * *point) + translate;
        }
        for vector in self.element_vectors.values_mut().flatten() {
            *vector = turn * *vector;
        }
        Ok(())
    }
}
