//! The eight-node hexahedron with eight integration points and one mean dilatation.

use super::hex8::{MODES, NODE_SIGNS, balanced, mode_sign, modes, natural_gradients, spread};
use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, gradient_measure, vector};
use crate::math::{Mat3, Real, dot, minor};
use crate::mesh::CellKind;
use glam::{DMat3, DVec3};

/// Trilinear hexahedron with 2×2×2 Gauss points for what changes shape, and one pressure from its mean volume
/// (Nagtegaal, Parks & Rice 1974; Simo, Taylor & Pister 1985): it neither locks as ν → ½ nor has hourglass modes, and
/// costs some six times the stress work of [`Hex8`](super::Hex8). Its WGSL twin is `shaders/hex8_mean_dilatation.wgsl`.
///
/// Energy V U(θ̄) + Σ_q V_q Ψ_iso(F_q), θ̄ = Σ V_q θ_q / V; forces are its exact derivative. Positions and
/// displacements are kept as coefficients of the modes ξ, η, ζ, ηζ, ζξ, ξη, ξηζ, so that a common displacement never
/// enters. Rest shape: those of X (m, rows 0 to 20), volume (21), 1 while the element is there (22).
#[derive(Clone, Copy, Debug)]
pub struct Hex8MeanDilatation;

/// Coefficients of the seven modes from nodal values of one component.
#[inline(always)]
fn mode_coefficients<R: Real>(u: &[[R; 3]; MOST_NODES], i: usize) -> [R; MODES] {
    let mut coefficients = modes(u, i);
    for m in 0..MODES {
        coefficients[m] = coefficients[m] * u[0][0].constant(0.125);
    }
    coefficients
}

/// 1/√3, where Gauss points are.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// ∂/∂(ξ, η, ζ) at a Gauss point of a component with these mode coefficients.
#[inline(always)]
fn natural_gradient<R: Real>(c: [R; 7], point: usize) -> [R; 3] {
    let [sx, sy, sz] = NODE_SIGNS[point];
    let (x, y, z) = (c[0].constant(GAUSS * sx), c[0].constant(GAUSS * sy), c[0].constant(GAUSS * sz));
    [
        y.mul_add(z.mul_add(c[6], c[5]), z.mul_add(c[4], c[0])),
        x.mul_add(z.mul_add(c[6], c[5]), z.mul_add(c[3], c[1])),
        x.mul_add(y.mul_add(c[6], c[4]), y.mul_add(c[3], c[2])),
    ]
}

impl Element for Hex8MeanDilatation {
    const NAME: &'static str = "hex8_mean_dilatation";
    const CELL: CellKind = CellKind::Hex8;
    const POINTS: usize = 8;
    const ROWS: usize = 23;
    const VOLUME_ROW: usize = 21;
    const FORCE_ROW: Option<usize> = Some(22);
    const PRESSURE: PressureFrom = PressureFrom::MeanOverPoints;
    const SPECIALISED: bool = true;

    type Specialisation = Self;
    /// Mode coefficients of each component.
    type Prepared<R: Real> = [[R; 7]; 3];
    /// Forces on the mode coefficients of each component.
    type Forces<R: Real> = [[R; 7]; 3];

    fn rest_shape(points: &[DVec3], _young: f64) -> [f64; MOST_ROWS] {
        let mut from_first = [[0.0; 3]; MOST_NODES];
        for a in 0..8 {
            from_first[a] = (points[a] - points[0]).to_array();
        }
        let mut shape = [0.0; MOST_ROWS];
        for i in 0..3 {
            for (m, c) in mode_coefficients(&from_first, i).into_iter().enumerate() {
                shape[3 * m + i] = c;
            }
        }
        shape[21] = super::hex8::mean_gradients(points).0;
        shape[22] = 1.0;
        shape
    }

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> [[R; 7]; 3] {
        [mode_coefficients(u, 0), mode_coefficients(u, 1), mode_coefficients(u, 2)]
    }

    #[inline(always)]
    fn at_point<R: Real>(u: &[[R; 7]; 3], point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        // rows: ∂X_i/∂ξ
        let mut jacobian = [vector(&shape, 0); 3];
        for i in 0..3 {
            let mut c = [shape(i); 7];
            for m in 1..7 {
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
        let volume = dot(a, [adjugate.0[0][0], adjugate.0[1][0], adjugate.0[2][0]]);
        let per_volume = volume.constant(1.0) / volume;
        let mut gradient = Mat3::zero(volume);
        for i in 0..3 {
            let natural = natural_gradient(u[i], point);
            for k in 0..3 {
                gradient.add_to_row(i, natural[k] * per_volume, adjugate.0[k]);
            }
        }
        PointState { gradient, adjugate, volume }
    }

    #[inline(always)]
    fn no_forces<R: Real>(like: R) -> [[R; 7]; 3] {
        [[like.constant(0.0); 7]; 3]
    }

    #[inline(always)]
    fn add_stress<R: Real>(forces: &mut [[R; 7]; 3], point: usize, at: &PointState<R>, stress: &Mat3<R>) {
        let [sx, sy, sz] = NODE_SIGNS[point];
        for i in 0..3 {
            // on ∂u_i/∂ξ_k: V_q P_ij ∂ξ_k/∂X_j
            let f = [
                dot(stress.0[i], at.adjugate.0[0]),
                dot(stress.0[i], at.adjugate.0[1]),
                dot(stress.0[i], at.adjugate.0[2]),
            ];
            let (x, y, z) = (f[0].constant(GAUSS * sx), f[0].constant(GAUSS * sy), f[0].constant(GAUSS * sz));
            let sums = &mut forces[i];
            sums[0] += f[0];
            sums[1] += f[1];
            sums[2] += f[2];
            sums[3] = z.mul_add(f[1], y.mul_add(f[2], sums[3]));
            sums[4] = x.mul_add(f[2], z.mul_add(f[0], sums[4]));
            sums[5] = y.mul_add(f[0], x.mul_add(f[1], sums[5]));
            sums[6] = (y * z).mul_add(f[0], (z * x).mul_add(f[1], (x * y).mul_add(f[2], sums[6])));
        }
    }

    #[inline(always)]
    fn store_forces<R: Real>(
        u: &[[R; 7]; 3],
        forces: &[[R; 7]; 3],
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let share = shape(22) * u[0][0].constant(0.125);
        for i in 0..3 {
            let mut at_nodes = spread(forces[i]);
            for a in 1..8 {
                at_nodes[a] = at_nodes[a] * share;
            }
            balanced(
                at_nodes,
                #[inline(always)]
                |a, force| store(a, i, force),
            );
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &[[R; 7]; 3], _: &Mat3<R>, _: impl Fn(usize) -> R) -> R {
        u[0][0].constant(0.0)
    }

    /// With b the mean gradients and L_ab = Σ_q V_q ∇N_a·∇N_b: ω² ≤ (8/ρ)(λ Σ b·b + 2μ' λ_max(L)/V), since
    /// V U(θ̄) needs b only and |sym ∇u| ≤ |∇u|.
    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let position =
            |a: usize| -> DVec3 { (0..MODES).map(|m| DVec3::from_slice(&shape[3 * m..]) * mode_sign(m, a)).sum() };
        let points = [0, 1, 2, 3, 4, 5, 6, 7].map(position);
        let mut mean = [DVec3::ZERO; 8];
        let (mut volume, mut laplacian) = (0.0, [[0.0; 8]; 8]);
        for sign in NODE_SIGNS {
            let natural = natural_gradients(sign.map(|s| s * GAUSS));
            let mut jacobian = DMat3::ZERO;
            for a in 0..8 {
                let n = natural[a];
                jacobian += DMat3::from_cols(points[a] * n.x, points[a] * n.y, points[a] * n.z);
            }
            let (determinant, inverse) = (jacobian.determinant(), jacobian.inverse().transpose());
            let gradients = natural.map(|n| inverse * n);
            volume += determinant;
            for a in 0..8 {
                mean[a] += determinant * gradients[a];
                for b in 0..8 {
                    laplacian[a][b] += determinant * gradients[a].dot(gradients[b]);
                }
            }
        }
        let (trace, _) = gradient_measure(mean.into_iter().map(|b| b / volume));
        let largest = largest_eigenvalue_bound(laplacian) / volume;
        Self::NODES_OF_LEAST_MASS / stiffness.density * (stiffness.lambda * trace + stiffness.deviatoric() * largest)
    }
}

/// (tr L^64)^(1/64) ≥ λ_max of a positive semidefinite matrix, at most 3.7 % above it for up to ten rows.
pub(super) fn largest_eigenvalue_bound<const N: usize>(mut power: [[f64; N]; N]) -> f64 {
    let trace = |m: &[[f64; N]; N]| (0..N).map(|a| m[a][a]).sum::<f64>();
    let mut logarithm = 0.0;
    for squared in 0..=6 {
        let scale = trace(&power);
        if !(scale > 0.0 && scale.is_finite()) {
            return scale.max(0.0);
        }
        logarithm += scale.ln() / f64::from(1 << squared);
        power.as_flattened_mut().iter_mut().for_each(|entry| *entry /= scale);
        if squared < 6 {
            let row = |a: usize, b: usize| (0..N).map(|c| power[a][c] * power[c][b]).sum::<f64>();
            power = std::array::from_fn(|a| std::array::from_fn(|b| row(a, b)));
        }
    }
    logarithm.exp()
}
