//! 3×3 tensors over any [`Real`].

use super::Real;

/// A 3×3 matrix, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Mat3<R>(pub [[R; 3]; 3]);

/// A symmetric 3×3 matrix: xx, yy, zz, xy, yz, xz.
#[derive(Clone, Copy, Debug)]
pub struct Sym3<R>(pub [R; 6]);

/// a·b. (Small functions marked for inlining, here and below, not closures: only those melt into vector code.)
#[inline(always)]
pub fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

/// a·b + c.
#[inline(always)]
pub fn dot_plus<R: Real>(a: [R; 3], b: [R; 3], c: R) -> R {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0].mul_add(b[0], c)))
}

/// a d − b c.
#[inline(always)]
pub fn minor<R: Real>(a: R, b: R, c: R, d: R) -> R {
    a.mul_add(d, -(b * c))
}

impl<R: Real> Mat3<R> {
    /// det(I + A) − 1 = tr K + first row of A · first row of K less what both have, with K = cof(I + A) − I: exact to
    /// rounding for small A.
    #[inline(always)]
    pub fn volume_change(&self) -> R {
        let h = &self.0;
        let k = [
            minor(h[1][1], h[1][2], h[2][1], h[2][2]) + (h[1][1] + h[2][2]),
            minor(h[1][2], h[1][0], h[2][2], h[2][0]) - h[1][0],
            minor(h[1][0], h[1][1], h[2][0], h[2][1]) - h[2][0],
        ];
        // (e + h)·(e + k) − 1 with the first axis e
        dot_plus(h[0], k, h[0][0] + k[0])
    }

    /// cof(I + A).
    #[inline(always)]
    pub fn cofactor_with_identity(&self) -> Self {
        let mut f = self.0;
        for i in 0..3 {
            f[i][i] += f[i][i].constant(1.0);
        }
        let [a, b, c] = f;
        let cross = [[b, c], [c, a], [a, b]];
        let mut rows = f;
        for i in 0..3 {
            let [v, w] = cross[i];
            rows[i] = [minor(v[1], v[2], w[1], w[2]), minor(v[2], v[0], w[2], w[0]), minor(v[0], v[1], w[0], w[1])];
        }
        Self(rows)
    }

    /// All zero, of the same kind as a number.
    #[inline(always)]
    pub fn zero(like: R) -> Self {
        Mat3([[like.constant(0.0); 3]; 3])
    }

    /// (I + self)·s for a symmetric s: with self = ∇u this is F S.
    #[inline(always)]
    pub fn plus_identity_times(&self, s: &Sym3<R>) -> Self {
        let (m, s) = (&self.0, s.rows());
        let mut product = Mat3(s);
        for i in 0..3 {
            for j in 0..3 {
                product.0[i][j] = dot_plus(m[i], s[j], s[i][j]);
            }
        }
        product
    }

    /// All entries times a number.
    #[inline(always)]
    pub fn scaled(mut self, factor: R) -> Self {
        for i in 0..3 {
            for j in 0..3 {
                self.0[i][j] = self.0[i][j] * factor;
            }
        }
        self
    }

    /// Adds a multiple of a vector to row `i`.
    #[inline(always)]
    pub fn add_to_row(&mut self, i: usize, factor: R, vector: [R; 3]) {
        for j in 0..3 {
            self.0[i][j] = factor.mul_add(vector[j], self.0[i][j]);
        }
    }
}

impl<R: Real> Sym3<R> {
    /// All nine entries, row by row.
    #[inline(always)]
    pub fn rows(&self) -> [[R; 3]; 3] {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    }

    /// Entry by entry: self + other.
    #[inline(always)]
    pub fn plus(mut self, other: &Self) -> Self {
        for i in 0..6 {
            self.0[i] += other.0[i];
        }
        self
    }

    /// All entries times a number.
    #[inline(always)]
    pub fn scaled(mut self, factor: R) -> Self {
        for i in 0..6 {
            self.0[i] = self.0[i] * factor;
        }
        self
    }

    /// self + factor · other.
    #[inline(always)]
    pub fn plus_scaled(mut self, factor: R, other: &Self) -> Self {
        for i in 0..6 {
            self.0[i] = factor.mul_add(other.0[i], self.0[i]);
        }
        self
    }

    /// self + number · I.
    #[inline(always)]
    pub fn plus_diagonal(mut self, number: R) -> Self {
        for i in 0..3 {
            self.0[i] += number;
        }
        self
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(&self) -> R {
        self.0[0] + self.0[1] + self.0[2]
    }

    /// The adjugate: the inverse times the determinant.
    #[inline(always)]
    pub fn adjugate(&self) -> Self {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        Sym3([
            minor(yy, yz, yz, zz),
            minor(xx, xz, xz, zz),
            minor(xx, xy, xy, yy),
            minor(xz, xy, zz, yz),
            minor(xy, xx, yz, xz),
            minor(xy, yy, xz, yz),
        ])
    }

    /// The adjugate of I + self, less I; keeps the digits of a small matrix.
    #[inline(always)]
    pub fn adjugate_change(&self) -> Self {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        let one = xx.constant(1.0);
        let (cx, cy, cz) = (one + xx, one + yy, one + zz);
        Sym3([
            (-yz).mul_add(yz, yy.mul_add(zz, yy + zz)),
            (-xz).mul_add(xz, xx.mul_add(zz, xx + zz)),
            (-xy).mul_add(xy, xx.mul_add(yy, xx + yy)),
            minor(xz, xy, cz, yz),
            minor(xy, cx, yz, xz),
            minor(xy, cy, xz, yz),
        ])
    }

    /// The product with a symmetric matrix that has the same eigenvectors (so that the product is symmetric).
    #[inline(always)]
    pub fn times_coaxial(&self, other: &Self) -> Self {
        let (a, b) = (self.rows(), other.rows());
        Sym3([dot(a[0], b[0]), dot(a[1], b[1]), dot(a[2], b[2]), dot(a[0], b[1]), dot(a[1], b[2]), dot(a[0], b[2])])
    }

    /// The deviator: self less a third of its trace on the diagonal.
    #[inline(always)]
    pub fn deviator(mut self) -> Self {
        let mean = self.trace() * self.0[0].constant(1.0 / 3.0);
        for i in 0..3 {
            self.0[i] -= mean;
        }
        self
    }

    /// self:other, the sum of the products of all nine entries.
    #[inline(always)]
    pub fn contracted(&self, other: &Self) -> R {
        let (a, b) = (&self.0, &other.0);
        let others = dot([a[3], a[4], a[5]], [b[3], b[4], b[5]]);
        dot_plus([a[0], a[1], a[2]], [b[0], b[1], b[2]], others + others)
    }

    /// v·self·v.
    #[inline(always)]
    pub fn quadratic(&self, v: [R; 3]) -> R {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        let two = xx.constant(2.0);
        xx * v[0] * v[0]
            + yy * v[1] * v[1]
            + zz * v[2] * v[2]
            + two * (xy * v[0] * v[1] + yz * v[1] * v[2] + xz * v[0] * v[2])
    }

    /// v vᵀ.
    #[inline(always)]
    pub fn square_of(v: [R; 3]) -> Self {
        Sym3([v[0] * v[0], v[1] * v[1], v[2] * v[2], v[0] * v[1], v[1] * v[2], v[0] * v[2]])
    }
}
