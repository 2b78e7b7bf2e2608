//! A law in Rust: Gent's, which stiffens towards a limit of its chains.

use sinew::materials::{Elastic, Kinematics, RustLaw};
use sinew::math::{Real, Sym3};
use sinew::serde;

/// Ψ = −μ J_m/2 ln(1 − (Ī₁ − 3)/J_m) + κ/2 (J − 1)² (Gent 1996).
#[derive(Clone, Copy)]
pub struct Gent<R> {
    shear: R,
    bulk: R,
    limit: R,
}

/// What the scene says under `parameters`.
#[derive(serde::Deserialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
pub struct Parameters {
    /// Shear modulus (Pa).
    shear: f64,
    /// Bulk modulus (Pa).
    bulk: f64,
    /// J_m: what Ī₁ − 3 stays below.
    limit: f64,
}

impl RustLaw for Gent<f64> {
    type Parameters = Parameters;

    fn of(Parameters { shear, bulk, limit }: Parameters) -> Result<Self, String> {
        match limit > 0.0 {
            true => Ok(Self { shear, bulk, limit }),
            false => Err(format!("`limit` must be above 0, found {limit}")),
        }
    }
}

impl<R: Real> Elastic<R> for Gent<R> {
    type Of<Q: Real> = Gent<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Gent<Q> {
        Gent { shear: number(self.shear), bulk: number(self.bulk), limit: number(self.limit) }
    }

    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        // 2 ∂Ψ/∂Ī₁ times J^(−2/3) (I − tr C/3 C⁻¹), which is C⁻¹ 2 dev E
        let slope = self.shear * self.limit / (self.limit - k.i1_change());
        k.inverse_c_times(&k.green_strain.deviator().scaled(slope * k.j_m23 * slope.constant(2.0)))
    }

    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        -(self.shear * self.limit * self.shear.constant(0.5)) * (-(k.i1_change() / self.limit)).ln_1p()
    }

    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk * self.bulk.constant(0.5) * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        [self.shear, self.bulk]
    }
}
