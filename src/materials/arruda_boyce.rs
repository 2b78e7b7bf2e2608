//! The eight-chain law of Arruda and Boyce.

use super::{Complaints, Elastic, Kinematics, Law};
use crate::math::{Real, Sym3};
use crate::uniform::uniform;
use bevy_ecs::component::Component;
use serde::{Deserialize, Serialize};

/// Ψ_iso = μ Σᵢ Cᵢ λ_m^(2−2i) (Ī₁ⁱ − 3ⁱ), i = 1 to 5, U = κ/2 (J − 1)² (Arruda & Boyce 1993: the inverse Langevin
/// function of the eight-chain model by its first five terms; its WGSL twin is `shaders/arruda_boyce.wgsl`).
///
/// Chains stiffen towards the locking stretch λ_m; the series stays finite there and beyond. At small strains the shear
/// modulus is above μ: μ(1 + 3/(5λ_m²) + 99/(175λ_m⁴) + 513/(875λ_m⁶) + 42039/(67375λ_m⁸)).
#[derive(Component, Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
#[repr(C)]
pub struct ArrudaBoyce<T: Send + Sync + 'static> {
    /// μ (Pa), n k T of the chains: below the shear modulus of small strains.
    pub shear: T,
    /// The locking stretch λ_m of a chain, above 1.
    pub locking_stretch: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

/// Where Ī₁ − 3 stops counting (chains stretched tenfold): so far beyond locking the stress only has to stay a number.
const LARGEST_CHANGE: f64 = 100.0;

/// The locking stretch that [`Law::with_moduli`] gives.
const LOCKING_STRETCH: f64 = 2.0;

/// Cᵢ.
const SERIES: [f64; 5] = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

impl<R: Real> ArrudaBoyce<R> {
    /// Ψ_iso/μ and its derivative by Ī₁, for Ī₁ = 3 + `change`. Ī₁ⁱ − 3ⁱ = (Ī₁ − 3) qᵢ, q₁ = 1, qᵢ₊₁ = Ī₁ qᵢ + 3ⁱ:
    /// nothing cancels at small strains.
    #[inline(always)]
    fn series(&self, change: R) -> (R, R) {
        let i1 = self.shear.constant(3.0) + change;
        let chain = self.shear.constant(1.0) / (self.locking_stretch * self.locking_stretch);
        let (mut quotient, mut power, mut factor) = (self.shear.constant(1.0), self.shear.constant(1.0), change);
        let (mut energy, mut slope) = (self.shear.constant(0.0), self.shear.constant(0.0));
        let mut three_to = 1.0;
        for i in 0..5 {
            let c = self.shear.constant(SERIES[i]);
            energy = (c * factor).mul_add(quotient, energy);
            slope = self.shear.constant(SERIES[i] * (i + 1) as f64).mul_add(power, slope);
            three_to *= 3.0;
            quotient = i1.mul_add(quotient, self.shear.constant(three_to));
            // chain and power stand for i − 1 of each
            power = power * i1 * chain;
            factor = factor * chain;
        }
        (energy, slope)
    }
}

uniform!(ArrudaBoyce<f32> { shear, locking_stretch, bulk });

impl Law for ArrudaBoyce<f64> {
    type Parameters = Self;

    fn of(parameters: &Self) -> Self {
        *parameters
    }

    fn check(&Self { shear, locking_stretch, bulk }: &Self, complaints: &mut Complaints) {
        complaints.above_zero("shear", shear, "Pa");
        if locking_stretch <= 1.0 {
            complaints
                .must("locking_stretch", "above 1", locking_stretch)
                .note("chains at rest are stretched to 1 already; a large value gives the neo-Hookean law");
        }
        complaints.bulk_modulus(bulk, shear, "`shear`");
    }

    fn with_moduli(shear: f64, bulk: f64) -> Self {
        let of_one = Self { shear: 1.0, locking_stretch: LOCKING_STRETCH, bulk };
        Self { shear: shear / of_one.small_strain_moduli()[0], ..of_one }
    }
}

impl<R: Real> Elastic<R> for ArrudaBoyce<R> {
    type Of<Q: Real> = ArrudaBoyce<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> ArrudaBoyce<Q> {
        ArrudaBoyce {
            shear: number(self.shear),
            locking_stretch: number(self.locking_stretch),
            bulk: number(self.bulk),
        }
    }

    /// 2 ∂Ψ/∂Ī₁ J^(−2/3) (I − I₁/3 C⁻¹).
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        let (_, slope) = self.series(k.i1_change().min(self.shear.constant(LARGEST_CHANGE)));
        let factor = self.shear.constant(4.0) * self.shear * slope * k.j_m23;
        k.inverse_c_times(&k.green_strain.deviator().scaled(factor))
    }

    /// κ(J − 1).
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.shear * self.series(k.i1_change()).0
    }

    /// κ/2 (J − 1)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        let (_, slope) = self.series(self.shear.constant(0.0));
        [self.shear.constant(2.0) * self.shear * slope, self.bulk]
    }
}
