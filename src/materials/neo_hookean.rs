//! The neo-Hookean law in isochoric and volumetric parts.

use super::elasticity::by_moduli;
use super::kinematics::twice_green_strain;
use super::{Elastic, Fibres, J_FLOOR, Kinematics, Law};
use crate::math::{Mat3, Real, Sym3, dot, dot_plus, minor};
use crate::uniform::uniform;
use bevy_ecs::component::Component;

/// Ψ_iso = μ/2 (Ī₁ − 3), Ψ_vol = κ/2 (J − 1)² (Comas et al. 2008, eq. 2; its WGSL twin is `shaders/neo_hookean.wgsl`).
///
/// At small strains its shear modulus is μ, its bulk modulus κ, its Young's modulus 9κμ/(3κ+μ). Finite at J → 0, so it
/// cannot prevent inversion: see [`J_FLOOR`](super::J_FLOOR).
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NeoHookean<T: Send + Sync + 'static> {
    /// Shear modulus μ (Pa).
    pub shear: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

uniform!(NeoHookean<f32> { shear, bulk });

impl Law for NeoHookean<f64> {
    by_moduli!();
}

impl<R: Real> Elastic<R> for NeoHookean<R> {
    type Of<Q: Real> = NeoHookean<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> NeoHookean<Q> {
        NeoHookean { shear: number(self.shear), bulk: number(self.bulk) }
    }

    /// μJ^(−2/3)(I − tr C/3 C⁻¹), written as μJ^(−2/3) C⁻¹·2 dev E, which keeps the digits of a small strain.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        let e = &k.green_strain.0;
        let mean = k.green_strain.trace() * self.shear.constant(1.0 / 3.0);
        let deviator = Sym3([e[0] - mean, e[1] - mean, e[2] - mean, e[3], e[4], e[5]]);
        let factor = self.shear.constant(2.0) * self.shear * k.j_m23 / (k.j * k.j);
        k.adjugate_c.times_coaxial(&deviator).scaled(factor)
    }

    /// With H = ∇u and cof F = I + K, K = tr H I − Hᵀ + cof H: P = μ' F − q cof F + s (F a)⊗a, where μ' = μJ^(−2/3), s
    /// = 2η(Ī₄ − 1)J^(−2/3) and q = (μ' tr C + s I₄)/(3J) − p. Terms of the size of μ cancel: what is left is written
    /// out, with H + Hᵀ first, so that small strains keep their digits. A third less work than by way of S.
    #[inline(always)]
    fn direct_stress(
        &self,
        gradient: &Mat3<R>,
        pressure: Option<R>,
        fibres: Option<(Fibres<R>, [R; 3])>,
    ) -> (Mat3<R>, R) {
        let h = &gradient.0;
        let (one, two, three) = (self.shear.constant(1.0), self.shear.constant(2.0), self.shear.constant(3.0));
        let cofactor = [
            [
                minor(h[1][1], h[1][2], h[2][1], h[2][2]),
                minor(h[1][2], h[1][0], h[2][2], h[2][0]),
                minor(h[1][0], h[1][1], h[2][0], h[2][1]),
            ],
            [
                minor(h[0][2], h[0][1], h[2][2], h[2][1]),
                minor(h[0][0], h[0][2], h[2][0], h[2][2]),
                minor(h[0][1], h[0][0], h[2][1], h[2][0]),
            ],
            [
                minor(h[0][1], h[0][2], h[1][1], h[1][2]),
                minor(h[0][2], h[0][0], h[1][2], h[1][0]),
                minor(h[0][0], h[0][1], h[1][0], h[1][1]),
            ],
        ];
        let trace = h[0][0] + h[1][1] + h[2][2];
        let change = trace + (cofactor[0][0] + cofactor[1][1] + cofactor[2][2]) + dot(h[0], cofactor[0]);
        let true_j = one + change;
        let change = change.max(one.constant(J_FLOOR - 1.0));
        let j = one + change;
        let j_m13 = j.inverse_cbrt();
        let j_m23 = j_m13 * j_m13;
        // 1/J, where a division would take as long as all of the rest
        let third_per_j = j_m23 * j_m13 * one.constant(1.0 / 3.0);
        let shear = self.shear * j_m23;
        // tr C − 3
        let longer = dot_plus(h[0], h[0], dot_plus(h[1], h[1], dot_plus(h[2], h[2], two * trace)));
        let pressure = match pressure {
            Some(pressure) => pressure,
            None => self.bulk * change,
        };
        // μ' − q
        let mut difference = (shear * third_per_j).mul_add(three.mul_add(change, -longer), pressure);
        let mut pulled = None;
        if let Some((fibres, a)) = fibres {
            let (pull, fa, i4) = fibres.pull(h, a, change, j_m23);
            difference -= pull * i4 * third_per_j;
            pulled = Some((pull, fa, a));
        }
        let q = shear - difference;
        let mut stress = Mat3::zero(one);
        let diagonal = difference - q * trace;
        for i in 0..3 {
            for k in 0..3 {
                let symmetric = (h[i][k] + h[k][i]) - cofactor[i][k];
                let entry = q.mul_add(symmetric, difference * h[i][k]);
                stress.0[i][k] = if i == k { entry + diagonal } else { entry };
            }
        }
        if let Some((pull, fa, a)) = pulled {
            for i in 0..3 {
                stress.add_to_row(i, pull * fa[i], a);
            }
        }
        (stress, true_j)
    }

    /// With T = 2E and D = adj C − I = tr T I − T + adj T: S_iso = d I − (μ' − d) D + s (a⊗a − I₄/(3J²) (I + D)), where
    /// d = μ'(3(J² − 1) − tr T)/(3J²) is what is left of terms of the size of μ; the pressure adds p/J (I + D). Little
    /// waits for s, which comes last.
    #[inline(always)]
    fn stress_relaxed(
        &self,
        gradient: &Mat3<R>,
        pressure: Option<R>,
        fibres: Option<(Fibres<R>, Sym3<R>)>,
        relax: impl FnOnce(Sym3<R>, Sym3<R>) -> Sym3<R>,
    ) -> (Mat3<R>, R) {
        let (one, two, three) = (self.shear.constant(1.0), self.shear.constant(2.0), self.shear.constant(3.0));
        let change = gradient.volume_change();
        let true_j = one + change;
        let change = change.max(one.constant(J_FLOOR - 1.0));
        let j_m13 = (one + change).inverse_cbrt();
        let j_m23 = j_m13 * j_m13;
        // 1/J and 1/(3J²), where a division would take as long as all of the rest
        let per_j = j_m23 * j_m13;
        let third_per_j2 = per_j * per_j * one.constant(1.0 / 3.0);
        let twice_strain = Sym3(twice_green_strain(gradient));
        let adjugate_change = twice_strain.adjugate_change();
        let adjugate = adjugate_change.plus_diagonal(one);
        let shear = self.shear * j_m23;
        let left = shear * third_per_j2 * three.mul_add(change * (two + change), -twice_strain.trace());
        let mut isochoric = adjugate_change.scaled(left - shear).plus_diagonal(left);
        if let Some((fibres, square)) = fibres {
            let (pull, i4) = fibres.pull_of(twice_strain.contracted(&square), change, j_m23);
            let spherical = -(i4 * third_per_j2);
            isochoric = isochoric.plus_scaled(pull, &square.plus_scaled(spherical, &adjugate));
        }
        let pressure = match pressure {
            Some(pressure) => pressure,
            None => self.bulk * change,
        };
        let volumetric = adjugate.scaled(pressure * per_j);
        (gradient.plus_identity_times(&relax(isochoric, volumetric)), true_j)
    }

    /// κ(J − 1).
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    /// μ/2 (Ī₁ − 3).
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.shear.constant(0.5) * self.shear * k.i1_change()
    }

    /// κ/2 (J − 1)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.shear.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        [self.shear, self.bulk]
    }
}
