//! The four-node tetrahedron.

use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, gradient_measure, vector};
use crate::math::{Mat3, Real, dot};
use crate::mesh::CellKind;
use glam::{DMat3, DVec3};

/// Linear tetrahedron: one constant gradient. It locks near incompressibility (a bar under gravity at ν = 0.49 with
/// 20×4×4 cells is 46 % too stiff): see [`Tet4NodalPressure`](super::Tet4NodalPressure). Its WGSL twin is
/// `shaders/tet4.wgsl`.
///
/// Rest shape: gradients of nodes 1 to 3 (rows 0 to 8; node 0 has their negative sum), volume (row 9).
#[derive(Clone, Copy, Debug)]
pub struct Tet4;

impl Element for Tet4 {
    const NAME: &'static str = "tet4";
    const CELL: CellKind = CellKind::Tet4;
    const POINTS: usize = 1;
    const ROWS: usize = 10;
    const VOLUME_ROW: usize = 9;
    const FORCE_ROW: Option<usize> = None;
    const PRESSURE: PressureFrom = PressureFrom::Point;
    const ELEMENTS_A_PATCH: usize = 1024;
    const SPECIALISED: bool = true;

    fn rest_shape(points: &[DVec3], _young: f64) -> [f64; MOST_ROWS] {
        let edges = DMat3::from_cols(points[1] - points[0], points[2] - points[0], points[3] - points[0]);
        // rows of the inverse are the gradients
        let gradients = edges.inverse().transpose();
        let mut shape = [0.0; MOST_ROWS];
        shape[..9].copy_from_slice(&gradients.to_cols_array());
        shape[9] = edges.determinant() / 6.0;
        shape
    }

    fn frame(points: &[DVec3]) -> Option<[DVec3; 2]> {
        Some([points[1] - points[0], points[2] - points[0]])
    }

    type Specialisation = Self;
    type Prepared<R: Real> = [[R; 3]; 3];
    type Forces<R: Real> = Mat3<R>;

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> [[R; 3]; 3] {
        let mut edges = [u[0]; 3];
        for a in 0..3 {
            for i in 0..3 {
                edges[a][i] = u[a + 1][i] - u[0][i];
            }
        }
        edges
    }

    #[inline(always)]
    fn at_point<R: Real>(edges: &[[R; 3]; 3], _point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        let mut gradient = Mat3::zero(edges[0][0]);
        for i in 0..3 {
            for a in 0..3 {
                gradient.add_to_row(i, edges[a][i], vector(&shape, 3 * a));
            }
        }
        PointState { gradient, adjugate: gradient, volume: shape(Self::VOLUME_ROW) }
    }

    #[inline(always)]
    fn no_forces<R: Real>(like: R) -> Mat3<R> {
        Mat3::zero(like)
    }

    #[inline(always)]
    fn add_stress<R: Real>(forces: &mut Mat3<R>, _point: usize, _at: &PointState<R>, stress: &Mat3<R>) {
        *forces = *stress;
    }

    #[inline(always)]
    fn store_forces<R: Real>(
        edges: &[[R; 3]; 3],
        forces: &Mat3<R>,
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let stress = forces.scaled(shape(Self::VOLUME_ROW));
        for i in 0..3 {
            let mut sum = edges[0][0].constant(0.0);
            for a in 0..3 {
                let force = dot(stress.0[i], vector(&shape, 3 * a));
                sum += force;
                store(a + 1, i, force);
            }
            store(0, i, -sum);
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(edges: &[[R; 3]; 3], _: &Mat3<R>, _: impl Fn(usize) -> R) -> R {
        edges[0][0].constant(0.0)
    }

    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let g = |a: usize| DVec3::from_slice(&shape[3 * a..]);
        let (trace, largest) = gradient_measure([g(0), g(1), g(2), -(g(0) + g(1) + g(2))].into_iter());
        Self::NODES_OF_LEAST_MASS / stiffness.density * (stiffness.lambda * trace + stiffness.deviatoric() * largest)
    }
}
