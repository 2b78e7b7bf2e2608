//! The Mooney-Rivlin law.

use super::complaints::number as show;
use super::{Complaints, Elastic, Kinematics, Law};
use crate::math::{Real, Sym3};
use crate::uniform::uniform;
use bevy_ecs::component::Component;
use serde::{Deserialize, Serialize};

/// Ψ_iso = c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3), U = κ/2 (J − 1)² (Mooney 1940; Rivlin 1948; Holzapfel 2000, §6.5; its
/// WGSL twin is `shaders/mooney_rivlin.wgsl`). Ī₂ = J^(−4/3) ½((tr C)² − tr C²).
///
/// At small strains its shear modulus is 2(c₁₀ + c₀₁). With c₀₁ = 0 it is the neo-Hookean law of μ = 2c₁₀.
#[derive(Component, Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
#[repr(C)]
pub struct MooneyRivlin<T: Send + Sync + 'static> {
    /// c₁₀ (Pa); c₁₀ + c₀₁ is half the shear modulus of small strains.
    pub c10: T,
    /// c₀₁ (Pa).
    pub c01: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

uniform!(MooneyRivlin<f32> { c10, c01, bulk });

impl Law for MooneyRivlin<f64> {
    type Parameters = Self;

    fn of(parameters: &Self) -> Self {
        *parameters
    }

    fn check(&Self { c10, c01, bulk }: &Self, complaints: &mut Complaints) {
        let sum = c10 + c01;
        if sum <= 0.0 {
            complaints
                .error("c10", format!("`c10` + `c01` must be above 0, found {} Pa", show(sum)))
                .note("twice their sum is the shear modulus of small strains");
        } else if c10 < 0.0 || c01 < 0.0 {
            let word = if c10 < 0.0 { "c10" } else { "c01" };
            complaints
                .warn(word, format!("`{word}` is below 0: at some large stretch the law loses its stiffness"))
                .note("it is safe at every stretch when both are 0 or above");
        }
        complaints.bulk_modulus(bulk, 2.0 * sum, "of 2 (`c10` + `c01`)");
    }

    /// With equal constants.
    fn with_moduli(shear: f64, bulk: f64) -> Self {
        Self { c10: 0.25 * shear, c01: 0.25 * shear, bulk }
    }
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
