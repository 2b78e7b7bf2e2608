//! Families of fibres that stiffen exponentially.

use super::Kinematics;
use crate::math::{Real, Sym3};

/// Where k₂ Ē² stops growing: so far beyond all tissue (e⁴⁰ = 2e17) the stress only has to stay a number.
const LARGEST_EXPONENT: f64 = 40.0;

/// One family: Ψ = k₁/(2k₂) (exp(k₂ Ē²) − 1), Ē = κ_d (Ī₁ − 3) + (1 − 3κ_d)(Ī₄ − 1) (Gasser, Ogden & Holzapfel
/// 2006; with κ_d = 0 Holzapfel, Gasser & Ogden 2000; its WGSL twin is `shaders/exponential_fibres.wgsl`).
///
/// Families add to an isotropic law, their ground substance: with the neo-Hookean law they are the authors' model,
/// whose c is μ there. Ē is the strain of the family. At small strains a family is as stiff as
/// [`Fibres`](super::Fibres) of η = k₁ (1 − 3κ_d)².
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ExponentialFibre<T> {
    /// Stiffness k₁ (Pa).
    pub k1: T,
    /// How fast it grows, k₂; 0: not at all.
    pub k2: T,
    /// Dispersion κ_d: 0 all along the direction, 1/3 in all directions alike.
    pub dispersion: T,
    /// 1: it only pulls (while Ē > 0); 0: it pushes back as well.
    pub tension_only: T,
}

impl<R: Real> ExponentialFibre<R> {
    /// The same family over other numbers.
    #[inline(always)]
    pub fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> ExponentialFibre<Q> {
        ExponentialFibre {
            k1: number(self.k1),
            k2: number(self.k2),
            dispersion: number(self.dispersion),
            tension_only: number(self.tension_only),
        }
    }

    /// 1 − 3κ_d.
    #[inline(always)]
    fn aligned(&self) -> R {
        self.k1.constant(-3.0).mul_add(self.dispersion, self.k1.constant(1.0))
    }

    /// k₂ Ē².
    #[inline(always)]
    fn exponent(&self, strain: R) -> R {
        (self.k2 * strain * strain).min(self.k2.constant(LARGEST_EXPONENT))
    }

    /// Ē, or 0 where the family does not pull, and I₄ − 1, for the unit direction `a`.
    #[inline(always)]
    fn strain(&self, k: &Kinematics<R>, a: [R; 3]) -> (R, R) {
        let i4_change = self.k1.constant(2.0) * k.green_strain.quadratic(a);
        let w = k.j_m23_change();
        let change = i4_change + w + w * i4_change;
        let strain = self.dispersion.mul_add(k.i1_change(), self.aligned() * change);
        (strain.max((self.k1.constant(1.0) - self.tension_only) * strain), i4_change)
    }

    /// Isochoric second Piola-Kirchhoff stress (Pa) of a family along the unit vector `a`: 2k₁ Ē exp(k₂ Ē²) ∂Ē/∂C.
    #[inline(always)]
    pub fn isochoric(&self, k: &Kinematics<R>, a: [R; 3]) -> Sym3<R> {
        let (strain, i4_change) = self.strain(k, a);
        let factor = self.k1.constant(2.0) * self.k1 * strain * self.exponent(strain).exp() * k.j_m23;
        // κ_d (I − I₁/3 C⁻¹) = κ_d C⁻¹ 2 dev E, and (1 − 3κ_d)(a⊗a − I₄/3 C⁻¹)
        let spread = k.inverse_c_times(&k.green_strain.deviator().scaled(self.dispersion + self.dispersion));
        let third = self.k1.constant(-1.0 / 3.0) / (k.j * k.j);
        let spherical = k.adjugate_c.scaled(third * (self.k1.constant(1.0) + i4_change));
        let along = Sym3::square_of(a).plus(&spherical).scaled(self.aligned());
        spread.plus(&along).scaled(factor)
    }

    /// Strain energy per rest volume (J/m³).
    #[inline(always)]
    pub fn energy(&self, k: &Kinematics<R>, a: [R; 3]) -> R {
        let strain = self.strain(k, a).0;
        let (square, one) = (strain * strain, self.k1.constant(1.0));
        // (exp(x) − 1)/k₂ is Ē² where k₂ = 0
        let grown = self.exponent(strain).exp_m1() / self.k2.if_positive(self.k2, one);
        self.k1.constant(0.5) * self.k1 * self.k2.if_positive(grown, square)
    }

    /// η of the [`Fibres`](super::Fibres) that are as stiff at small strains (Pa).
    pub fn small_strain_eta(&self) -> R {
        self.k1 * self.aligned() * self.aligned()
    }
}
