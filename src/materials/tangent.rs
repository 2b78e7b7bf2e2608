//! Tangents of laws from an energy: how their stress answers to a change of strain, from second derivatives of the
//! energy's graph.

use super::{IsochoricStress, Kinematics, LawPrograms};
use crate::math::{Real, Sym3};

impl LawPrograms {
    /// ΔS = 4 ∂²Ψ/∂C² : ΔE (Pa) for a change ΔE of Green's strain, of a law from an energy; none of others. S is the
    /// whole second Piola-Kirchhoff stress.
    ///
    /// With A = ∂Ī₁/∂C and B = ∂Ī₂/∂C it is 2 (Ψ₁ ΔA + Ψ₂ ΔB + ΔΨ₁ A + ΔΨ₂ B) + Δ(U' J) C⁻¹ − U' J C⁻¹ ΔC C⁻¹
    /// (Holzapfel 2000, §6.6). Against differences of the stress it errs by less than 1e-8 of itself
    /// (`tests/physics/energy_digits.rs`).
    pub fn tangent_times<R: Real>(&self, k: &Kinematics<R>, strain_change: &Sym3<R>) -> Option<Sym3<R>> {
        let IsochoricStress::Slopes(slopes) = &self.isochoric else { return None };
        let number = |x: f64| k.j.constant(x);
        let [first, second] = slopes.at(k);
        let [first_first, first_second, second_second] = slopes.curvatures_at(k);
        let (pressure, stiffness) =
            (self.pressure_at(k.volume_change), slopes.volumetric_stiffness_at(k.volume_change));
        let (one, two, third) = (number(1.0), number(2.0), number(1.0 / 3.0));

        let change = strain_change.scaled(two);
        let inverse = k.adjugate_c.scaled(one / (k.j * k.j));
        let strain = k.green_strain.scaled(two);
        let c = strain.plus_diagonal(one);
        let (i1, i2) = (c.trace(), k.adjugate_c.trace());
        // ∂I₂/∂C
        let of_second = c.scaled(-one).plus_diagonal(i1);
        let (a, b) = (k.stress_of_slope(number(0.5)), k.stress_of_slopes(number(0.0), number(0.5)));

        let grown = inverse.contracted(&change);
        let turned = between(&inverse, &change);
        let j_m43 = k.j_m23 * k.j_m23;
        let a_change = inverse
            .scaled(-change.trace())
            .plus_scaled(i1, &turned)
            .scaled(k.j_m23 * third)
            .plus_scaled(-grown * third, &a);
        let b_change = inverse
            .scaled(-of_second.contracted(&change))
            .plus_scaled(i2, &turned)
            .scaled(two * third)
            .plus_scaled(-one, &change)
            .plus_diagonal(change.trace())
            .scaled(j_m43)
            .plus_scaled(-two * grown * third, &b);
        let (along_a, along_b) = (a.contracted(&change), b.contracted(&change));
        let first_change = first_first * along_a + first_second * along_b;
        let second_change = first_second * along_a + second_second * along_b;
        let volumetric = (stiffness * k.j + pressure) * k.j * number(0.5) * grown;
        Some(
            a_change
                .scaled(two * first)
                .plus_scaled(two * second, &b_change)
                .plus_scaled(two * first_change, &a)
                .plus_scaled(two * second_change, &b)
                .plus_scaled(volumetric, &inverse)
                .plus_scaled(-pressure * k.j, &turned),
        )
    }
}

/// M X M for symmetric matrices.
fn between<R: Real>(m: &Sym3<R>, x: &Sym3<R>) -> Sym3<R> {
    let (m, x) = (m.rows(), x.rows());
    let entry = |i: usize, j: usize| {
        let mut sum = m[0][0].constant(0.0);
        for (k, row) in x.iter().enumerate() {
            for (l, value) in row.iter().enumerate() {
                sum += m[i][k] * *value * m[l][j];
            }
        }
        sum
    };
    Sym3([entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)])
}
