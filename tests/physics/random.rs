//! Reproducible random numbers and tensors.

use glam::{DMat3, DVec3};
use sinew::math::{Mat3, Scalar};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    /// Uniform in [−1, 1).
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    pub fn matrix(&mut self) -> DMat3 {
        DMat3::from_cols(self.vector(), self.vector(), self.vector())
    }

    pub fn rotation(&mut self) -> DMat3 {
        DMat3::from_axis_angle((self.vector() + 1e-3).normalize(), 3.0 * self.number())
    }

    /// A deformation gradient with J in [.5, 2].
    pub fn deformation(&mut self) -> DMat3 {
        loop {
            let f = DMat3::IDENTITY + self.matrix() * 0.6;
            if (0.5..2.0).contains(&f.determinant()) {
                return f;
            }
        }
    }

    /// A permutation of 0 to `count` − 1.
    pub fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, ((self.number() + 1.0) / 2.0 * (i + 1) as f64) as usize);
        }
        order
    }
}

/// F − I as the engine takes it.
pub fn gradient<T: Scalar>(f: DMat3) -> Mat3<T> {
    let h = f - DMat3::IDENTITY;
    Mat3([0, 1, 2].map(|i| h.row(i).to_array().map(T::from_f64)))
}

/// A matrix as RON rows.
pub fn rows(m: DMat3) -> String {
    let row = |i: usize| format!("({:?}, {:?}, {:?})", m.row(i).x, m.row(i).y, m.row(i).z);
    format!("({}, {}, {})", row(0), row(1), row(2))
}
