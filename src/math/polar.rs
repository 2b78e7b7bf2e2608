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
mod tests;
