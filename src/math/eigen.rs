//! Eigenvalues and eigenvectors of symmetric 3×3 matrices, without a branch.

use super::{Real, Sym3};

/// What a rotation about one axis does; see [`Sym3::eigen`].
struct Rotation<R> {
    tangent: R,
    cosine: R,
    sine: R,
}

impl<R: Real> Rotation<R> {
    /// The rotation that makes the entry `apq` between two axes zero (Jacobi 1846; Golub & Van Loan 2013, §8.5).
    #[inline(always)]
    fn zeroing(app: R, aqq: R, apq: R) -> Self {
        let (one, twice) = (app.constant(1.0), apq + apq);
        let difference = aqq - app;
        // t = sgn(θ)/(|θ| + √(θ² + 1)) with θ = difference/twice, multiplied out: nothing is divided by apq = 0. Where
        // squares underflow the root is at least |twice|, so that the angle stays below 45 degrees
        let smallest = app.constant(if R::EPSILON > 1e-10 { 1e-36 } else { 1e-300 });
        let root = (difference * difference + twice * twice).sqrt().max(twice.abs());
        let tangent = difference.if_positive(twice, -twice) / (difference.abs() + root + smallest);
        let cosine = one / tangent.mul_add(tangent, one).sqrt();
        Self { tangent, cosine, sine: tangent * cosine }
    }

    /// Rotates two numbers.
    #[inline(always)]
    fn turn(&self, p: R, q: R) -> (R, R) {
        (self.cosine * p - self.sine * q, self.sine.mul_add(p, self.cosine * q))
    }
}

impl<R: Real> Sym3<R> {
    /// Eigenvalues, and the unit eigenvector of each, both to a few ε of the largest entry. Jacobi's cyclic rotations:
    /// the entries off the diagonal fall quadratically, and four sweeps (f64: five) bring them below ε.
    #[inline(always)]
    pub fn eigen(&self) -> ([R; 3], [[R; 3]; 3]) {
        let [mut xx, mut yy, mut zz, mut xy, mut yz, mut xz] = self.0;
        let (zero, one) = (xx.constant(0.0), xx.constant(1.0));
        // rows: what will be the eigenvectors
        let mut v = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
        for _ in 0..if R::EPSILON > 1e-10 { 4 } else { 5 } {
            let r = Rotation::zeroing(xx, yy, xy);
            (xx, yy) = (xx - r.tangent * xy, yy + r.tangent * xy);
            (xz, yz, xy) = (r.cosine * xz - r.sine * yz, r.sine * xz + r.cosine * yz, zero);
            turn_rows(&mut v, 0, 1, &r);
            let r = Rotation::zeroing(yy, zz, yz);
            (yy, zz) = (yy - r.tangent * yz, zz + r.tangent * yz);
            (xy, xz, yz) = (r.cosine * xy - r.sine * xz, r.sine * xy + r.cosine * xz, zero);
            turn_rows(&mut v, 1, 2, &r);
            let r = Rotation::zeroing(xx, zz, xz);
            (xx, zz) = (xx - r.tangent * xz, zz + r.tangent * xz);
            (xy, yz, xz) = (r.cosine * xy - r.sine * yz, r.sine * xy + r.cosine * yz, zero);
            turn_rows(&mut v, 0, 2, &r);
        }
        ([xx, yy, zz], v)
    }
}

#[inline(always)]
fn turn_rows<R: Real>(v: &mut [[R; 3]; 3], p: usize, q: usize, rotation: &Rotation<R>) {
    for i in 0..3 {
        (v[p][i], v[q][i]) = rotation.turn(v[p][i], v[q][i]);
    }
}

#[cfg(test)]
mod tests;
