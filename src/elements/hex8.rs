//! The eight-node hexahedron with one integration point and hourglass control.

use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, gradient_measure, vector};
use crate::math::{Mat3, Real, dot, dot_plus};
use crate::mesh::CellKind;
pub(super) use crate::mesh::topology::hex8::NODES as NODE_SIGNS;
use glam::{DMat3, DVec3};

/// Trilinear hexahedron with the mean gradients b_a (Flanagan & Belytschko 1981) and total Lagrangian hourglass
/// control. Its WGSL twin is `shaders/hex8.wgsl`.
///
/// f_a = V P b_a + k Σ_m γ_ma q_m with q_m = Σ_a γ_ma u_a and γ_m = Γ_m − b·(XᵀΓ_m): no force for any homogeneous F,
/// and objective. Its scale k = E V Σ(b·b)/72 matches pure bending at every Poisson's ratio; the usual λ + 2μ locks as
/// ν → ½.
///
/// Displacements are taken apart into seven modes: the signs ξ, η, ζ of the nodes and the four Γ, ηζ, ζξ, ξη and ξηζ.
/// So are the mean gradients, b_a = Σ_m s_ma β_m, which need six of them: V b_a = ∂V/∂X_a, and a hexahedron's volume
/// does not depend on the mode ξηζ of its corners. The sums Γ·u that hourglass control needs come with ∇u = Σ_m (Σ_a
/// s_ma u_a) ⊗ β_m.
///
/// γ is never stored: with h_m = XᵀΓ_m, q_m = Γ_m·u − ∇u h_m, and its force folds into the stress. Rest shape: β of the
/// modes (1/m), volume (m³), k (N/m), h_m (m). In a parallelepiped the last three β and all h_m are zero: it has 11
/// numbers in place of 32. `SLOPES`, how many β there are, is 3 or 6.
#[derive(Clone, Copy, Debug)]
pub struct Hexahedron<const SLOPES: usize>;

/// Of any shape.
pub type Hex8 = Hexahedron<6>;
/// Parallelepipeds only: what is zero in them has no place in the rest shape.
pub type Parallelepiped = Hexahedron<3>;

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

/// h_m = XᵀΓ_m (m).
fn arms(points: &[DVec3]) -> [DVec3; 4] {
    [0, 1, 2, 3].map(|m| (0..8).map(|a| (points[a] - points[0]) * hourglass_sign(m, a)).sum())
}

/// Sign of a mode at node a: ξ, η, ζ, then the Γ.
pub(super) fn mode_sign(mode: usize, a: usize) -> f64 {
    if mode < 3 { NODE_SIGNS[a][mode] } else { hourglass_sign(mode - 3, a) }
}

/// How many modes there are.
pub(super) const MODES: usize = 7;
/// Σ_a s_ma u_a of the modes, for one component of u: from differences along edges, so that a common displacement drops
/// out before it can round.
#[inline(always)]
pub(super) fn modes<R: Real>(u: &[[R; 3]; MOST_NODES], i: usize) -> [R; MODES] {
    let (x0, x1, x2, x3) = (u[1][i] - u[0][i], u[2][i] - u[3][i], u[5][i] - u[4][i], u[6][i] - u[7][i]);
    let y_below = (u[3][i] - u[0][i]) + (u[2][i] - u[1][i]);
    let y_above = (u[7][i] - u[4][i]) + (u[6][i] - u[5][i]);
    let z = ((u[4][i] - u[0][i]) + (u[5][i] - u[1][i])) + ((u[6][i] - u[2][i]) + (u[7][i] - u[3][i]));
    let (x_below, x_above) = (x0 + x1, x2 + x3);
    let (low, high) = (x1 - x0, x3 - x2);
    [x_below + x_above, y_below + y_above, z, y_above - y_below, x_above - x_below, low + high, high - low]
}

/// Σ_m s_ma f_m of the eight nodes: what is odd in (ξ, η, ζ) has the other sign at the opposite node.
#[inline(always)]
pub(super) fn spread<R: Real>([x, y, z, yz, zx, xy, xyz]: [R; MODES]) -> [R; 8] {
    let (s, d, p, m) = (x + y, x - y, z + xyz, z - xyz);
    let (odd_1, odd_3, odd_4, odd_6) = (d - m, -(d + m), p - s, s + p);
    let (s, d) = (yz + zx, yz - zx);
    let (even_1, even_3, even_4, even_6) = (d - xy, -(d + xy), xy - s, s + xy);
    [
        even_6 - odd_6,
        even_1 + odd_1,
        even_4 - odd_4,
        even_3 + odd_3,
        even_4 + odd_4,
        even_3 - odd_3,
        even_6 + odd_6,
        even_1 - odd_1,
    ]
}

/// Stores a component of forces on nodes 1 to 7, and on node 0 what balances them: forces that rounding keeps from
/// adding up to nothing hold stiff motion awake (a cantilever at rest in f32 had residuals 1.3 times as large).
#[inline(always)]
pub(super) fn balanced<R: Real>(forces: [R; 8], mut store: impl FnMut(usize, R)) {
    let mut sum = forces[1];
    for a in 2..8 {
        sum += forces[a];
    }
    store(0, -sum);
    for a in 1..8 {
        store(a, forces[a]);
    }
}

impl<const SLOPES: usize> Hexahedron<SLOPES> {
    const STIFFNESS_ROW: usize = 3 * SLOPES + 1;

    /// h_m (m).
    #[inline(always)]
    fn arm<R: Real>(shape: &impl Fn(usize) -> R, m: usize) -> Option<[R; 3]> {
        (SLOPES == MODES - 1).then(|| vector(shape, Self::STIFFNESS_ROW + 1 + 3 * m))
    }
}

impl<const SLOPES: usize> Element for Hexahedron<SLOPES> {
    const NAME: &'static str = "hex8";
    const CELL: CellKind = CellKind::Hex8;
    const POINTS: usize = 1;
    const ROWS: usize = if SLOPES == MODES - 1 { Self::STIFFNESS_ROW + 13 } else { Self::STIFFNESS_ROW + 1 };
    const VOLUME_ROW: usize = 3 * SLOPES;
    const FORCE_ROW: Option<usize> = Some(Self::STIFFNESS_ROW);
    const PRESSURE: PressureFrom = PressureFrom::Point;
    const SPECIALISED: bool = true;

    /// Sums of the edges along ξ and along η, as SOFA's hexahedra have them.
    fn frame(points: &[DVec3]) -> Option<[DVec3; 2]> {
        let sum = |mode: usize| (0..8).map(|a| (points[a] - points[0]) * mode_sign(mode, a)).sum();
        Some([sum(0), sum(1)])
    }

    fn rest_shape(points: &[DVec3], young: f64) -> [f64; MOST_ROWS] {
        let (volume, b) = mean_gradients(points);
        let mut shape = [0.0; MOST_ROWS];
        shape[Self::VOLUME_ROW] = volume;
        shape[Self::STIFFNESS_ROW] = young * volume * b.iter().map(|b| b.length_squared()).sum::<f64>() / 72.0;
        let parallelepiped = Parallelepiped::describes(points);
        for mode in 0..if parallelepiped { 3 } else { SLOPES } {
            let slope: DVec3 = (0..8).map(|a| b[a] * (mode_sign(mode, a) / 8.0)).sum();
            shape[3 * mode..3 * mode + 3].copy_from_slice(&slope.to_array());
        }
        if !parallelepiped && SLOPES == MODES - 1 {
            for (row, arm) in shape[Self::STIFFNESS_ROW + 1..].chunks_exact_mut(3).zip(arms(points)) {
                row.copy_from_slice(&arm.to_array());
            }
        }
        shape
    }

    type Specialisation = Parallelepiped;

    fn describes(points: &[DVec3]) -> bool {
        // as far as its corners' coordinates, rounded as they are, can tell
        let farthest = points.iter().fold(0.0_f64, |farthest, x| farthest.max(x.abs().max_element()));
        SLOPES == MODES - 1 || arms(points).iter().all(|h| h.abs().max_element() <= 32.0 * f64::EPSILON * farthest)
    }

    /// Modes of each component of u (m).
    type Prepared<R: Real> = [[R; MODES]; 3];
    /// ∇u and the stress.
    type Forces<R: Real> = [Mat3<R>; 2];

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> [[R; MODES]; 3] {
        [modes(u, 0), modes(u, 1), modes(u, 2)]
    }

    #[inline(always)]
    fn at_point<R: Real>(u: &[[R; MODES]; 3], _point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        let mut gradient = Mat3::zero(u[0][0]);
        for mode in 0..SLOPES {
            let slope = vector(&shape, 3 * mode);
            for i in 0..3 {
                gradient.add_to_row(i, u[i][mode], slope);
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
        u: &[[R; MODES]; 3],
        [gradient, stress]: &[Mat3<R>; 2],
        shape: impl Fn(usize) -> R,
        mut store: impl FnMut(usize, usize, R),
    ) {
        let mut folded = stress.scaled(shape(Self::VOLUME_ROW));
        let stiffness = shape(Self::STIFFNESS_ROW);
        for i in 0..3 {
            let mut forces = [stiffness; MODES];
            for m in 0..4 {
                let Some(arm) = Self::arm(&shape, m) else {
                    forces[3 + m] = u[i][3 + m] * stiffness;
                    continue;
                };
                let q = (u[i][3 + m] - dot(gradient.0[i], arm)) * stiffness;
                folded.add_to_row(i, -q, arm);
                forces[3 + m] = q;
            }
            for mode in 0..SLOPES {
                let slope = vector(&shape, 3 * mode);
                let row = folded.0[i];
                forces[mode] = if mode < 3 { dot(row, slope) } else { dot_plus(row, slope, forces[mode]) };
            }
            balanced(
                spread(forces),
                #[inline(always)]
                |a, force| store(a, i, force),
            );
        }
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &[[R; MODES]; 3], gradient: &Mat3<R>, shape: impl Fn(usize) -> R) -> R {
        let mut sum = u[0][0].constant(0.0);
        for i in 0..3 {
            for m in 0..4 {
                let q = match Self::arm(&shape, m) {
                    Some(arm) => u[i][3 + m] - dot(gradient.0[i], arm),
                    None => u[i][3 + m],
                };
                sum += q * q;
            }
        }
        sum * shape(Self::STIFFNESS_ROW) * sum.constant(0.5)
    }

    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        let slope = |mode: usize, a: usize| DVec3::from_slice(&shape[3 * mode..]) * mode_sign(mode, a);
        let b: [DVec3; 8] = std::array::from_fn(|a| (0..SLOPES).map(|mode| slope(mode, a)).sum());
        let (trace, largest) = gradient_measure(b.into_iter());
        let nodes = Self::NODES_OF_LEAST_MASS;
        let material = nodes / stiffness.density * (stiffness.lambda * trace + stiffness.deviatoric() * largest);

        let gamma = |m: usize, a: usize| {
            let arm = Self::arm(&|row: usize| shape[row], m).map_or(DVec3::ZERO, DVec3::from);
            hourglass_sign(m, a) - b[a].dot(arm)
        };
        let square: f64 = (0..4).flat_map(|m| (0..8).map(move |a| (m, a))).map(|(m, a)| gamma(m, a).powi(2)).sum();
        // the largest eigenvalue of Σ γ γᵀ is below its trace, and is the trace's quarter when the four are orthogonal
        // and equally long, as in every parallelepiped
        let mut largest_row: f64 = 0.0;
        let mut overlap: f64 = 0.0;
        for m in 0..4 {
            let row: f64 = (0..4).map(|n| (0..8).map(|a| gamma(m, a) * gamma(n, a)).sum::<f64>().abs()).sum();
            largest_row = largest_row.max(row);
            overlap = overlap.max((0..8).map(|a| b[a] * gamma(m, a)).sum::<DVec3>().length());
        }
        let hourglass = shape[Self::STIFFNESS_ROW] * largest_row.min(square)
            / (stiffness.density * shape[Self::VOLUME_ROW] / nodes);
        // modes of both kinds are orthogonal in a parallelepiped: then the larger counts, else their sum
        if overlap < 1e-9 * trace.sqrt() { material.max(hourglass) } else { material + hourglass }
    }
}
