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
    /// Isotropic elasticity; every material needs an elastic law, and this is the one there is.
    #[serde(default)]
    pub neo_hookean: Option<NeoHookean>,
    /// An elastic law of your own, written in WGSL, in place of the built-in ones.
    #[serde(default)]
    pub law: Option<OwnLaw>,
    /// Fibres in one direction (transverse isotropy).
    #[serde(default)]
    pub fibres: Option<Fibres>,
    /// Viscosity of the isochoric stress.
    #[serde(default)]
    pub prony: Option<Prony>,
    /// Mass-proportional damping: rate c of the force -c M v (1/s).
    #[serde(default)]
    pub damping: Option<f64>,
}

/// Moduli of the neo-Hookean law, as one of two pairs.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum NeoHookean {
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

/// An elastic law of your own: a WGSL file with four functions, and the parameters it needs.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OwnLaw {
    /// The file (.wgsl), its path relative to the scene file.
    pub file: String,
    /// A number for each member of the struct of `var<uniform> elastic`, by name.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
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

/// Viscosity: relaxation of the isochoric stress in exponentials.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Prony {
    /// The terms: share α of the instantaneous stress that relaxes with time τ (s).
    pub terms: Vec<PronyTerm>,
    /// How the history is carried on.
    #[serde(default)]
    pub integrator: ViscousIntegrator,
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
