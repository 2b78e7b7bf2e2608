//! Cholesky's factor of a dense symmetric matrix.

/// What is left of a diagonal entry below this share of it is rounding: its unknown depends on those before.
const DEPENDENT: f64 = 1e-10;

/// A = L Lᵀ of a symmetric, positive semi-definite A; what depends on the unknowns before it is left out (its solution
/// is 0).
pub struct Cholesky {
    /// Rows of L up to the diagonal, one after the other.
    lower: Vec<f64>,
    /// 1/Lᵢᵢ; 0 of what is left out.
    per_pivot: Vec<f64>,
}

impl Cholesky {
    /// Of a matrix given by its rows up to the diagonal, one after the other.
    pub fn of(mut lower: Vec<f64>, size: usize) -> Self {
        let start = |row: usize| row * (row + 1) / 2;
        let mut per_pivot = vec![0.0; size];
        for i in 0..size {
            let (before, rest) = lower.split_at_mut(start(i));
            let row = &mut rest[..=i];
            let whole = row[i];
            for j in 0..i {
                let other = &before[start(j)..start(j) + j];
                row[j] = (row[j] - dot(&row[..j], other)) * per_pivot[j];
            }
            let left = whole - dot(&row[..i], &row[..i]);
            if left > DEPENDENT * whole {
                row[i] = left.sqrt();
                per_pivot[i] = 1.0 / row[i];
            }
        }
        Self { lower, per_pivot }
    }

    /// Its bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.lower[..]) + size_of_val(&self.per_pivot[..])
    }

    /// A⁻¹, row by row.
    pub fn inverse(&self) -> Vec<f64> {
        let size = self.per_pivot.len();
        let mut inverse = vec![0.0; size * size];
        // columns are rows: it is symmetric
        for (place, row) in inverse.chunks_exact_mut(size.max(1)).enumerate() {
            row[place] = 1.0;
            self.solve(row);
        }
        inverse
    }

    /// x of A x = b, in the place of b.
    pub fn solve(&self, b: &mut [f64]) {
        let start = |row: usize| row * (row + 1) / 2;
        for i in 0..b.len() {
            b[i] = (b[i] - dot(&self.lower[start(i)..start(i) + i], &b[..i])) * self.per_pivot[i];
        }
        for i in (0..b.len()).rev() {
            b[i] *= self.per_pivot[i];
            let x = b[i];
            b[..i].iter_mut().zip(&self.lower[start(i)..]).for_each(|(b, l)| *b -= l * x);
        }
    }
}

/// Eight sums side by side, which registers hold: in a fixed order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a8, a_rest) = a.as_chunks::<8>();
    let (b8, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a8.iter().zip(b8) {
        (0..8).for_each(|i| sums[i] += a[i] * b[i]);
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests;
