//! The stable neo-Hookean law, defined for every deformation.

use super::elasticity::by_moduli;
use super::{Elastic, Kinematics, Law, Prerequisite};
use crate::math::{Mat3, Real, Sym3, minor};
use crate::uniform::uniform;
use bevy_ecs::component::Component;

/// Ψ = m/2 (I₁ − 3) + l/2 (J − a)² − m/2 ln(I₁ + 1) with I₁ = tr C, m = 4/3 μ, l = λ + 5/6 μ, a = 1 + 3m/(4l) (Smith,
/// de Goes & Kim 2018, eqs. 13 to 16; its WGSL twin is `shaders/stable_neo_hookean.wgsl`): μ and λ = κ − 2/3 μ are
/// those of small strains.
///
/// Nothing in it is divided by J: P = m I₁/(I₁ + 1) F + l (J − a) cof F is finite and smooth for every F, flat and
/// inside out too, and F = R alone, a rotation, is without stress. So tissue that has been turned inside out turns
/// back.
///
/// Here it is the same Ψ up to a constant, in parts of which none has a stress at rest, so that f32 keeps the digits of
/// a small strain: U = κ/2 (J − 1)², which elements may average, and Ψ_iso = m/2 (I₁ − 3) − m/2 ln((I₁ + 1)/4) − 3m/4
/// (J − 1) + m/16 (J − 1)², at small strains μ dev ε:dev ε as of the other laws. At large ones it answers to the
/// volume, too.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct StableNeoHookean<T: Send + Sync + 'static> {
    /// Shear modulus μ of small strains (Pa).
    pub shear: T,
    /// Bulk modulus κ of small strains (Pa).
    pub bulk: T,
}

impl<R: Real> StableNeoHookean<R> {
    /// m (Pa).
    #[inline(always)]
    fn m(&self) -> R {
        self.shear * self.shear.constant(4.0 / 3.0)
    }

    /// m I₁/(I₁ + 1) less its value at rest, 3m/4 (Pa).
    #[inline(always)]
    fn growth(&self, k: &Kinematics<R>) -> R {
        let growth = k.green_strain.trace() + k.green_strain.trace();
        let four = growth.constant(4.0);
        self.m() * growth / (four * (four + growth))
    }
}

uniform!(StableNeoHookean<f32> { shear, bulk });

impl Law for StableNeoHookean<f64> {
    const PREREQUISITES: &'static [Prerequisite] = &[Prerequisite::Elementary];
    const RECOVERS: bool = true;
    const IS_COMPARED: bool = false;
    by_moduli!();
}

impl<R: Real> Elastic<R> for StableNeoHookean<R> {
    type Of<Q: Real> = StableNeoHookean<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> StableNeoHookean<Q> {
        StableNeoHookean { shear: number(self.shear), bulk: number(self.bulk) }
    }

    #[inline(always)]
    fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
        Kinematics::of_any_volume(gradient)
    }

    /// With A = I + ∇u: growth A + 3m/4 (A − cof A) + (p + m/8 (J − 1)) cof A. Of `isochoric` counts what effects have
    /// made of S_iso, nothing without effects: C⁻¹ does not exist at J = 0.
    #[inline(always)]
    fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        let h = &gradient.0;
        let (zero, one) = (pressure.constant(0.0), pressure.constant(1.0));
        let own = self.isochoric(k).scaled(-one);
        let growth = self.growth(k);
        let effects = isochoric.plus(&own).plus(&Sym3([growth, growth, growth, zero, zero, zero]));
        let mut stress = gradient.plus_identity_times(&effects);
        let trace = h[0][0] + h[1][1] + h[2][2];
        let shear = self.m() * pressure.constant(0.75);
        let pressing = (self.m() * pressure.constant(0.125)).mul_add(k.volume_change, pressure);
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                let diagonal = if i == j { trace } else { zero };
                // cof A − I
                let change = diagonal - h[j][i] + minor(h[i1][j1], h[i1][j2], h[i2][j1], h[i2][j2]);
                let cofactor = if i == j { one + change } else { change };
                stress.0[i][j] += shear * (h[i][j] - change) + pressing * cofactor;
            }
        }
        stress
    }

    /// growth I + 3m/4 (I − J C⁻¹) + m/8 (J − 1) J C⁻¹, with J I − adj C from E.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        let (e, two) = (&k.green_strain, k.j.constant(2.0));
        let quarters = self.m() * k.j.constant(0.75) / k.j;
        let mut stress = k.adjugate_c.scaled(self.m() * k.j.constant(0.125) * k.volume_change / k.j);
        let squares = e.adjugate();
        let diagonal = k.volume_change - two * e.trace();
        let growth = self.growth(k);
        for i in 0..6 {
            let change = two * e.0[i] - k.j.constant(4.0) * squares.0[i];
            stress.0[i] += if i < 3 { quarters.mul_add(change + diagonal, growth) } else { quarters * change };
        }
        stress
    }

    /// Its isochoric stress has a share of the pressure of its own: nothing is taken off.
    #[inline(always)]
    fn without_pressure(&self, _: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
        stress
    }

    /// κ(J − 1).
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    /// m/2 (I₁ − 3) − m/2 ln((I₁ + 1)/4) − 3m/4 (J − 1) + m/16 (J − 1)².
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        let number = |value: f64| k.j.constant(value);
        let (growth, change) = (number(2.0) * k.green_strain.trace(), k.volume_change);
        let of_growth = number(0.5) * (growth - (number(0.25) * growth).ln_1p());
        self.m() * (of_growth + change * (number(0.0625) * change - number(0.75)))
    }

    /// κ/2 (J − 1)².
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
