//! Measures of an element's deformation that people look at: means over its points, by their share of the volume.

use super::{BlockView, ElementState};
use crate::components::FamilyDirection;
use crate::math::{Mat3, Sym3};

impl ElementState {
    /// Green-Lagrange strain E = ½(∇u + ∇uᵀ + ∇uᵀ∇u), whatever the law measures strain by: xx, yy, zz, xy, yz, xz.
    pub fn green_strain(&self) -> [f64; 6] {
        self.mean(|gradient| green_strain(gradient).0)
    }

    /// Principal stretches, the largest first: roots of the eigenvalues of C = 1 + 2E.
    pub fn principal_stretches(&self) -> [f64; 3] {
        self.mean(|gradient| {
            let stretches = green_strain(gradient).eigen().0.map(|strain| (1.0 + 2.0 * strain).max(0.0).sqrt());
            from_the_largest(stretches)
        })
    }

    fn mean<const N: usize>(&self, of: impl Fn(&Mat3<f64>) -> [f64; N]) -> [f64; N] {
        let mut mean = [0.0; N];
        for point in self.points() {
            mean.iter_mut().zip(of(&point.gradient)).for_each(|(sum, value)| *sum += point.share * value);
        }
        mean
    }
}

impl BlockView<'_> {
    /// Stretch |F a| along each family of fibres of the block: that of `fibres`, then those of `exponential_fibres`.
    pub fn fibre_stretches(&self, row: usize, state: &ElementState) -> Vec<f64> {
        let families = self.law.fibres.iter().map(|(_, from)| from);
        let families = families.chain(self.law.exponential.iter().map(|(_, from)| from));
        families.map(|from| self.stretch_along(row, state, from)).collect()
    }

    fn stretch_along(&self, row: usize, state: &ElementState, from: &FamilyDirection<f64>) -> f64 {
        let a = self.direction(row, from);
        let [stretch] = state.mean(|gradient| {
            let along = |row: usize| a[row] + (0..3).map(|i| gradient.0[row][i] * a[i]).sum::<f64>();
            [(0..3).map(|row| along(row).powi(2)).sum::<f64>().sqrt()]
        });
        stretch
    }

    /// Share of hourglass control in the energy of an element; 0 where there is no energy.
    pub fn hourglass_share(&self, row: usize, state: &ElementState) -> f64 {
        let hourglass = state.hourglass_energy(row, self.shape);
        let all = hourglass + self.energy(row, state) * state.volume;
        if all > 0.0 { hourglass / all } else { 0.0 }
    }
}

/// Principal values of a symmetric tensor (xx, yy, zz, xy, yz, xz), the largest first.
pub fn principal_values(tensor: &[f64; 6]) -> [f64; 3] {
    from_the_largest(Sym3(*tensor).eigen().0)
}

fn from_the_largest(mut values: [f64; 3]) -> [f64; 3] {
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

fn green_strain(gradient: &Mat3<f64>) -> Sym3<f64> {
    let h = &gradient.0;
    let entry = |i: usize, j: usize| 0.5 * (h[i][j] + h[j][i] + (0..3).map(|k| h[k][i] * h[k][j]).sum::<f64>());
    Sym3([entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)])
}
