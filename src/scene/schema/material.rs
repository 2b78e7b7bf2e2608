//! Materials and their effects.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A material: a density and the effects it has. An effect that is not named does not exist.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Density at rest (kg/m³).
    pub density: f64,
    /// Hooke's law for small strains and rotations. Every material needs exactly one elastic law.
    #[serde(default)]
    pub linear: Option<Elasticity>,
    /// Hooke's law in Green's strain: large rotations, small strains.
    #[serde(default)]
    pub st_venant_kirchhoff: Option<Elasticity>,
    /// The neo-Hookean law, for large strains.
    #[serde(default)]
    pub neo_hookean: Option<Elasticity>,
    /// The stable neo-Hookean law, defined for every deformation, also of tissue that is turned inside out.
    #[serde(default)]
    pub stable_neo_hookean: Option<Elasticity>,
    /// The Mooney-Rivlin law, for large strains.
    #[serde(default)]
    pub mooney_rivlin: Option<MooneyRivlin>,
    /// Ogden's law in principal stretches, for large strains.
    #[serde(default)]
    pub ogden: Option<Ogden>,
    /// The eight-chain law of Arruda and Boyce, which stiffens towards a locking stretch.
    #[serde(default)]
    pub arruda_boyce: Option<ArrudaBoyce>,
    /// An elastic law of your own: a formula of its energy, or written in WGSL.
    #[serde(default)]
    pub law: Option<OwnLaw>,
    /// Fibres in one direction (transverse isotropy), on top of the elastic law.
    #[serde(default)]
    pub fibres: Option<Fibres>,
    /// Families of fibres that stiffen exponentially (Holzapfel-Gasser-Ogden), on top of the elastic law.
    #[serde(default)]
    pub exponential_fibres: Option<Vec<ExponentialFibres>>,
    /// Viscosity of the isochoric stress.
    #[serde(default)]
    pub prony: Option<Prony>,
    /// Mass-proportional damping: rate c of the force -c M v (1/s).
    #[serde(default)]
    pub damping: Option<f64>,
    /// Stiffness-proportional damping: time β of the stress β Ṡ, S the stress without viscosity (s).
    #[serde(default)]
    pub stiffness_damping: Option<f64>,
    /// What becomes of elements that are turned inside out; left out, `Recover` where the material can, else `Stop`.
    #[serde(default)]
    pub inversion: Option<Inversion>,
}

/// What becomes of an element that is turned inside out (J < 0).
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum Inversion {
    /// The run ends and says which element it was.
    Stop,
    /// The element is removed in the same step, and exerts nothing in it.
    Remove,
    /// The element is pushed back by a stress that is defined inside out, too.
    Recover,
}

impl Material {
    /// What keeps its elements from recovering when they are turned inside out; `None` where they can.
    pub fn cannot_recover_because_of(&self) -> Option<&'static str> {
        let needs = [
            ("an elastic law that ends at J = 0", self.stable_neo_hookean.is_none()),
            ("fibres", self.fibres.is_some()),
            ("exponential_fibres", self.exponential_fibres.is_some()),
            ("stiffness_damping", self.stiffness_damping.is_some_and(|time| time != 0.0)),
            ("terms of prony", self.prony.as_ref().is_some_and(|prony| !prony.terms.is_empty())),
        ];
        needs.into_iter().find(|(_, there)| *there).map(|(what, _)| what)
    }

    /// What becomes of its elements that are turned inside out.
    pub fn inversion(&self) -> Inversion {
        let left_out = if self.cannot_recover_because_of().is_none() { Inversion::Recover } else { Inversion::Stop };
        self.inversion.unwrap_or(left_out)
    }
}

/// Moduli of an isotropic law, as one of two pairs.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Elasticity {
    /// Young's modulus (Pa) and Poisson's ratio, both of small strains.
    Young {
        /// Young's modulus (Pa).
        young: f64,
        /// Poisson's ratio, below 1/2.
        poisson: f64,
    },
    /// Shear modulus and bulk modulus.
    Moduli {
        /// Shear modulus μ (Pa).
        shear: f64,
        /// Bulk modulus κ (Pa).
        bulk: f64,
    },
}

/// An elastic law of your own: a formula of its energy, or a WGSL file; and the parameters it needs.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OwnLaw {
    /// The energy (J/m³) as a formula of the invariants of the deformation and the parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<String>,
    /// In place of `energy` the file (.wgsl), its path relative to the scene file; empty where there is none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub file: String,
    /// A number for each name in the formula, or for each member of the struct of `var<uniform> elastic`.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
}

/// Ψ = c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3) + κ/2 (J − 1)².
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MooneyRivlin {
    /// c₁₀ (Pa); c₁₀ + c₀₁ is half the shear modulus of small strains.
    pub c10: f64,
    /// c₀₁ (Pa).
    pub c01: f64,
    /// Bulk modulus κ (Pa).
    pub bulk: f64,
}

/// Ψ = Σ μ/α (λ̄₁^α + λ̄₂^α + λ̄₃^α − 3) + κ/2 (J − 1)².
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Ogden {
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

/// Ψ = μ Σ Cᵢ λ_m^(2−2i) (Ī₁ⁱ − 3ⁱ) + κ/2 (J − 1)², five terms.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ArrudaBoyce {
    /// μ (Pa), below the shear modulus of small strains.
    pub shear: f64,
    /// The locking stretch λ_m of a chain, above 1.
    pub locking_stretch: f64,
    /// Bulk modulus κ (Pa).
    pub bulk: f64,
}

/// A family of fibres: Ψ = k₁/(2k₂) (exp(k₂ Ē²) − 1), Ē = κ_d (Ī₁ − 3) + (1 − 3κ_d)(Ī₄ − 1).
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ExponentialFibres {
    /// Stiffness k₁ (Pa).
    pub k1: f64,
    /// How fast it grows with the strain, k₂.
    pub k2: f64,
    /// Dispersion κ_d of the directions: 0 all along `direction`, 1/3 all directions alike.
    #[serde(default)]
    pub dispersion: f64,
    /// The mean direction at rest.
    pub direction: Direction,
    /// Whether the family only pulls, or pushes back as well when compressed.
    #[serde(default = "yes")]
    pub tension_only: bool,
}

fn yes() -> bool {
    true
}

/// Fibres: Ψ = η/2 (Ī₄ − 1)², the η of Comas et al. 2008 (other codes mean 2η by the same letter).
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Fibres {
    /// Stiffness η (Pa).
    pub eta: f64,
    /// The direction at rest.
    pub direction: Direction,
    /// Whether fibres push back when compressed (as in the paper), or only pull.
    #[serde(default)]
    pub tension_only: bool,
}

/// A direction in the body at rest; its length does not matter.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Direction {
    /// The same everywhere.
    Along(f64, f64, f64),
    /// Around an axis through a point: circular fibres.
    Around {
        /// A point on the axis (m).
        #[serde(default)]
        center: DVec3,
        /// The direction of the axis.
        axis: DVec3,
    },
    /// One direction an element, from the cell data of that name in the mesh file.
    Field(String),
}

/// Viscosity: relaxation in exponentials, of the isochoric stress and of the pressure.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Prony {
    /// The terms: share α of the instantaneous isochoric stress that relaxes with time τ (s).
    #[serde(default)]
    pub terms: Vec<PronyTerm>,
    /// The same for the pressure.
    #[serde(default)]
    pub volumetric: Vec<PronyTerm>,
    /// How the history is carried on.
    #[serde(default)]
    pub integrator: ViscousIntegrator,
    /// Whether the relaxed stress is freed of the part that has become a pressure since the past that it comes from.
    #[serde(default)]
    pub reproject: bool,
}

/// One exponential of a [`Prony`] series.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Share of the instantaneous stress that relaxes, 0 ≤ α; all together below 1.
    pub alpha: f64,
    /// Relaxation time τ (s).
    pub tau: f64,
}

/// How viscous history is carried from step to step.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum ViscousIntegrator {
    /// Exact for a stress that is linear within a step; second order.
    #[default]
    Exact,
    /// The paper's eq. 4; first order.
    BackwardEuler,
}
