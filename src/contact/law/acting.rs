//! What acts on a node, by which its mass is split among its contacts.

use glam::{DVec3, Vec3Swizzles};

/// Σ |w| n nᵀ over the contacts of a node, w its weights there and n their normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Acting {
    /// xx, yy, zz.
    squares: DVec3,
    /// xy, yz, zx.
    products: DVec3,
}

impl Acting {
    /// Adds a contact, by its normal.
    #[inline(always)] // with the instructions of whoever asks
    pub fn add(&mut self, weight: f64, normal: DVec3) {
        let weighed = normal * weight.abs();
        self.squares += weighed * normal;
        self.products += weighed * normal.yzx();
    }

    /// Σ |w|.
    #[inline(always)] // likewise
    pub fn all(&self) -> f64 {
        self.squares.element_sum()
    }

    /// What all contacts come to along a vector v, at most: √(Σ |w| Σ |w| (v · n)²), never less than Σ |w (v · n)|.
    #[inline(always)] // likewise
    pub fn on(&self, vector: DVec3) -> f64 {
        let along = self.squares.dot(vector * vector) + 2.0 * self.products.dot(vector * vector.yzx());
        // rounding may leave a little less than nothing
        (self.all() * along).abs().sqrt()
    }
}
