//! The ten-node tetrahedron with mean dilatation.

use super::hex8_mean_dilatation::largest_eigenvalue_bound;
use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, vector};
use crate::math::{Mat3, Real, dot, minor};
use crate::mesh::CellKind;
use crate::mesh::topology::tet10::{FAR, NEAR, POINTS, shape as shape_at};
use glam::{DMat3, DVec3};

/// Tetrahedron of second order, its edges straight or parabolas, with four points for what changes shape, and one
/// pressure from its mean volume as in [`Hex8MeanDilatation`](super::Hex8MeanDilatation): it bends, and does not lock
/// as ν → ½. Its WGSL twin is `shaders/tet10.wgsl`.
///
/// Energy V U(θ̄) + Σ_q V_q Ψ_iso(F_q) + ½ k Σ_q V_q (J_q − J̄)², θ̄ = Σ V_q θ_q / V; forces are its exact derivative.
/// By one pressure alone three modes that swell one end and shrink the other, without change of shape, had no energy,
/// and a single layer bent half as far again as it should; with k = ⅔ μ they have one, and the stable step is as
/// without.
///
/// With barycentric coordinates L a field is u₀ + Σ_k L_k e_k + Σ_ab 4 L_a L_b d_ab: the differences e_k = u_k − u₀ to
/// the other three corners, and at each edge the deviation d_ab of its middle from halfway, so that a common
/// displacement never enters. Rest shape: e and d of X (m, rows 0 to 26), volume (27), 1 while the element is there
/// (28), k (Pa, 29).
#[derive(Clone, Copy, Debug)]
pub struct Tet10;

/// Coefficients of a component: three differences, then six deviations in the order of [`EDGES`].
const MODES: usize = 9;
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
/// Weight of a point: a quarter of the reference volume.
const WEIGHT: f64 = 1.0 / 24.0;
const THERE_ROW: usize = 28;
const STIFFNESS_ROW: usize = 29;
/// k over Young's modulus: ⅔ μ as ν → ½, and less below, for μ = E/(2 (1 + ν)).
const STIFFNESS: f64 = 2.0 / 9.0;

/// ∂L_a/∂L_k for k = 1 to 3, with L₀ = 1 − L₁ − L₂ − L₃.
const fn slope(corner: usize, k: usize) -> f64 {
    if corner == 0 {
        -1.0
    } else if corner == k + 1 {
        1.0
    } else {
        0.0
    }
}

/// ∂(4 L_a L_b)/∂L_k of each edge at each point, then in the middle.
const SLOPES: [[[f64; 6]; 3]; 5] = {
    let mut slopes = [[[0.0; 6]; 3]; 5];
    let mut place = 0;
    while place < 5 * 3 * 6 {
        let (point, k, edge) = (place / 18, place / 6 % 3, place % 6);
        let mut share = if point < 4 { [NEAR; 4] } else { [0.25; 4] };
        if point < 4 {
            share[point] = FAR;
        }
        let [a, b] = EDGES[edge];
        slopes[point][k][edge] = 4.0 * (share[a] * slope(b, k) + share[b] * slope(a, k));
        place += 1;
    }
    slopes
};

/// Coefficients of one component from its nodal values: of differences along edges.
#[inline(always)]
fn coefficients<R: Real>(u: &[[R; 3]; MOST_NODES], i: usize) -> [R; MODES] {
    let half = u[0][i].constant(0.5);
    let mut c = [u[1][i] - u[0][i], u[2][i] - u[0][i], u[3][i] - u[0][i], half, half, half, half, half, half];
    for (edge, [a, b]) in EDGES.into_iter().enumerate() {
        c[3 + edge] = ((u[4 + edge][i] - u[a][i]) + (u[4 + edge][i] - u[b][i])) * half;
    }
    c
}

/// ∂/∂(L₁, L₂, L₃) at a point of a component with these coefficients.
#[inline(always)]
fn natural_gradient<R: Real>(c: &[R; MODES], point: usize) -> [R; 3] {
    let mut by = [c[0], c[1], c[2]];
    for k in 0..3 {
        for edge in 0..6 {
            by[k] = c[3 + edge].mul_add(by[k].constant(SLOPES[point][k][edge]), by[k]);
        }
    }
    by
}

/// The points, and what J of each is beside the mean J̄ = Σ V_q J_q / V.
#[inline(always)]
fn volume_deviations<R: Real>(u: &[[R; MODES]; 3], shape: &impl Fn(usize) -> R) -> [(PointState<R>, R); Tet10::POINTS] {
    let first = Tet10::at_point(u, 0, shape);
    let change = first.gradient.volume_change();
    let mut points = [(first, change); Tet10::POINTS];
    let (mut volume, mut sum) = (first.volume, first.volume * change);
    for point in 1..Tet10::POINTS {
        let state = Tet10::at_point(u, point, shape);
        let change = state.gradient.volume_change();
        points[point] = (state, change);
        volume += state.volume;
        sum = state.volume.mul_add(change, sum);
    }
    let mean = sum / volume;
    for point in 0..Tet10::POINTS {
        points[point].1 -= mean;
    }
    points
}

impl Element for Tet10 {
    const NAME: &'static str = "tet10";
    const CELL: CellKind = CellKind::Tet10;
    const POINTS: usize = 4;
    /// The middle, too, which has the mean gradient: a face can be pulled through the opposite corner while J stays
    /// above 0 at all four.
    const CHECKED_POINTS: usize = 5;
    const ROWS: usize = 30;
    const VOLUME_ROW: usize = 27;
    const FORCE_ROW: Option<usize> = Some(THERE_ROW);
    /// Seen in static analyses: up to 7.7 times the estimate, where other elements leave 4.3.
    const ROUNDING: f64 = 7.7 / 4.3;
    const PRESSURE: PressureFrom = PressureFrom::MeanOverPoints;

    type Specialisation = Self;
    /// Coefficients of each component.
    type Prepared<R: Real> = [[R; MODES]; 3];
    /// Forces on the coefficients of each component.
    type Forces<R: Real> = [[R; MODES]; 3];

    fn rest_shape(points: &[DVec3], young: f64) -> [f64; MOST_ROWS] {
        let mut from_first = [[0.0; 3]; MOST_NODES];
        for a in 0..10 {
            from_first[a] = (points[a] - points[0]).to_array();
        }
        let mut shape = [0.0; MOST_ROWS];
        for i in 0..3 {
            for (m, c) in coefficients(&from_first, i).into_iter().enumerate() {
                shape[3 * m + i] = c;
            }
        }
        // that of the points, so that energy and forces agree where edges are curved
        shape[Self::VOLUME_ROW] =
            POINTS.into_iter().map(|at| WEIGHT * shape_at(at).jacobian(points).determinant()).sum();
        shape[THERE_ROW] = 1.0;
        shape[STIFFNESS_ROW] = STIFFNESS * young;
        shape
    }

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> [[R; MODES]; 3] {
        [coefficients(u, 0), coefficients(u, 1), coefficients(u, 2)]
    }

    #[inline(always)]
    fn at_point<R: Real>(u: &[[R; MODES]; 3], point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        // rows: ∂X_i/∂L
        let mut jacobian = [vector(&shape, 0); 3];
        for i in 0..3 {
            let mut c = [shape(i); MODES];
            for m in 1..MODES {
                c[m] = shape(3 * m + i);
            }
            jacobian[i] = natural_gradient(&c, point);
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
            let natural = natural_gradient(&u[i], point);
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
            for k in 0..3 {
                // on ∂u_i/∂L_k, but for the weight: det(∂X/∂L) P_ij ∂L_k/∂X_j
                let f = dot(stress.0[i], at.adjugate.0[k]);
                let sums = &mut forces[i];
                sums[k] += f;
                for edge in 0..6 {
                    sums[3 + edge] = f.mul_add(f.constant(SLOPES[point][k][edge]), sums[3 + edge]);
                }
            }
        }
    }

    #[inline(always)]
    fn store_forces<R: Real>(
        u: &[[R; MODES]; 3],
        forces: &[[R; MODES]; 3],
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let share = shape(THERE_ROW) * u[0][0].constant(WEIGHT);
        let half = share.constant(0.5);
        let stiffness = shape(STIFFNESS_ROW);
        let mut forces = *forces;
        for (point, (state, deviation)) in volume_deviations(u, &shape).iter().enumerate() {
            // ∂J/∂F is cof F
            let stress = state.gradient.cofactor_with_identity().scaled(*deviation * stiffness);
            Self::add_stress(&mut forces, point, state, &stress);
        }
        for i in 0..3 {
            let mut f = forces[i];
            for m in 0..MODES {
                f[m] = f[m] * share;
            }
            let [r, s, t, rest @ ..] = f;
            let [d01, d12, d20, d03, d13, d23] = rest;
            let (r, s, t) = (r - (d01 + d12 + d13) * half, s - (d12 + d20 + d23) * half, t - (d03 + d13 + d23) * half);
            store(1, i, r);
            store(2, i, s);
            store(3, i, t);
            store(4, i, d01);
            store(5, i, d12);
            store(6, i, d20);
            store(7, i, d03);
            store(8, i, d13);
            store(9, i, d23);
            // forces that rounding keeps from adding up to nothing would push the whole
            store(0, i, -(((r + s) + t) + ((d01 + d12) + (d20 + d03)) + (d13 + d23)));
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &[[R; MODES]; 3], _: &Mat3<R>, shape: impl Fn(usize) -> R) -> R {
        let mut sum = u[0][0].constant(0.0);
        for (state, deviation) in volume_deviations(u, &shape) {
            sum = (state.volume * deviation).mul_add(deviation, sum);
        }
        sum * shape(STIFFNESS_ROW) * shape(THERE_ROW) * sum.constant(0.5)
    }

    /// With s the nodes' shares of the mass, b the mean gradients and L_ab = Σ_q V_q ∇N_a·∇N_b:
    /// ω² ≤ (λ Σ b·b/s + 2μ' λ_max(L_ab/√(s_a s_b))/V)/ρ, since V U(θ̄) needs b only, |sym ∇u| ≤ |∇u|, and u√s are the
    /// displacements whose squares are all weighted alike. With μ |dev ε|² + ½ k (tr ε)² ≤ ½ max(2μ, 3k) |ε|²,
    /// k adds to 2μ' only where hourglass control is made stiffer than it is by itself.
    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let c: [DVec3; MODES] = std::array::from_fn(|m| DVec3::from_slice(&shape[3 * m..]));
        let shares = Self::CELL.shares();
        let mut mean = [DVec3::ZERO; 10];
        let (mut volume, mut laplacian) = (0.0, [[0.0; 10]; 10]);
        for (at, slopes) in POINTS.iter().zip(&SLOPES) {
            let by = |k: usize| c[k] + (0..6).map(|edge| c[3 + edge] * slopes[k][edge]).sum::<DVec3>();
            let jacobian = DMat3::from_cols(by(0), by(1), by(2));
            let (weight, inverse) = (jacobian.determinant() * WEIGHT, jacobian.inverse().transpose());
            let natural = shape_at(*at).gradients;
            let gradients: [DVec3; 10] = std::array::from_fn(|a| inverse * natural[a] / shares[a].sqrt());
            volume += weight;
            for a in 0..10 {
                mean[a] += weight * gradients[a];
                for b in 0..10 {
                    laplacian[a][b] += weight * gradients[a].dot(gradients[b]);
                }
            }
        }
        let trace: f64 = mean.iter().map(|b| (*b / volume).length_squared()).sum();
        let largest = largest_eigenvalue_bound(laplacian) / volume;
        let beyond = (3.0 * shape[STIFFNESS_ROW] - 2.0 * stiffness.shear).max(0.0);
        (stiffness.lambda * trace + (stiffness.deviatoric() + beyond) * largest) / stiffness.density
    }
}
