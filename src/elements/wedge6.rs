//! The six-node wedge with mean dilatation.

use super::hex8_mean_dilatation::largest_eigenvalue_bound;
use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, gradient_measure, vector};
use crate::math::{Mat3, Real, dot, minor};
use crate::mesh::CellKind;
use crate::mesh::topology::wedge6::volume;
use glam::{DMat3, DVec3};

/// Triangular prism, linear in the triangle and along the axis, with three points in the triangle at two heights for
/// what changes shape, and one pressure from its mean volume as in
/// [`Hex8MeanDilatation`](super::Hex8MeanDilatation). One point a height would do for the volume, but feels no twist
/// about the axis: with six no mode is without energy. Its WGSL twin is `shaders/wedge6.wgsl`.
///
/// Energy V U(θ̄) + Σ_q V_q Ψ_iso(F_q), θ̄ = Σ V_q θ_q / V; forces are its exact derivative. Positions and
/// displacements are kept as coefficients of r, s, ζ, rζ, sζ, so that a common displacement never enters. Rest shape:
/// those of X (m, rows 0 to 14), volume (15), 1 while the element is there (16).
#[derive(Clone, Copy, Debug)]
pub struct Wedge6;

/// Coefficients of a component: r, s, ζ, rζ, sζ.
const MODES: usize = 5;
/// 1/√3, where Gauss points along the axis are.
const GAUSS: f64 = 0.577_350_269_189_625_8;
/// Weight of a point: a third of the triangle's area.
const WEIGHT: f64 = 1.0 / 6.0;
const THERE_ROW: usize = 16;

/// Natural coordinates of a point.
const fn natural(point: usize) -> [f64; 3] {
    let place = [[1.0 / 6.0, 1.0 / 6.0], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]][point % 3];
    [place[0], place[1], if point < 3 { -GAUSS } else { GAUSS }]
}

/// Coefficients of one component from its nodal values: of differences along edges.
#[inline(always)]
fn coefficients<R: Real>(u: &[[R; 3]; MOST_NODES], i: usize) -> [R; MODES] {
    let half = u[0][i].constant(0.5);
    let (r_below, r_above) = (u[1][i] - u[0][i], u[4][i] - u[3][i]);
    let (s_below, s_above) = (u[2][i] - u[0][i], u[5][i] - u[3][i]);
    [
        (r_above + r_below) * half,
        (s_above + s_below) * half,
        (u[3][i] - u[0][i]) * half,
        (r_above - r_below) * half,
        (s_above - s_below) * half,
    ]
}

/// ∂/∂(r, s, ζ) at a point of a component with these coefficients.
#[inline(always)]
fn natural_gradient<R: Real>(c: [R; MODES], point: usize) -> [R; 3] {
    let [r, s, z] = natural(point).map(|at| c[0].constant(at));
    [z.mul_add(c[3], c[0]), z.mul_add(c[4], c[1]), r.mul_add(c[3], s.mul_add(c[4], c[2]))]
}

impl Element for Wedge6 {
    const NAME: &'static str = "wedge6";
    const CELL: CellKind = CellKind::Wedge6;
    const POINTS: usize = 6;
    const ROWS: usize = 17;
    const VOLUME_ROW: usize = 15;
    const FORCE_ROW: Option<usize> = Some(THERE_ROW);
    const PRESSURE: PressureFrom = PressureFrom::MeanOverPoints;
    const ELEMENTS_A_PATCH: usize = 448;

    type Specialisation = Self;
    /// Coefficients of each component.
    type Prepared<R: Real> = [[R; MODES]; 3];
    /// Forces on the coefficients of each component.
    type Forces<R: Real> = [[R; MODES]; 3];

    fn rest_shape(points: &[DVec3], _young: f64) -> [f64; MOST_ROWS] {
        let corners: [DVec3; 6] = std::array::from_fn(|a| points[a]);
        let mut from_first = [[0.0; 3]; MOST_NODES];
        for a in 0..6 {
            from_first[a] = (corners[a] - corners[0]).to_array();
        }
        let mut shape = [0.0; MOST_ROWS];
        for i in 0..3 {
            for (m, c) in coefficients(&from_first, i).into_iter().enumerate() {
                shape[3 * m + i] = c;
            }
        }
        shape[Self::VOLUME_ROW] = volume(corners);
        shape[THERE_ROW] = 1.0;
        shape
    }

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> [[R; MODES]; 3] {
        [coefficients(u, 0), coefficients(u, 1), coefficients(u, 2)]
    }

    #[inline(always)]
    fn at_point<R: Real>(u: &[[R; MODES]; 3], point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        // rows: ∂X_i/∂ξ
        let mut jacobian = [vector(&shape, 0); 3];
        for i in 0..3 {
            let mut c = [shape(i); MODES];
            for m in 1..MODES {
                c[m] = shape(3 * m + i);
            }
            jacobian[i] = natural_gradient(c, point);
        }
        let [a, b, c] = jacobian;
        let adjugate = Mat3([
            [minor(b[1], b[2], c[1], c[2]), minor(a[2], a[1], c[2], c[1]), minor(a[1], a[2], b[1], b[2])],
            [minor(b[2], b[0], c[2], c[0]), minor(a[0], a[2], c[0], c[2]), minor(a[2], a[0], b[2], b[0])],
            [minor(b[0], b[1], c[0], c[1]), minor(a[1], a[0], c[1], c[0]), minor(a[0], a[1], b[0], b[1])],
        ]);
        let determinant = dot(a, [adjugate.0[0][0], adjugate.0[1][0], adjugate.0[2][0]]);
        let inverse = determinant.constant(1.0) / determinant;
        let mut gradient = Mat3::zero(determinant);
        for i in 0..3 {
            let natural = natural_gradient(u[i], point);
            for k in 0..3 {
                gradient.add_to_row(i, natural[k] * inverse, adjugate.0[k]);
            }
        }
        PointState { gradient, adjugate, volume: determinant * determinant.constant(WEIGHT) }
    }

    #[inline(always)]
    fn no_forces<R: Real>(like: R) -> [[R; MODES]; 3] {
        [[like.constant(0.0); MODES]; 3]
    }

    #[inline(always)]
    fn add_stress<R: Real>(forces: &mut [[R; MODES]; 3], point: usize, at: &PointState<R>, stress: &Mat3<R>) {
        for i in 0..3 {
            // on ∂u_i/∂ξ_k, but for the weight: det(∂X/∂ξ) P_ij ∂ξ_k/∂X_j
            let f = [
                dot(stress.0[i], at.adjugate.0[0]),
                dot(stress.0[i], at.adjugate.0[1]),
                dot(stress.0[i], at.adjugate.0[2]),
            ];
            let [r, s, z] = natural(point).map(|at| f[0].constant(at));
            let sums = &mut forces[i];
            sums[0] += f[0];
            sums[1] += f[1];
            sums[2] += f[2];
            sums[3] = z.mul_add(f[0], r.mul_add(f[2], sums[3]));
            sums[4] = z.mul_add(f[1], s.mul_add(f[2], sums[4]));
        }
    }

    #[inline(always)]
    fn store_forces<R: Real>(
        u: &[[R; MODES]; 3],
        forces: &[[R; MODES]; 3],
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let share = shape(THERE_ROW) * u[0][0].constant(0.5 * WEIGHT);
        for i in 0..3 {
            let [r, s, z, rz, sz] = forces[i];
            let (r_below, r_above) = ((r - rz) * share, (r + rz) * share);
            let (s_below, s_above) = ((s - sz) * share, (s + sz) * share);
            let above = z * share - r_above - s_above;
            store(1, i, r_below);
            store(2, i, s_below);
            store(3, i, above);
            store(4, i, r_above);
            store(5, i, s_above);
            // forces that rounding keeps from adding up to nothing would push the whole
            store(0, i, -((r_below + s_below) + (above + (r_above + s_above))));
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &[[R; MODES]; 3], _: &Mat3<R>, _: impl Fn(usize) -> R) -> R {
        u[0][0].constant(0.0)
    }

    /// As in [`Hex8MeanDilatation`](super::Hex8MeanDilatation), with six nodes: with b the mean gradients and
    /// L_ab = Σ_q V_q ∇N_a·∇N_b, ω² ≤ (6/ρ)(λ Σ b·b + 2μ' λ_max(L)/V).
    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let c: [DVec3; MODES] = std::array::from_fn(|m| DVec3::from_slice(&shape[3 * m..]));
        let mut mean = [DVec3::ZERO; 6];
        let (mut volume, mut laplacian) = (0.0, [[0.0; 6]; 6]);
        for point in 0..Self::POINTS {
            let [r, s, z] = natural(point);
            let jacobian = DMat3::from_cols(c[0] + z * c[3], c[1] + z * c[4], c[2] + r * c[3] + s * c[4]);
            let (weight, inverse) = (jacobian.determinant() * WEIGHT, jacobian.inverse().transpose());
            let in_triangle = [(1.0 - r - s, -1.0, -1.0), (r, 1.0, 0.0), (s, 0.0, 1.0)];
            let gradients: [DVec3; 6] = std::array::from_fn(|a| {
                let ((value, by_r, by_s), end) = (in_triangle[a % 3], if a < 3 { -1.0 } else { 1.0 });
                let along = (1.0 + end * z) / 2.0;
                inverse * DVec3::new(by_r * along, by_s * along, value * end / 2.0)
            });
            volume += weight;
            for a in 0..6 {
                mean[a] += weight * gradients[a];
                for b in 0..6 {
                    laplacian[a][b] += weight * gradients[a].dot(gradients[b]);
                }
            }
        }
        let (trace, _) = gradient_measure(mean.into_iter().map(|b| b / volume));
        let largest = largest_eigenvalue_bound(laplacian) / volume;
        Self::NODES_OF_LEAST_MASS / stiffness.density * (stiffness.lambda * trace + stiffness.deviatoric() * largest)
    }
}
