//! Hooke's law for small strains.

use super::elasticity::by_moduli;
use super::{Elastic, Kinematics, Law, Prerequisite};
use crate::math::{Mat3, Real, Sym3};
use crate::uniform::uniform;
use bevy_ecs::component::Component;

/// Ψ = μ dev ε:dev ε + κ/2 (tr ε)² with ε = ½(∇u + ∇uᵀ): the linear theory (Hooke; e.g. Bonet & Wood 2008, ch. 6; its
/// WGSL twin is `shaders/linear.wgsl`).
///
/// P = S = ∂Ψ/∂ε, without a difference between rest and deformed: right while strains **and rotations** stay below some
/// per cent. A rigid rotation by φ makes a strain of 1 − cos φ.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Linear<T: Send + Sync + 'static> {
    /// Shear modulus μ (Pa).
    pub shear: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

uniform!(Linear<f32> { shear, bulk });

impl Law for Linear<f64> {
    const PREREQUISITES: &'static [Prerequisite] = &[Prerequisite::Hooke];
    const LARGE_STRAINS: bool = false;
    by_moduli!();
}

impl<R: Real> Elastic<R> for Linear<R> {
    type Of<Q: Real> = Linear<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Linear<Q> {
        Linear { shear: number(self.shear), bulk: number(self.bulk) }
    }

    #[inline(always)]
    fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
        Kinematics::linear(gradient)
    }

    #[inline(always)]
    fn first_stress(&self, _: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        Mat3(isochoric.plus(&self.volumetric(k, pressure)).rows())
    }

    fn cauchy(&self, _: &Mat3<R>, _: R, first: &Mat3<R>) -> Sym3<R> {
        let p = &first.0;
        Sym3([p[0][0], p[1][1], p[2][2], p[0][1], p[1][2], p[0][2]])
    }

    /// 2μ dev ε.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        k.green_strain.deviator().scaled(self.shear + self.shear)
    }

    /// p I.
    #[inline(always)]
    fn volumetric(&self, k: &Kinematics<R>, pressure: R) -> Sym3<R> {
        k.adjugate_c.scaled(pressure)
    }

    /// A stress without a trace acts on no volume, ever.
    #[inline(always)]
    fn without_pressure(&self, _: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
        stress
    }

    /// κ tr ε.
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    /// μ dev ε:dev ε.
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        let deviator = k.green_strain.deviator();
        self.shear * deviator.contracted(&deviator)
    }

    /// κ/2 (tr ε)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn ends_at_no_volume(&self) -> bool {
        false
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        [self.shear, self.bulk]
    }
}
