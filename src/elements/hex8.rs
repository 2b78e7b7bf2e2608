//! The eight-node hexahedron with one integration point and hourglass control.

use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, gradient_measure, vector};
use crate::math::{Mat3, Real, dot, dot_plus};
use glam::{DMat3, DVec3};

/// Trilinear hexahedron with the mean gradients b_a (Flanagan & Belytschko 1981) and total Lagrangian hourglass control.
/// Its WGSL twin is `shaders/hex8.wgsl`.
///
/// f_a = V P b_a + k Σ_m γ_ma q_m with q_m = Σ_a γ_ma u_a and γ_m = Γ_m − b·(XᵀΓ_m): no force for any homogeneous F, and
/// objective. Its scale k = E V Σ(b·b)/72 matches pure bending at every Poisson's ratio; the usual λ + 2μ locks as ν → ½.
///
/// γ is never stored: with h_m = XᵀΓ_m, q_m = Γ_m·u − ∇u h_m, and its force folds into the stress.
/// Rest shape: b of nodes 1 to 7 (rows 0 to 20; node 0 has their negative sum), volume (21), k (N/m, 22),
/// h_m (23 to 34).
#[derive(Clone, Copy, Debug)]
pub struct Hex8;

pub(super) const NODE_SIGNS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Γ_m at node a: ηζ, ζξ, ξη, ξηζ.
#[inline(always)]
fn hourglass_sign(m: usize, a: usize) -> f64 {
    let [x, y, z] = NODE_SIGNS[a];
    [y * z, z * x, x * y, x * y * z][m]
}

/// Volume (m³) and volume means of the shape functions' gradients (1/m), exact by 2×2×2 Gauss points.
pub fn mean_gradients(points: &[DVec3]) -> (f64, [DVec3; 8]) {
    let mut volume = 0.0;
    let mut gradients = [DVec3::ZERO; 8];
    for gauss in NODE_SIGNS {
        let natural = natural_gradients(gauss.map(|s| s / 3.0_f64.sqrt()));
        let mut jacobian = DMat3::ZERO; // column j: ∂X/∂ξ_j
        for a in 0..8 {
            let n = natural[a];
            jacobian += DMat3::from_cols(points[a] * n.x, points[a] * n.y, points[a] * n.z);
        }
        let determinant = jacobian.determinant();
        volume += determinant;
        let cofactor = DMat3::from_cols(
            jacobian.y_axis.cross(jacobian.z_axis),
            jacobian.z_axis.cross(jacobian.x_axis),
            jacobian.x_axis.cross(jacobian.y_axis),
        );
        for a in 0..8 {
            gradients[a] += cofactor * natural[a];
        }
    }
    (volume, gradients.map(|g| g / volume))
}

/// ∂N_a/∂ξ at a point of the reference cube.
pub(super) fn natural_gradients(at: [f64; 3]) -> [DVec3; 8] {
    NODE_SIGNS.map(|s| {
        let factor = [0, 1, 2].map(|i| 1.0 + s[i] * at[i]);
        DVec3::new(s[0] * factor[1] * factor[2], s[1] * factor[0] * factor[2], s[2] * factor[0] * factor[1]) / 8.0
    })
}

/// Σ_a Γ_ma u_a of the four modes, for one component of u: from differences along edges, so that a common displacement
/// drops out before it can round.
#[inline(always)]
fn hourglass_sums<R: Real>(u: &[[R; 3]; MOST_NODES], i: usize) -> [R; 4] {
    let (x0, x1, x2, x3) = (u[1][i] - u[0][i], u[2][i] - u[3][i], u[5][i] - u[4][i], u[6][i] - u[7][i]);
    let below = (u[3][i] - u[0][i]) + (u[2][i] - u[1][i]);
    let above = (u[7][i] - u[4][i]) + (u[6][i] - u[5][i]);
    let (low, high) = (x1 - x0, x3 - x2);
    [above - below, (x2 + x3) - (x0 + x1), low + high, high - low]
}

/// Σ_m Γ_ma q_m of the eight nodes.
#[inline(always)]
fn hourglass_spread<R: Real>(q: [R; 4]) -> [R; 8] {
    let (sum, difference) = (q[0] + q[1], q[0] - q[1]);
    let (low, high) = (q[2] - q[3], q[2] + q[3]);
    [
        low + sum,
        difference - low,
        low - sum,
        -(difference + low),
        high - sum,
        -(difference + high),
        high + sum,
        difference - high,
    ]
}

/// q_m = Σ_a γ_ma u_a of the four modes, for one component of u.
#[inline(always)]
fn hourglass_displacements<R: Real>(
    u: &[[R; 3]; MOST_NODES],
    i: usize,
    gradient: &Mat3<R>,
    shape: &impl Fn(usize) -> R,
) -> [R; 4] {
    let mut q = hourglass_sums(u, i);
    for m in 0..4 {
        q[m] -= dot(gradient.0[i], vector(shape, 23 + 3 * m));
    }
    q
}

impl Element for Hex8 {
    const NAME: &'static str = "hex8";
    const NODES: usize = 8;
    const POINTS: usize = 1;
    const ROWS: usize = 35;
    const VOLUME_ROW: usize = 21;
    const FORCE_ROW: Option<usize> = Some(22);
    const PRESSURE: PressureFrom = PressureFrom::Point;

    fn rest_shape(points: &[DVec3], young: f64) -> [f64; MOST_ROWS] {
        let (volume, b) = mean_gradients(points);
        let mut shape = [0.0; MOST_ROWS];
        for a in 1..8 {
            shape[3 * (a - 1)..3 * a].copy_from_slice(&b[a].to_array());
        }
        shape[21] = volume;
        shape[22] = young * volume * b.iter().map(|b| b.length_squared()).sum::<f64>() / 72.0;
        for m in 0..4 {
            let h: DVec3 = (0..8).map(|a| (points[a] - points[0]) * hourglass_sign(m, a)).sum();
            shape[23 + 3 * m..26 + 3 * m].copy_from_slice(&h.to_array());
        }
        shape
    }

    type Prepared<R: Real> = [[R; 3]; MOST_NODES];
    /// ∇u and the stress.
    type Forces<R: Real> = [Mat3<R>; 2];

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> [[R; 3]; MOST_NODES] {
        *u
    }

    #[inline(always)]
    fn at_point<R: Real>(u: &[[R; 3]; MOST_NODES], _point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        let mut gradient = Mat3::zero(u[0][0]);
        for i in 0..3 {
            for a in 1..8 {
                gradient.add_to_row(i, u[a][i] - u[0][i], vector(&shape, 3 * (a - 1)));
            }
        }
        PointState { gradient, adjugate: gradient, volume: shape(Self::VOLUME_ROW) }
    }

    #[inline(always)]
    fn no_forces<R: Real>(like: R) -> [Mat3<R>; 2] {
        [Mat3::zero(like); 2]
    }

    #[inline(always)]
    fn add_stress<R: Real>(forces: &mut [Mat3<R>; 2], _point: usize, at: &PointState<R>, stress: &Mat3<R>) {
        *forces = [at.gradient, *stress];
    }

    #[inline(always)]
    fn store_forces<R: Real>(
        u: &[[R; 3]; MOST_NODES],
        [gradient, stress]: &[Mat3<R>; 2],
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let mut folded = stress.scaled(shape(21));
        let stiffness = shape(22);
        for i in 0..3 {
            let mut q = hourglass_displacements(u, i, gradient, &shape);
            for m in 0..4 {
                q[m] = q[m] * stiffness;
                folded.add_to_row(i, -q[m], vector(&shape, 23 + 3 * m));
            }
            let hourglass = hourglass_spread(q);
            let mut sum = u[0][0].constant(0.0);
            for a in 1..8 {
                let force = dot_plus(folded.0[i], vector(&shape, 3 * (a - 1)), hourglass[a]);
                sum += force;
                store(a, i, force);
            }
            store(0, i, -sum);
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &[[R; 3]; MOST_NODES], gradient: &Mat3<R>, shape: impl Fn(usize) -> R) -> R {
        let mut sum = u[0][0].constant(0.0);
        for i in 0..3 {
            for q in hourglass_displacements(u, i, gradient, &shape) {
                sum += q * q;
            }
        }
        sum * shape(22) * sum.constant(0.5)
    }

    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let mut b = [DVec3::ZERO; 8];
        for a in 1..8 {
            b[a] = DVec3::from_slice(&shape[3 * (a - 1)..]);
            b[0] -= b[a];
        }
        let (trace, largest) = gradient_measure(b.into_iter());
        let material = 8.0 / stiffness.density * (stiffness.lambda * trace + stiffness.deviatoric * largest);

        let gamma = |m: usize, a: usize| hourglass_sign(m, a) - b[a].dot(DVec3::from_slice(&shape[23 + 3 * m..]));
        let square: f64 = (0..4).flat_map(|m| (0..8).map(move |a| (m, a))).map(|(m, a)| gamma(m, a).powi(2)).sum();
        // the largest eigenvalue of Σ γ γᵀ is below its trace, and is the trace's quarter when the four are orthogonal and
        // equally long, as in every parallelepiped
        let mut largest_row: f64 = 0.0;
        let mut overlap: f64 = 0.0;
        for m in 0..4 {
            let row: f64 = (0..4).map(|n| (0..8).map(|a| gamma(m, a) * gamma(n, a)).sum::<f64>().abs()).sum();
            largest_row = largest_row.max(row);
            overlap = overlap.max((0..8).map(|a| b[a] * gamma(m, a)).sum::<DVec3>().length());
        }
        let hourglass = shape[22] * largest_row.min(square) / (stiffness.density * shape[21] / 8.0);
        // modes of both kinds are orthogonal in a parallelepiped: then the larger counts, else their sum
        if overlap < 1e-9 * trace.sqrt() { material.max(hourglass) } else { material + hourglass }
    }
}
