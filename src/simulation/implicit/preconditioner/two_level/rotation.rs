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
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn turned_nodes_tell_their_rotation_in_space_and_in_a_plane_but_not_on_a_line() {
        for turn in [0.0, 0.02, 1.0, 3.1] {
            let exact = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.48, 0.6, -0.64), turn));
            for flat in [1.0, 0.0] {
                let place = |i: usize| {
                    let i = i as f64;
                    DVec3::new((3.0 * i).sin(), (5.0 * i).cos(), flat * (7.0 * i).sin()) * 1e-3
                };
                let a = (0..20).fold(DMat3::ZERO, |a, i| {
                    let (rest, x) = (place(i), exact * place(i));
                    a + DMat3::from_cols(x * rest.x, x * rest.y, x * rest.z)
                });
                let found = rotation(a).unwrap();
                assert!(size(&(found - exact)) < 1e-11, "{turn}, {flat}: {found}");
                assert!((angle(&found) - turn).abs() < 1e-7);
            }
        }
        let line = DVec3::new(1e-3, 2e-3, 0.0);
        assert!(rotation(DMat3::from_cols(line * line.x, line * line.y, line * line.z)).is_none());
        assert!(rotation(DMat3::ZERO).is_none());
    }
}
