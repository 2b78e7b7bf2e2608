//! A plane that cuts bodies open.

use glam::{DVec3, Vec3};
use sinew::scene::schema::Cut;

/// What lies beyond is taken away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Points beyond, of length 1.
    pub normal: Vec3,
    /// Where it stands along its normal (m); as a double, so that no digits go where the origin is far.
    at: f64,
    /// Points so near (m) are taken to lie on it.
    near: f64,
}

impl Plane {
    /// A plane that cuts what is `size` (m) large; its normal must have a direction.
    pub fn new(cut: &Cut, size: f32) -> Plane {
        let normal = cut.normal.normalize_or_zero();
        Plane { normal: normal.as_vec3(), at: normal.dot(cut.point), near: 1e-6 * f64::from(size) }
    }

    /// How far a point lies beyond (m).
    pub fn beyond(&self, point: Vec3) -> f32 {
        let beyond = DVec3::from(self.normal).dot(DVec3::from(point)) - self.at;
        if beyond.abs() < self.near { 0.0 } else { beyond as f32 }
    }
}
