//! The neo-Hookean law in isochoric and volumetric parts.

use super::{Elastic, Kinematics};
use crate::math::{Real, Sym3};
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
