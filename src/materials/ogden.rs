//! Ogden's law in principal stretches.

use super::{Elastic, Kinematics};
use crate::math::{Real, Sym3};
use bevy_ecs::component::Component;

/// Terms that an Ogden law can have.
pub const OGDEN_TERMS: usize = 4;

/// Below this squared stretch the logarithm is taken there: the square of [`J_FLOOR`](super::J_FLOOR).
const STRETCH_FLOOR: f64 = super::J_FLOOR * super::J_FLOOR;

/// Ψ_iso = Σ_p μ_p/α_p (λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3) with λ̄ = J^(−1/3) λ, U = κ/2 (J − 1)² (Ogden 1972; Holzapfel
/// 2000, §6.5; its WGSL twin is `shaders/ogden.wgsl`).
///
/// At small strains its shear modulus is ½ Σ μ_p α_p. Programs that write 2μ_p/α_p² instead of μ_p/α_p (Abaqus) mean by
/// their μ_p what is here ½ μ_p α_p.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ogden<T: Send + Sync + 'static> {
    /// μ_p (Pa); 0 of terms there are not.
    pub mu: [T; OGDEN_TERMS],
    /// α_p, not 0; 1 of terms there are not.
    pub alpha: [T; OGDEN_TERMS],
    /// Bulk modulus κ (Pa).
    pub bulk: T,
    /// How many terms there are.
    pub terms: u32,
}

impl Ogden<f64> {
    /// Of terms (μ_p in Pa, α_p), at most [`OGDEN_TERMS`] of which are taken, and κ (Pa).
    pub fn new(terms: &[(f64, f64)], bulk: f64) -> Self {
        let mut law = Self { mu: [0.0; OGDEN_TERMS], alpha: [1.0; OGDEN_TERMS], bulk, terms: 0 };
        for &(mu, alpha) in terms.iter().take(OGDEN_TERMS) {
            let number = law.terms as usize;
            (law.mu[number], law.alpha[number]) = (mu, alpha);
            law.terms += 1;
        }
        law
    }
}

/// ln λ̄ for each of the eigenvalues e of E: ½ ln(1 + 2e) less the mean of all three, ⅓ ln J.
#[inline(always)]
fn isochoric_logarithms<R: Real>(strains: [R; 3]) -> [R; 3] {
    let (half, lowest) = (strains[0].constant(0.5), strains[0].constant(STRETCH_FLOOR - 1.0));
    let mut logarithms = strains;
    for i in 0..3 {
        logarithms[i] = half * (strains[i] + strains[i]).max(lowest).ln_1p();
    }
    let mean = (logarithms[0] + logarithms[1] + logarithms[2]) * strains[0].constant(1.0 / 3.0);
    [logarithms[0] - mean, logarithms[1] - mean, logarithms[2] - mean]
}

impl<R: Real> Elastic<R> for Ogden<R> {
    type Of<Q: Real> = Ogden<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Ogden<Q> {
        let (m, a) = (&self.mu, &self.alpha);
        Ogden {
            mu: [number(m[0]), number(m[1]), number(m[2]), number(m[3])],
            alpha: [number(a[0]), number(a[1]), number(a[2]), number(a[3])],
            bulk: number(self.bulk),
            terms: self.terms,
        }
    }

    /// Σᵢ τᵢ/λᵢ² Nᵢ⊗Nᵢ, τᵢ = Σ_p μ_p (λ̄ᵢ^α_p − mean): of the eigenvalues of E, by e^(α ln λ̄) − 1, which keeps the
    /// digits of a small strain.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        let (strains, axes) = k.green_strain.eigen();
        let logarithms = isochoric_logarithms(strains);
        let (zero, one, third) = (self.bulk.constant(0.0), self.bulk.constant(1.0), self.bulk.constant(1.0 / 3.0));
        let mut tau = [zero; 3];
        for p in 0..self.terms as usize {
            let mut powers = logarithms;
            for i in 0..3 {
                powers[i] = (self.alpha[p] * logarithms[i]).exp_m1();
            }
            let mean = (powers[0] + powers[1] + powers[2]) * third;
            for i in 0..3 {
                tau[i] = self.mu[p].mul_add(powers[i] - mean, tau[i]);
            }
        }
        let mut stress = Sym3([zero; 6]);
        for i in 0..3 {
            let square = (one + (strains[i] + strains[i])).max(one.constant(STRETCH_FLOOR));
            stress = stress.plus(&Sym3::square_of(axes[i]).scaled(tau[i] / square));
        }
        stress
    }

    /// κ(J − 1).
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        let logarithms = isochoric_logarithms(k.green_strain.eigen().0);
        let mut energy = self.bulk.constant(0.0);
        for p in 0..self.terms as usize {
            for i in 0..3 {
                energy += self.mu[p] / self.alpha[p] * (self.alpha[p] * logarithms[i]).exp_m1();
            }
        }
        energy
    }

    /// κ/2 (J − 1)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        let mut shear = self.bulk.constant(0.0);
        for p in 0..self.terms as usize {
            shear += self.bulk.constant(0.5) * self.mu[p] * self.alpha[p];
        }
        [shear, self.bulk]
    }
}
