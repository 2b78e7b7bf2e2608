//! The rotation in a deformation, without eigenvectors.

use super::{Mat3, Real, Sym3, dot, dot_plus, minor};

/// F = R U with the rotation R for which tr(RᵀF) is largest, which is the polar one where det F > 0, and elsewhere that
/// of the variant in which the least stretch has the sign of det F. Turned over first by D, one of I and the three half
/// turns about axes, so that what is left to find is never near a half turn: F D = (I + `turn`)(I + `biot`).
#[derive(Clone, Copy, Debug)]
pub struct Polar<R> {
    turn: Mat3<R>,
    /// The diagonal of D.
    half_turn: [R; 3],
    /// D (U − I) D: exact to rounding for small strains; its invariants are those of U − I.
    pub biot: Sym3<R>,
}

impl<R: Real> Polar<R> {
    /// Of F = I + ∇u. The sum of the stretches λ is the largest root of (λ² − |F|²)² = 4 |cof F|² + 8 λ det F, and is
    /// sought from above, where Newton's iterations cannot miss it; the rotation's quaternion then solves linear
    /// equations (Davenport's q-method as Shuster and Oh 1981 solve it). What an error of the rotation makes of the
    /// strain is of second order.
    #[inline(always)]
    pub fn new(gradient: &Mat3<R>) -> Self {
        let one = gradient.0[0][0].constant(1.0);
        let tiny = one.constant(f64::from(f32::MIN_POSITIVE));
        let mut f = gradient.0;
        for i in 0..3 {
            f[i][i] += one;
        }
        // in units of λ, so that nothing overflows
        let per_sum = one / sum_of_stretches(&f, &gradient.cofactor_with_identity().0).max(tiny);
        for i in 0..3 {
            for j in 0..3 {
                f[i][j] = f[i][j] * per_sum;
            }
        }
        let half_turn = half_turn(&f);
        let [xx, yy, zz, xy, yz, xz] = equations(&f, half_turn);
        let [sx, sy, sz] = half_turn;
        let axis = [
            sy.mul_add(f[2][1], -(sz * f[1][2])),
            sz.mul_add(f[0][2], -(sx * f[2][0])),
            sx.mul_add(f[1][0], -(sy * f[0][1])),
        ];
        let adjugate = [
            [minor(yy, yz, yz, zz), minor(xz, zz, xy, yz), minor(xy, yy, xz, yz)],
            [minor(xz, zz, xy, yz), minor(xx, xz, xz, zz), minor(xy, xx, yz, xz)],
            [minor(xy, yy, xz, yz), minor(xy, xx, yz, xz), minor(xx, xy, xy, yy)],
        ];
        let w = dot([xx, xy, xz], adjugate[0]);
        let turn = turn(w, [dot(adjugate[0], axis), dot(adjugate[1], axis), dot(adjugate[2], axis)]);

        let mut h = gradient.0;
        for i in 0..3 {
            for j in 0..3 {
                h[i][j] = h[i][j] * half_turn[j];
            }
            h[i][i] += half_turn[i] - one;
        }
        Self { turn, half_turn, biot: biot(&h, &turn) }
    }

    /// R T for a symmetric function T of U, given as the same function of [`biot`](Self::biot).
    #[inline(always)]
    pub fn turned(&self, of_biot: &Sym3<R>) -> Mat3<R> {
        let mut product = self.turn.plus_identity_times(of_biot);
        for i in 0..3 {
            for j in 0..3 {
                product.0[i][j] = product.0[i][j] * self.half_turn[j];
            }
        }
        product
    }
}

/// (1 + tr F D) I − F D − (F D)ᵀ, with F in units of λ: xx, yy, zz, xy, yz, xz.
#[inline(always)]
fn equations<R: Real>(f: &[[R; 3]; 3], half_turn: [R; 3]) -> [R; 6] {
    let [sx, sy, sz] = half_turn;
    let [x, y, z] = [sx * f[0][0], sy * f[1][1], sz * f[2][2]];
    let one = x.constant(1.0);
    [
        one - x + y + z,
        one + x - y + z,
        one + x + y - z,
        -(sy.mul_add(f[0][1], sx * f[1][0])),
        -(sz.mul_add(f[1][2], sy * f[2][1])),
        -(sz.mul_add(f[0][2], sx * f[2][0])),
    ]
}

/// The diagonal of D: that which leaves least to turn, I first. The determinant of the equations is in proportion to
/// the square of the cosine of half that angle.
#[inline(always)]
fn half_turn<R: Real>(f: &[[R; 3]; 3]) -> [R; 3] {
    let one = f[0][0].constant(1.0);
    let (mut signs, mut largest) = ([one; 3], determinant(&equations(f, [one; 3])));
    for axis in 0..3 {
        let mut others = [-one; 3];
        others[axis] = one;
        let found = determinant(&equations(f, others));
        let more = found - largest;
        for i in 0..3 {
            signs[i] = more.if_positive(others[i], signs[i]);
        }
        largest = largest.max(found);
    }
    signs
}

#[inline(always)]
fn determinant<R: Real>([xx, yy, zz, xy, yz, xz]: &[R; 6]) -> R {
    dot([*xx, *xy, *xz], [minor(*yy, *yz, *yz, *zz), minor(*xz, *zz, *xy, *yz), minor(*xy, *yy, *xz, *yz)])
}

// Functions, where closures would read more easily: those do not get a kernel's instructions.

#[inline(always)]
fn sum_of_squares<R: Real>(m: &[[R; 3]; 3]) -> R {
    dot_plus(m[0], m[0], dot_plus(m[1], m[1], dot(m[2], m[2])))
}

#[inline(always)]
fn column<R: Real>(m: &[[R; 3]; 3], j: usize) -> [R; 3] {
    [m[0][j], m[1][j], m[2][j]]
}

/// λ of F with its cofactors.
#[inline(always)]
fn sum_of_stretches<R: Real>(f: &[[R; 3]; 3], cofactor: &[[R; 3]; 3]) -> R {
    let (two, three, four) = (f[0][0].constant(2.0), f[0][0].constant(3.0), f[0][0].constant(4.0));
    let (stretch, area) = (sum_of_squares(f), sum_of_squares(cofactor));
    let eight_j = (four + four) * dot(f[0], cofactor[0]);
    let tiny = two.constant(f64::from(f32::MIN_POSITIVE));
    // (Σ sᵢsⱼ)² = Σ (sᵢsⱼ)² + 2 λ J, and ≤ 3 Σ (sᵢsⱼ)²; and no stretch is more than their sum
    let most = eight_j.if_positive(three * area, area);
    let mut sum = two.mul_add(most.sqrt(), stretch).sqrt();
    let least = (stretch * two.constant(1.0 / 3.0)).sqrt();
    for _ in 0..if R::EPSILON > 1e-10 { 7 } else { 9 } {
        let pairs = sum.mul_add(sum, -stretch);
        let off = pairs.mul_add(pairs, -(four.mul_add(area, eight_j * sum)));
        let slope = (four * sum).mul_add(pairs, -eight_j).max(tiny);
        sum = (sum - off / slope).min(sum).max(least);
    }
    sum
}

/// R − I of a quaternion that need not have length 1; nothing where all its digits are lost, as where F is a line's.
#[inline(always)]
fn turn<R: Real>(w: R, q: [R; 3]) -> Mat3<R> {
    let zero = w.constant(0.0);
    let length = w.mul_add(w, dot(q, q));
    let lost = w.constant((16.0 * R::EPSILON) * (16.0 * R::EPSILON));
    let scale = (length - lost).if_positive(w.constant(2.0) / length.max(lost), zero);
    let [x, y, z] = q;
    let [sx, sy, sz, sw] = [scale * x, scale * y, scale * z, scale * w];
    let (xx, yy, zz) = (sx * x, sy * y, sz * z);
    Mat3([
        [-(yy + zz), sx.mul_add(y, -(sw * z)), sx.mul_add(z, sw * y)],
        [sx.mul_add(y, sw * z), -(xx + zz), sy.mul_add(z, -(sw * x))],
        [sx.mul_add(z, -(sw * y)), sy.mul_add(z, sw * x), -(xx + yy)],
    ])
}

/// The symmetric part of RᵀF − I with F − I and R − I.
#[inline(always)]
fn biot<R: Real>(h: &[[R; 3]; 3], turn: &Mat3<R>) -> Sym3<R> {
    macro_rules! entry {
        ($i:literal, $j:literal) => {
            dot_plus(column(&turn.0, $i), column(h, $j), h[$i][$j] + turn.0[$j][$i])
        };
    }
    let half = h[0][0].constant(0.5);
    Sym3([
        entry!(0, 0),
        entry!(1, 1),
        entry!(2, 2),
        half * (entry!(0, 1) + entry!(1, 0)),
        half * (entry!(1, 2) + entry!(2, 1)),
        half * (entry!(0, 2) + entry!(2, 0)),
    ])
}

#[cfg(test)]
mod tests {
    use super::super::Scalar;
    use super::*;
    use glam::{DMat3, DQuat, DVec3};

    /// Largest errors of R U and of U, U − I being given, relative to U and to U − I.
    fn errors<T: Scalar>(rotation: DQuat, stretches: DVec3, axes: DQuat) -> (f64, f64) {
        let (rotation, axes) = (DMat3::from_quat(rotation), DMat3::from_quat(axes));
        let strain = axes * DMat3::from_diagonal(stretches - 1.0) * axes.transpose();
        let gradient = rotation * strain + (rotation - DMat3::IDENTITY);
        let rows = |m: DMat3| [0, 1, 2].map(|i| [0, 1, 2].map(|j| m.col(j)[i]));
        let given = Mat3(rows(gradient).map(|row| row.map(T::from_f64)));
        let polar = Polar::new(&given);
        // F again from both; and U − I, turned over again
        let biot = polar.biot;
        let whole = polar.turned(&biot.plus_diagonal(T::from_f64(1.0)));
        let (mut worst, mut strains) = (0.0_f64, 0.0_f64);
        let [f, e, b] = [rows(gradient + DMat3::IDENTITY), rows(strain), biot.rows().map(|row| row.map(T::to_f64))];
        for i in 0..3 {
            for j in 0..3 {
                worst = worst.max((whole.0[i][j].to_f64() - f[i][j]).abs());
                let signs = polar.half_turn[i].to_f64() * polar.half_turn[j].to_f64();
                strains = strains.max((signs * b[i][j] - e[i][j]).abs());
            }
        }
        let (largest, strain) = (stretches.abs().max_element(), (stretches - 1.0).abs().max_element());
        assert!(worst.is_finite() && strains.is_finite(), "{stretches}");
        (worst / largest, strains / strain.max(1e-300))
    }

    fn turned(dice: &mut fastrand::Rng) -> DQuat {
        let mut way = || 2.0 * dice.f64() - 1.0;
        DQuat::from_xyzw(way(), way(), way(), way()).normalize()
    }

    #[test]
    fn rotation_and_stretch_make_the_deformation_again() {
        let mut dice = fastrand::Rng::with_seed(3);
        for (least, most) in [(0.5, 2.0), (0.05, 5.0), (0.9, 1.1)] {
            for i in 0..20_000 {
                let size = |dice: &mut fastrand::Rng| least + (most - least) * dice.f64();
                let stretches = DVec3::from_array([0; 3].map(|_| size(&mut dice)));
                let rotation = match i % 3 {
                    0 => DQuat::from_axis_angle([DVec3::X, DVec3::Y, DVec3::Z][i % 9 / 3], std::f64::consts::PI),
                    _ => turned(&mut dice),
                };
                let axes = turned(&mut dice);
                // a rotation that is wrong by δ makes an error of δ times what is lost of the stretches: ε over the gap
                let gap = (stretches.element_sum() - stretches.max_element()) / stretches.max_element();
                let (single, double) =
                    (errors::<f32>(rotation, stretches, axes), errors::<f64>(rotation, stretches, axes));
                assert!(single.0 < 32.0 * f64::from(f32::EPSILON) / gap, "{stretches}: {single:?}");
                assert!(double.0 < 64.0 * f64::EPSILON / gap, "{stretches}: {double:?}");
            }
        }
    }

    #[test]
    fn small_strains_keep_their_digits() {
        let mut dice = fastrand::Rng::with_seed(4);
        for size in [1e-2, 1e-4, 1e-6] {
            for _ in 0..2000 {
                let stretches = DVec3::from_array([0; 3].map(|_| 1.0 + size * (2.0 * dice.f64() - 1.0)));
                let (_, single) = errors::<f32>(DQuat::IDENTITY, stretches, turned(&mut dice));
                let (_, double) = errors::<f64>(DQuat::IDENTITY, stretches, turned(&mut dice));
                assert!(single < 8.0 * f64::from(f32::EPSILON) && double < 8.0 * f64::EPSILON + 2e-16 / size, "{size}");
            }
        }
    }

    #[test]
    fn what_is_inside_out_has_a_least_stretch_below_0() {
        let mut dice = fastrand::Rng::with_seed(5);
        for _ in 0..20_000 {
            let [a, b] = [0.5 + dice.f64(), 0.5 + dice.f64()];
            let stretches = DVec3::new(a, b, -0.7 * dice.f64() * a.min(b));
            let (rotation, axes) = (turned(&mut dice), turned(&mut dice));
            // the further, the more of λ's other roots are near
            let gap = (stretches.min_element() + a.min(b)) / stretches.element_sum();
            let (single, strain) = errors::<f32>(rotation, stretches, axes);
            assert!(
                single.max(strain) < 64.0 * f64::from(f32::EPSILON) / gap.powi(2),
                "{stretches}: {single:e} {strain:e}"
            );
            let (double, strain) = errors::<f64>(rotation, stretches, axes);
            assert!(double.max(strain) < 64.0 * f64::EPSILON / gap.powi(2), "{stretches}: {double:e} {strain:e}");
        }
    }

    #[test]
    fn what_is_flat_a_line_a_point_or_no_number_has_a_rotation_or_none() {
        let mut dice = fastrand::Rng::with_seed(6);
        for stretches in
            [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, -1.0), DVec3::splat(1e8)]
        {
            for _ in 0..200 {
                let (rotation, axes) = (DMat3::from_quat(turned(&mut dice)), DMat3::from_quat(turned(&mut dice)));
                let f = rotation * axes * DMat3::from_diagonal(stretches) * axes.transpose() - DMat3::IDENTITY;
                let polar = Polar::new(&Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| f.col(j)[i] as f32))));
                let r = polar.turned(&Sym3([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])).0;
                let r = DMat3::from_cols_array_2d(&r.map(|row| row.map(f64::from)));
                assert!(
                    (r.transpose() * r - DMat3::IDENTITY).to_cols_array().iter().all(|e| e.abs() < 1e-5),
                    "{stretches}: {r}"
                );
                assert!((r.determinant() - 1.0).abs() < 1e-5, "{stretches}: {r}");
            }
        }
        let none = Polar::new(&Mat3([[f32::NAN, 0.0, 0.0], [0.0; 3], [0.0; 3]])).biot.0;
        assert!(none.iter().any(|e| e.is_nan()), "{none:?}");
    }
}
