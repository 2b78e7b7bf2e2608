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
mod tests {
    use super::super::Scalar;
    use super::*;

    fn entries<T: Scalar>(s: [f64; 6]) -> Sym3<T> {
        Sym3(s.map(T::from_f64))
    }

    /// Largest error of Σ e n nᵀ and of NᵀN, in units of the largest entry of s.
    fn error<T: Scalar>(s: [f64; 6]) -> f64 {
        let s = entries::<T>(s);
        let (values, vectors) = s.eigen();
        let largest = s.0.iter().fold(1e-300, |largest: f64, x| largest.max(x.to_f64().abs()));
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
        let mut worst = 0.0_f64;
        for (entry, (i, j)) in pairs.into_iter().enumerate() {
            let n = |axis: usize, i: usize| vectors[axis][i].to_f64();
            let whole: f64 = (0..3).map(|axis| values[axis].to_f64() * n(axis, i) * n(axis, j)).sum();
            let unit: f64 = (0..3).map(|axis| n(i, axis) * n(j, axis)).sum();
            worst = worst.max((whole - s.0[entry].to_f64()).abs() / largest);
            worst = worst.max((unit - f64::from(u8::from(i == j))).abs());
        }
        worst
    }

    #[test]
    fn eigenvalues_and_vectors_make_the_matrix_again() {
        // a pseudo-random walk through entries of very different size, signs, and equal entries
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let size = [1.0, 1.0, 1e-3, 1e-7, 0.0, 1.0, 30.0, 1e-12][(state >> 40) as usize % 8];
            size * ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
        };
        let (mut single, mut double) = (0.0_f64, 0.0_f64);
        for i in 0..40_000 {
            let mut s = [number(), number(), number(), number(), number(), number()];
            if i % 5 == 0 {
                s[1] = s[0];
            }
            if i % 7 == 0 {
                (s[2], s[4]) = (s[0], s[3]);
            }
            single = single.max(error::<f32>(s));
            double = double.max(error::<f64>(s));
        }
        println!("f32 {:.1} ε, f64 {:.1} ε", single / f64::from(f32::EPSILON), double / f64::EPSILON);
        assert!(single < 16.0 * f64::from(f32::EPSILON), "{single:e}");
        assert!(double < 16.0 * f64::EPSILON, "{double:e}");
    }

    #[test]
    fn matrices_of_nothing_and_of_next_to_nothing_have_eigenvectors_too() {
        for size in [0.0, 1e-45, 1e-38, 1e-30, 1e-20, 1e-18, 1e-10] {
            let s = [size, -size, 0.3 * size, 0.7 * size, size, -0.2 * size];
            let (values, vectors) = entries::<f32>(s).eigen();
            for axis in 0..3 {
                let length: f32 = vectors[axis].iter().map(|x| x * x).sum();
                assert!((length - 1.0).abs() < 1e-6, "{size:e}: {length}");
                assert!(f64::from(values[axis].abs()) <= 3.0 * size, "{size:e}: {values:?}");
            }
        }
    }
}
