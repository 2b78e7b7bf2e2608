//! The St. Venant-Kirchhoff law.

use super::elasticity::by_moduli;
use super::{Elastic, Kinematics, Law, Prerequisite};
use crate::math::{Real, Sym3};
use crate::uniform::uniform;
use bevy_ecs::component::Component;

/// Ψ = μ dev E:dev E + κ/2 (tr E)²: Hooke's law in Green's strain (Bonet & Wood 2008, §6.4; its WGSL twin is
/// `shaders/st_venant_kirchhoff.wgsl`).
///
/// Right for large rotations with small strains. Squeezed it softens, and below a stretch of 1/√3 = .58 pushes back
/// ever less, down to nothing at 0: choose another law there. θ is tr E, which a shear changes too: so near
/// incompressibility it stiffens in shear as no rubber does.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct StVenantKirchhoff<T: Send + Sync + 'static> {
    /// Shear modulus μ (Pa).
    pub shear: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

uniform!(StVenantKirchhoff<f32> { shear, bulk });

impl Law for StVenantKirchhoff<f64> {
    const PREREQUISITES: &'static [Prerequisite] = &[Prerequisite::FiniteStrain, Prerequisite::Hooke];
    by_moduli!();
}

impl<R: Real> Elastic<R> for StVenantKirchhoff<R> {
    type Of<Q: Real> = StVenantKirchhoff<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> StVenantKirchhoff<Q> {
        StVenantKirchhoff { shear: number(self.shear), bulk: number(self.bulk) }
    }

    /// 2μ dev E.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        k.green_strain.deviator().scaled(self.shear + self.shear)
    }

    /// tr E.
    #[inline(always)]
    fn volume_measure(&self, k: &Kinematics<R>) -> R {
        k.green_strain.trace()
    }

    /// p I.
    #[inline(always)]
    fn volumetric(&self, _: &Kinematics<R>, pressure: R) -> Sym3<R> {
        let zero = pressure.constant(0.0);
        Sym3([pressure, pressure, pressure, zero, zero, zero])
    }

    /// A stress without a trace does not act on θ = tr E, whatever the deformation.
    #[inline(always)]
    fn without_pressure(&self, _: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
        stress
    }

    /// κ tr E.
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    /// μ dev E:dev E.
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        let deviator = k.green_strain.deviator();
        self.shear * deviator.contracted(&deviator)
    }

    /// κ/2 (tr E)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        [self.shear, self.bulk]
    }
}
