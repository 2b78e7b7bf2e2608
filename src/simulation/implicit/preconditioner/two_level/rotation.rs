//! How a group of nodes has turned.

use glam::DMat3;

/// A determinant below that share of the cube of the size is that of a line.
const SINGULAR: f64 = 1e-9;
/// Newton's iterations at most; some eight are enough.
const MOST_ITERATIONS: usize = 20;

/// The rotation R of A = R G, G symmetric and positive semi-definite, of A = Σ x⊗X over places and rest places about
/// their middles; none where that does not tell it. Newton's iteration for the polar factor, scaled (Higham 1986).
pub fn rotation(a: DMat3) -> Option<DMat3> {
    // the cofactors of R G are R times those of G, which stand across where all nodes are in a plane
    let mut x = a + cofactors(&a) * (1.0 / size(&a));
    let volume = x.determinant();
    if volume.is_nan() || volume <= SINGULAR * size(&x).powi(3) {
        return None;
    }
    for _ in 0..MOST_ITERATIONS {
        let other = x.inverse().transpose();
        let scale = (size(&other) / size(&x)).sqrt();
        let next = (x * scale + other * (1.0 / scale)) * 0.5;
        let change = size(&(next - x));
        x = next;
        if change < 1e-14 {
            break;
        }
    }
    x.is_finite().then_some(x)
}

fn size(a: &DMat3) -> f64 {
    (a.x_axis.length_squared() + a.y_axis.length_squared() + a.z_axis.length_squared()).sqrt()
}

fn cofactors(a: &DMat3) -> DMat3 {
    DMat3::from_cols(a.y_axis.cross(a.z_axis), a.z_axis.cross(a.x_axis), a.x_axis.cross(a.y_axis))
}

/// The angle of a rotation (rad).
pub fn angle(rotation: &DMat3) -> f64 {
    let trace = rotation.x_axis.x + rotation.y_axis.y + rotation.z_axis.z;
    (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests;
