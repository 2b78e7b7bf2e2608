//! The Mooney-Rivlin law.

use super::{Elastic, Kinematics};
use crate::math::{Real, Sym3};
use bevy_ecs::component::Component;

/// Ψ_iso = c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3), U = κ/2 (J − 1)² (Mooney 1940; Rivlin 1948; Holzapfel 2000, §6.5; its
/// WGSL twin is `shaders/mooney_rivlin.wgsl`). Ī₂ = J^(−4/3) ½((tr C)² − tr C²).
///
/// At small strains its shear modulus is 2(c₁₀ + c₀₁). With c₀₁ = 0 it is the neo-Hookean law of μ = 2c₁₀.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct MooneyRivlin<T: Send + Sync + 'static> {
    /// c₁₀ (Pa).
    pub c10: T,
    /// c₀₁ (Pa).
    pub c01: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

impl<R: Real> Elastic<R> for MooneyRivlin<R> {
    type Of<Q: Real> = MooneyRivlin<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> MooneyRivlin<Q> {
        MooneyRivlin { c10: number(self.c10), c01: number(self.c01), bulk: number(self.bulk) }
    }

    /// 2c₁₀ J^(−2/3) (I − I₁/3 C⁻¹) + 2c₀₁ J^(−4/3) (I₁ I − C − 2/3 I₂ C⁻¹).
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        k.stress_of_slopes(self.c10, self.c01)
    }

    /// κ(J − 1).
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    /// c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3).
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.c10 * k.i1_change() + self.c01 * k.i2_change()
    }

    /// κ/2 (J − 1)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        [self.bulk.constant(2.0) * (self.c10 + self.c01), self.bulk]
    }
}
