//! The four-node tetrahedron.

use super::{Element, MOST_NODES, MOST_ROWS, Stiffness, gradient_measure, vector};
use crate::math::{Mat3, Real, dot};
use glam::{DMat3, DVec3};

/// Linear tetrahedron: one constant gradient. It locks near incompressibility (a bar under gravity at ν = 0.49 with
/// 20×4×4 cells is 46 % too stiff). Its WGSL twin is `shaders/tet4.wgsl`.
///
/// Rest shape: gradients of nodes 1 to 3 (rows 0 to 8; node 0 has their negative sum), volume (row 9).
#[derive(Clone, Copy, Debug)]
pub struct Tet4;

impl Element for Tet4 {
    const NAME: &'static str = "tet4";
    const NODES: usize = 4;
    const ROWS: usize = 10;
    const VOLUME_ROW: usize = 9;
    const HOURGLASS_ROW: Option<usize> = None;

    fn rest_shape(points: &[DVec3], _young: f64) -> [f64; MOST_ROWS] {
        let edges = DMat3::from_cols(points[1] - points[0], points[2] - points[0], points[3] - points[0]);
        // rows of the inverse are the gradients
        let gradients = edges.inverse().transpose();
        let mut shape = [0.0; MOST_ROWS];
        shape[..9].copy_from_slice(&gradients.to_cols_array());
        shape[9] = edges.determinant() / 6.0;
        shape
    }

    #[inline(always)]
    fn gradient<R: Real>(u: &[[R; 3]; MOST_NODES], shape: impl Fn(usize) -> R) -> Mat3<R> {
        let mut h = Mat3::zero(u[0][0]);
        for i in 0..3 {
            for a in 0..3 {
                h.add_to_row(i, u[a + 1][i] - u[0][i], vector(&shape, 3 * a));
            }
        }
        h
    }

    #[inline(always)]
    fn forces<R: Real>(
        u: &[[R; 3]; MOST_NODES],
        _gradient: &Mat3<R>,
        stress: &Mat3<R>,
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let stress = stress.scaled(shape(9));
        for i in 0..3 {
            let mut sum = u[0][0].constant(0.0);
            for a in 0..3 {
                let force = dot(stress.0[i], vector(&shape, 3 * a));
                sum += force;
                store(a + 1, i, force);
            }
            store(0, i, -sum);
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &[[R; 3]; MOST_NODES], _: &Mat3<R>, _: impl Fn(usize) -> R) -> R {
        u[0][0].constant(0.0)
    }

    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let g = |a: usize| DVec3::from_slice(&shape[3 * a..]);
        let (trace, largest) = gradient_measure([g(0), g(1), g(2), -(g(0) + g(1) + g(2))].into_iter());
        4.0 / stiffness.density * (stiffness.lambda * trace + stiffness.deviatoric * largest)
    }
}
