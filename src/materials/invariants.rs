//! Invariants of the isochoric deformation, and the stress of an energy of them (its WGSL twin is
//! `shaders/invariants.wgsl`).

use super::Kinematics;
use crate::math::{Real, Sym3};

impl<R: Real> Kinematics<R> {
    /// Ī₂ − 3 with Ī₂ = J^(−4/3) ½((tr C)² − tr C²).
    #[inline(always)]
    pub fn i2_change(&self) -> R {
        let e = &self.green_strain;
        let (two, three, four) = (self.j.constant(2.0), self.j.constant(3.0), self.j.constant(4.0));
        // J^(−4/3) − 1, and I₂ − 3 = 4 tr E + 2((tr E)² − E:E)
        let w = self.j_m23_change();
        let v = w * (two + w);
        let trace = e.trace();
        let i2_change = four * trace + two * (trace * trace - e.contracted(e));
        three * v + i2_change + v * i2_change
    }

    /// 2 ∂Ψ/∂C (Pa) of an energy Ψ(Ī₁), from ∂Ψ/∂Ī₁ (Pa): C⁻¹ times the deviator of 4 ∂Ψ/∂Ī₁ J^(−2/3) E, which keeps
    /// the digits of a small strain.
    #[inline(always)]
    pub fn stress_of_slope(&self, first: R) -> Sym3<R> {
        let factor = self.j.constant(4.0) * first * self.j_m23;
        self.inverse_c_times(&self.green_strain.deviator().scaled(factor))
    }

    /// 2 ∂Ψ/∂C (Pa) of an energy Ψ(Ī₁, Ī₂), from ∂Ψ/∂Ī₁ and ∂Ψ/∂Ī₂ (Pa): 2 ∂Ψ/∂Ī₁ J^(−2/3) (I − I₁/3 C⁻¹) + 2 ∂Ψ/∂Ī₂
    /// J^(−4/3) (I₁ I − C − 2/3 I₂ C⁻¹), which is C⁻¹ times the deviator of 4(∂Ψ/∂Ī₁ J^(−2/3) + ∂Ψ/∂Ī₂ J^(−4/3)
    /// (1 + 2 tr E)) E − 8 ∂Ψ/∂Ī₂ J^(−4/3) E².
    #[inline(always)]
    pub fn stress_of_slopes(&self, first: R, second: R) -> Sym3<R> {
        let e = &self.green_strain;
        let (one, two, four) = (self.j.constant(1.0), self.j.constant(2.0), self.j.constant(4.0));
        let of_second = four * second * self.j_m23 * self.j_m23;
        let factor = (four * first).mul_add(self.j_m23, of_second * two.mul_add(e.trace(), one));
        let inner = e.scaled(factor).plus(&e.times_coaxial(e).scaled(-(two * of_second)));
        self.inverse_c_times(&inner.deviator())
    }
}
