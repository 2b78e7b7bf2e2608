//! What springs add to coarse levels, without making their factors anew.

use super::aggregates::RIGID;
use std::collections::BTreeMap;

/// Aggregates at most that springs may act on: G is found anew in each of Newton's iterations, by as many operations as
/// the cube of them.
pub const MOST_TOUCHED: usize = 32;

/// (A + U S Uᵀ)⁻¹ = A⁻¹ − A⁻¹U G UᵀA⁻¹ with G = S (I + Uᵀ A⁻¹ U S)⁻¹ (Woodbury 1950), A the matrices of all pieces one
/// after the other, U the unknowns of the aggregates that springs act on and S what these make of them.
#[derive(Default)]
pub struct Touched {
    /// Of each aggregate that has been touched where its piece's unknowns begin, and the columns of A⁻¹ of its own.
    known: BTreeMap<usize, (usize, Vec<Vec<f64>>)>,
    /// The unknowns that are touched now, ascending.
    unknowns: Vec<usize>,
    /// G, row by row (N/m).
    correction: Vec<f64>,
}

impl Touched {
    /// Forgets what was of other factors.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Its bytes.
    pub fn bytes(&self) -> usize {
        let columns: usize = self.known.values().flat_map(|(_, all)| all).map(|column| size_of_val(&column[..])).sum();
        columns + size_of_val(&self.correction[..]) + size_of_val(&self.unknowns[..])
    }

    /// Takes what springs make of these aggregates, ascending: S, row by row (N/m). `columns` are those of A⁻¹ of an
    /// aggregate, in the unknowns of its piece, which begin somewhere.
    pub fn take(
        &mut self,
        aggregates: &[usize],
        stiffness: Vec<f64>,
        columns: impl Fn(usize) -> (usize, Vec<Vec<f64>>),
    ) {
        for &aggregate in aggregates {
            self.known.entry(aggregate).or_insert_with(|| columns(aggregate));
        }
        self.unknowns = aggregates.iter().flat_map(|aggregate| RIGID * aggregate..RIGID * (aggregate + 1)).collect();
        self.correction = self.corrected(stiffness).unwrap_or_default();
        if self.correction.is_empty() {
            self.unknowns.clear();
        }
    }

    /// The column of A⁻¹ of an unknown that is touched, and where it begins.
    fn column(&self, unknown: usize) -> (usize, &[f64]) {
        match self.known.get(&(unknown / RIGID)) {
            Some((first, columns)) => (*first, &columns[unknown % RIGID]),
            None => (0, &[]),
        }
    }

    /// G by elimination with pivots of (I + S W) G = S, W = Uᵀ A⁻¹ U; `None` where it is singular.
    fn corrected(&self, stiffness: Vec<f64>) -> Option<Vec<f64>> {
        let count = self.unknowns.len();
        let (mut right, mut left) = (stiffness, vec![0.0; count * count]);
        for j in 0..count {
            let (first, column) = self.column(self.unknowns[j]);
            let entry = |unknown: usize| unknown.checked_sub(first).and_then(|own| column.get(own)).copied();
            let entries: Vec<f64> = self.unknowns.iter().map(|&unknown| entry(unknown).unwrap_or(0.0)).collect();
            for i in 0..count {
                let row = &right[count * i..count * (i + 1)];
                let product: f64 = row.iter().zip(&entries).map(|(s, entry)| s * entry).sum();
                left[count * i + j] = product + f64::from(u8::from(i == j));
            }
        }
        let (mut of_left, mut of_right) = (vec![0.0; count], vec![0.0; count]);
        let less = |row: &mut [f64], factor: f64, other: &[f64]| {
            row.iter_mut().zip(other).for_each(|(entry, other)| *entry -= factor * other);
        };
        for k in 0..count {
            let pivot = (k..count).max_by(|&a, &b| left[count * a + k].abs().total_cmp(&left[count * b + k].abs()))?;
            for j in 0..count {
                left.swap(count * k + j, count * pivot + j);
                right.swap(count * k + j, count * pivot + j);
            }
            let per_pivot = 1.0 / left[count * k + k];
            if !per_pivot.is_finite() {
                return None;
            }
            let row = |i: usize| count * i..count * (i + 1);
            of_left.copy_from_slice(&left[row(k)]);
            of_right.copy_from_slice(&right[row(k)]);
            for i in (0..count).filter(|&i| i != k) {
                let factor = left[count * i + k] * per_pivot;
                if factor != 0.0 {
                    less(&mut left[row(i)][k..], factor, &of_left[k..]);
                    less(&mut right[row(i)], factor, &of_right);
                }
            }
            right[row(k)].iter_mut().chain(&mut left[row(k)][k..]).for_each(|entry| *entry *= per_pivot);
        }
        // symmetric to the last bit, as what conjugate gradients are preconditioned with must be
        let mean = |i: usize, j: usize| 0.5 * (right[count * i + j] + right[count * j + i]);
        Some((0..count * count).map(|at| mean(at / count, at % count)).collect())
    }

    /// Makes x = A⁻¹ b what it is with the springs.
    pub fn correct(&self, x: &mut [f64]) {
        let count = self.unknowns.len();
        let at: Vec<f64> = self.unknowns.iter().map(|&unknown| x[unknown]).collect();
        for (row, &unknown) in self.correction.chunks_exact(count.max(1)).zip(&self.unknowns) {
            let less: f64 = row.iter().zip(&at).map(|(g, x)| g * x).sum();
            let (first, column) = self.column(unknown);
            x[first..].iter_mut().zip(column).for_each(|(x, column)| *x -= less * column);
        }
    }
}

#[cfg(test)]
mod tests;
