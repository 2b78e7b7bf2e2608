//! One family of fibres: transverse isotropy.

use super::Kinematics;
use super::kinematics::j_m23_change;
use crate::math::{Real, Sym3, dot, dot_plus};
use bevy_ecs::component::Component;

/// Ψ = η/2 (Ī₄ − 1)² with Ī₄ = J^(−2/3) a·C a (Comas et al. 2008, eq. 2; its WGSL twin is `shaders/fibres.wgsl`).
///
/// Other TLED codes leave out the factor 2 of its derivative and so mean Ψ = η/4 (Ī₄ − 1)²: their η is twice ours.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Fibres<T: Send + Sync + 'static> {
    /// Stiffness η (Pa).
    pub eta: T,
    /// 1: fibres only pull; 0: they push back as well, as in the paper.
    pub tension_only: T,
}

impl<R: Real> Fibres<R> {
    /// The same fibres over other numbers.
    #[inline(always)]
    pub fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Fibres<Q> {
        Fibres { eta: number(self.eta), tension_only: number(self.tension_only) }
    }

    /// Ī₄ − 1 and I₄ for a⊗a of the unit direction a, exact to rounding for small strains.
    #[inline(always)]
    fn stretch(&self, k: &Kinematics<R>, along_squared: &Sym3<R>) -> (R, R) {
        let (one, two) = (self.eta.constant(1.0), self.eta.constant(2.0));
        let i4_change = two * k.green_strain.contracted(along_squared);
        let w = k.j_m23_change();
        let change = i4_change + w + w * i4_change;
        (change, one + i4_change)
    }

    #[inline(always)]
    fn pulling(&self, change: R) -> R {
        change.max((self.eta.constant(1.0) - self.tension_only) * change)
    }

    /// Isochoric second Piola-Kirchhoff stress (Pa) of fibres along the unit vector `a`:
    /// 2η(Ī₄ − 1) J^(−2/3) (a⊗a − I₄/3 C⁻¹).
    #[inline(always)]
    pub fn isochoric(&self, k: &Kinematics<R>, a: [R; 3]) -> Sym3<R> {
        self.isochoric_along(k, &Sym3::square_of(a))
    }

    /// The same from a⊗a.
    #[inline(always)]
    pub fn isochoric_along(&self, k: &Kinematics<R>, along_squared: &Sym3<R>) -> Sym3<R> {
        let (change, i4) = self.stretch(k, along_squared);
        let factor = self.eta.constant(2.0) * self.eta * self.pulling(change) * k.j_m23;
        let spherical = self.eta.constant(-1.0 / 3.0) * i4 / (k.j * k.j);
        along_squared.plus(&k.adjugate_c.scaled(spherical)).scaled(factor)
    }

    /// s = 2η(Ī₄ − 1)J^(−2/3) (Pa), F a and I₄, straight from ∇u, J − 1 and J^(−2/3).
    #[inline(always)]
    pub(super) fn pull(&self, gradient: &[[R; 3]; 3], a: [R; 3], volume_change: R, j_m23: R) -> (R, [R; 3], R) {
        let ha = [dot(gradient[0], a), dot(gradient[1], a), dot(gradient[2], a)];
        let i4_change = dot_plus(ha, ha, self.eta.constant(2.0) * dot(a, ha));
        let (pull, i4) = self.pull_of(i4_change, volume_change, j_m23);
        (pull, [a[0] + ha[0], a[1] + ha[1], a[2] + ha[2]], i4)
    }

    /// s (Pa) and I₄ from I₄ − 1, J − 1 and J^(−2/3).
    #[inline(always)]
    pub(super) fn pull_of(&self, i4_change: R, volume_change: R, j_m23: R) -> (R, R) {
        let (one, two) = (self.eta.constant(1.0), self.eta.constant(2.0));
        let i4 = one + i4_change;
        let change = j_m23_change(volume_change, j_m23).mul_add(i4, i4_change);
        let stiffness = two * self.eta * j_m23;
        let pushing = (one - self.tension_only) * stiffness;
        ((change * stiffness).max(change * pushing), i4)
    }

    /// Strain energy per rest volume (J/m³).
    #[inline(always)]
    pub fn energy(&self, k: &Kinematics<R>, a: [R; 3]) -> R {
        let pulling = self.pulling(self.stretch(k, &Sym3::square_of(a)).0);
        self.eta.constant(0.5) * self.eta * pulling * pulling
    }
}
