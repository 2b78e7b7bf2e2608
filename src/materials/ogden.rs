//! Ogden's law in principal stretches.

use super::complaints::number as show;
use super::{Complaints, Elastic, Kinematics, Law, Prerequisite};
use crate::math::{Real, Sym3};
use crate::uniform::{Layout, Uniform};
use bevy_ecs::component::Component;
use serde::{Deserialize, Serialize};

/// Terms that an Ogden law can have.
pub const OGDEN_TERMS: usize = 4;

/// Below this squared stretch the logarithm is taken there: the square of [`J_FLOOR`](super::J_FLOOR).
const STRETCH_FLOOR: f64 = super::J_FLOOR * super::J_FLOOR;

/// Ψ_iso = Σ_p μ_p/α_p (λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3) with λ̄ = J^(−1/3) λ, U = κ/2 (J − 1)² (Ogden 1972; Holzapfel
/// 2000, §6.5; its WGSL twin is `shaders/ogden.wgsl`).
///
/// At small strains its shear modulus is ½ Σ μ_p α_p. Programs that write 2μ_p/α_p² instead of μ_p/α_p (Abaqus) mean by
/// their μ_p what is here ½ μ_p α_p.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ogden<T: Send + Sync + 'static> {
    /// μ_p (Pa); 0 of terms there are not.
    pub mu: [T; OGDEN_TERMS],
    /// α_p, not 0; 1 of terms there are not.
    pub alpha: [T; OGDEN_TERMS],
    /// Bulk modulus κ (Pa).
    pub bulk: T,
    /// How many terms there are.
    pub terms: u32,
}

/// Ψ = Σ μ/α (λ̄₁^α + λ̄₂^α + λ̄₃^α − 3) + κ/2 (J − 1)², as scenes have it.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OgdenParameters {
    /// One to four terms; half the sum of all μ α is the shear modulus of small strains.
    pub terms: Vec<OgdenTerm>,
    /// Bulk modulus κ (Pa).
    pub bulk: f64,
}

/// One term of an [`Ogden`] law.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OgdenTerm {
    /// μ (Pa), of the sign of α.
    pub mu: f64,
    /// The exponent α.
    pub alpha: f64,
}

/// The exponent of the one term that [`Law::with_moduli`] gives: 2 would be neo-Hookean.
const ALPHA: f64 = 4.0;

impl Law for Ogden<f64> {
    type Parameters = OgdenParameters;
    const PREREQUISITES: &'static [Prerequisite] =
        &[Prerequisite::FiniteStrain, Prerequisite::VolumeRatio, Prerequisite::Eigen, Prerequisite::Elementary];

    fn of(OgdenParameters { terms, bulk }: &OgdenParameters) -> Self {
        let terms: Vec<(f64, f64)> = terms.iter().map(|term| (term.mu, term.alpha)).collect();
        Self::new(&terms, *bulk)
    }

    fn check(OgdenParameters { terms, bulk }: &OgdenParameters, complaints: &mut Complaints) {
        let count = terms.len();
        if count == 0 || count > OGDEN_TERMS {
            complaints
                .error("terms", format!("`ogden` must have 1 to {OGDEN_TERMS} terms, found {count}"))
                .note("a term is (mu: 1000, alpha: 2)");
        }
        for (number, term) in terms.iter().enumerate() {
            let at = |field: &str| format!("terms[{number}].{field}");
            if term.alpha == 0.0 {
                let message = "`alpha` must not be 0: such a term has no energy";
                complaints.at(at("alpha"), true, message);
            } else if term.mu * term.alpha < 0.0 {
                let message =
                    "`mu` and `alpha` are of different sign: at some large stretch the law loses its stiffness";
                complaints
                    .at(at("mu"), false, message)
                    .note("it is safe at every stretch when `mu` times `alpha` is above 0 in each term");
            }
        }
        let shear = 0.5 * terms.iter().map(|term| term.mu * term.alpha).sum::<f64>();
        if count > 0 && shear <= 0.0 {
            let found = show(2.0 * shear);
            complaints
                .error("terms", format!("the sum of all `mu` times `alpha` must be above 0, found {found} Pa"))
                .note("half of it is the shear modulus of small strains");
        }
        complaints.bulk_modulus(*bulk, shear, "of half the sum of all `mu` times `alpha`");
    }

    fn with_moduli(shear: f64, bulk: f64) -> OgdenParameters {
        OgdenParameters { terms: vec![OgdenTerm { mu: 2.0 * shear / ALPHA, alpha: ALPHA }], bulk }
    }
}

impl Uniform for Ogden<f32> {
    // WGSL has vec4 for four numbers, and rounds the struct up to whole ones
    const LAYOUT: Layout = Layout {
        name: "Ogden",
        size: 48,
        members: &[("mu", 0, 16), ("alpha", 16, 16), ("bulk", 32, 4), ("terms", 36, 4)],
    };
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = bytemuck::cast_slice(&[self.mu, self.alpha]).to_vec();
        bytes.extend(self.bulk.to_ne_bytes());
        bytes.extend(self.terms.to_ne_bytes());
        bytes.resize(Self::LAYOUT.size, 0);
        bytes
    }
}

impl Ogden<f64> {
    /// Of terms (μ_p in Pa, α_p), at most [`OGDEN_TERMS`] of which are taken, and κ (Pa).
    pub fn new(terms: &[(f64, f64)], bulk: f64) -> Self {
        let mut law = Self { mu: [0.0; OGDEN_TERMS], alpha: [1.0; OGDEN_TERMS], bulk, terms: 0 };
        for &(mu, alpha) in terms.iter().take(OGDEN_TERMS) {
            let number = law.terms as usize;
            (law.mu[number], law.alpha[number]) = (mu, alpha);
            law.terms += 1;
        }
        law
    }
}

/// ln λ̄ for each of the eigenvalues e of E: ½ ln(1 + 2e) less the mean of all three, ⅓ ln J.
#[inline(always)]
fn isochoric_logarithms<R: Real>(strains: [R; 3]) -> [R; 3] {
    let (half, lowest) = (strains[0].constant(0.5), strains[0].constant(STRETCH_FLOOR - 1.0));
    let mut logarithms = strains;
    for i in 0..3 {
        logarithms[i] = half * (strains[i] + strains[i]).max(lowest).ln_1p();
    }
    let mean = (logarithms[0] + logarithms[1] + logarithms[2]) * strains[0].constant(1.0 / 3.0);
    [logarithms[0] - mean, logarithms[1] - mean, logarithms[2] - mean]
}

impl<R: Real> Elastic<R> for Ogden<R> {
    type Of<Q: Real> = Ogden<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Ogden<Q> {
        let (m, a) = (&self.mu, &self.alpha);
        Ogden {
            mu: [number(m[0]), number(m[1]), number(m[2]), number(m[3])],
            alpha: [number(a[0]), number(a[1]), number(a[2]), number(a[3])],
            bulk: number(self.bulk),
            terms: self.terms,
        }
    }

    /// Σᵢ τᵢ/λᵢ² Nᵢ⊗Nᵢ, τᵢ = Σ_p μ_p (λ̄ᵢ^α_p − mean): of the eigenvalues of E, by e^(α ln λ̄) − 1, which keeps the
    /// digits of a small strain.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        let (strains, axes) = k.green_strain.eigen();
        let logarithms = isochoric_logarithms(strains);
        let (zero, one, third) = (self.bulk.constant(0.0), self.bulk.constant(1.0), self.bulk.constant(1.0 / 3.0));
        let mut tau = [zero; 3];
        for p in 0..self.terms as usize {
            let mut powers = logarithms;
            for i in 0..3 {
                powers[i] = (self.alpha[p] * logarithms[i]).exp_m1();
            }
            let mean = (powers[0] + powers[1] + powers[2]) * third;
            for i in 0..3 {
                tau[i] = self.mu[p].mul_add(powers[i] - mean, tau[i]);
            }
        }
        let mut stress = Sym3([zero; 6]);
        for i in 0..3 {
            let square = (one + (strains[i] + strains[i])).max(one.constant(STRETCH_FLOOR));
            stress = stress.plus(&Sym3::square_of(axes[i]).scaled(tau[i] / square));
        }
        stress
    }

    /// κ(J − 1).
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        let logarithms = isochoric_logarithms(k.green_strain.eigen().0);
        let mut energy = self.bulk.constant(0.0);
        for p in 0..self.terms as usize {
            for i in 0..3 {
                energy += self.mu[p] / self.alpha[p] * (self.alpha[p] * logarithms[i]).exp_m1();
            }
        }
        energy
    }

    /// κ/2 (J − 1)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        let mut shear = self.bulk.constant(0.0);
        for p in 0..self.terms as usize {
            shear += self.bulk.constant(0.5) * self.mu[p] * self.alpha[p];
        }
        [shear, self.bulk]
    }
}
