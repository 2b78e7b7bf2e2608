//! Deformations to try a law with: the same ones every time.

use crate::math::Mat3;

/// Sizes of ∇u, from the smallest strains to far beyond what most tissue bears.
const SIZES: [f64; 7] = [1e-3, 3e-3, 0.01, 0.03, 0.1, 0.25, 0.5];
/// Random deformations of each size.
const OF_EACH: usize = 8;

/// A displacement gradient and its size.
pub(super) struct Deformation {
    pub(super) size: f64,
    pub(super) gradient: Mat3<f64>,
    /// Whether it is a change of volume or a rotation alone: isochoric strains are then what rounding makes of 0.
    pub(super) plain: bool,
}

/// All of them, the small ones first.
pub(super) fn all() -> Vec<Deformation> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        // splitmix64
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
    };
    let mut deformations = Vec::new();
    for size in SIZES {
        let mut found = 0;
        while found < OF_EACH {
            let gradient = Mat3(std::array::from_fn(|_| std::array::from_fn(|_| size * random())));
            // a mirrored or flattened element is the guard's concern, not the law's
            if determinant(&gradient) > 0.4 {
                deformations.push(Deformation { size, gradient, plain: false });
                found += 1;
            }
        }
        for stretch in [0.5 * size, -0.5 * size] {
            let gradient = Mat3([[stretch, 0.0, 0.0], [0.0, stretch, 0.0], [0.0, 0.0, stretch]]);
            deformations.push(Deformation { size, gradient, plain: true });
        }
        deformations.push(Deformation { size, gradient: rotation(size), plain: true });
    }
    deformations
}

/// R − I of a rotation by an angle (rad) about the axis (2, −1, 2)/3.
fn rotation(angle: f64) -> Mat3<f64> {
    let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    // 1 − cos, which keeps the digits of a small angle
    let (sine, versine) = (angle.sin(), 2.0 * (0.5 * angle).sin().powi(2));
    let cross = [[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]];
    Mat3(std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let along = axis[i] * axis[j] - if i == j { 1.0 } else { 0.0 };
            sine * cross[i][j] + versine * along
        })
    }))
}

/// det(I + ∇u).
fn determinant(gradient: &Mat3<f64>) -> f64 {
    let h = gradient.0;
    let f = |i: usize, j: usize| h[i][j] + if i == j { 1.0 } else { 0.0 };
    let minor = |a: usize, b: usize| f(1, a) * f(2, b) - f(1, b) * f(2, a);
    f(0, 0) * minor(1, 2) - f(0, 1) * minor(0, 2) + f(0, 2) * minor(0, 1)
}

/// ∇u as a message shows it.
pub(super) fn shown(gradient: &Mat3<f64>) -> String {
    let row = |row: &[f64; 3]| row.map(|x| format!("{x:.3}")).join(", ");
    format!("∇u = [{}]", gradient.0.iter().map(row).collect::<Vec<_>>().join("; "))
}
