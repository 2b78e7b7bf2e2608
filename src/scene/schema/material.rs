//! Materials and their effects.

use crate::materials::{self, Complaints, CorotationalFrame, Elastic, ElasticLaw, Law, each_elastic_law};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

macro_rules! material {
    ($($(#[$doc:meta])* $word:ident: $law:ident;)*) => {
        /// A material: a density and the effects it has. An effect that is not named does not exist.
        #[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
        #[serde(deny_unknown_fields)]
        pub struct Material {
            /// Density at rest (kg/m³).
            pub density: f64,
            $($(#[$doc])* #[doc = ""] #[doc = "Every material has exactly one elastic law."]
            #[serde(default)]
            pub $word: Option<<materials::$law<f64> as Law>::Parameters>,)*
            /// An elastic law of your own: a formula of its energy, or written in WGSL or Rust.
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
            /// What becomes of elements that are turned inside out; left out, `Recover` where the material can, else
            /// `Stop`.
            #[serde(default)]
            pub inversion: Option<Inversion>,
        }

        /// Words of the elastic laws that a material can have, that of one's own last.
        pub const ELASTIC_LAWS: &[&str] = &[$(stringify!($word),)* "law"];

        /// Those of them that are for large strains.
        pub fn laws_for_large_strains() -> Vec<&'static str> {
            let all = [$((stringify!($word), <materials::$law<f64> as Law>::LARGE_STRAINS),)* ("law", true)];
            all.into_iter().filter(|(_, large)| *large).map(|(word, _)| word).collect()
        }

        /// Words of the elastic laws that have a stress inside out, too.
        pub fn laws_that_recover() -> Vec<&'static str> {
            let all = [$((stringify!($word), <materials::$law<f64> as Law>::RECOVERS),)*];
            all.into_iter().filter(|(_, recovers)| *recovers).map(|(word, _)| word).collect()
        }

        /// Words of the elastic laws that studies compare, from the simplest on.
        pub fn comparable_laws() -> Vec<&'static str> {
            let all = [$((stringify!($word), <materials::$law<f64> as Law>::IS_COMPARED),)*];
            all.into_iter().filter(|(_, is_one)| *is_one).map(|(word, _)| word).collect()
        }

        impl Material {
            /// Words of the elastic laws that it has: one, once it has been validated.
            pub fn elastic_laws(&self) -> Vec<&'static str> {
                let all = [$((stringify!($word), self.$word.is_some()),)* ("law", self.law.is_some())];
                all.into_iter().filter(|(_, there)| *there).map(|(word, _)| word).collect()
            }

            /// Its elastic law, unless that is one of the user's own.
            pub fn elastic_law(&self) -> Option<ElasticLaw<f64>> {
                if let Some(law) = self.by_frame() {
                    return Some(ElasticLaw::CorotationalFrame(law));
                }
                $(if let Some(parameters) = &self.$word {
                    return Some(ElasticLaw::$law(Law::of(parameters)));
                })*
                None
            }

            /// What is wrong with the parameters of its elastic laws, with the words of the laws.
            pub fn check_elastic_laws(&self) -> Vec<(&'static str, Complaints)> {
                let mut all = Vec::new();
                $(if let Some(parameters) = &self.$word {
                    let mut complaints = Complaints::default();
                    <materials::$law<f64> as Law>::check(parameters, &mut complaints);
                    all.push((stringify!($word), complaints));
                })*
                all
            }

            /// Gives it the elastic law of that word in place of its own, with the moduli (Pa) that its own has at
            /// small strains; leaves it alone where there is no such law, or its own is none of those that studies
            /// compare.
            pub fn take_law(&mut self, word: &str) {
                let [own] = self.elastic_laws()[..] else { return };
                let known = comparable_laws();
                let Some([shear, bulk]) = self.elastic_law().map(|law| law.small_strain_moduli()) else { return };
                if !known.contains(&own) || !known.contains(&word) {
                    return;
                }
                $(self.$word = None;)*
                $(if word == stringify!($word) {
                    self.$word = Some(<materials::$law<f64> as Law>::with_moduli(shear, bulk));
                })*
            }

            /// Takes the parameters of another's elastic law where that is of the same kind.
            pub fn take_law_parameters(&mut self, other: &Material) {
                let rotation = self.corotational.as_mut().map(|own| *own.rotation());
                $(if let (Some(own), Some(other)) = (&mut self.$word, &other.$word) {
                    own.clone_from(other);
                })*
                // which kind of law it is stays as it is
                if let (Some(own), Some(rotation)) = (&mut self.corotational, rotation) {
                    *own.rotation() = rotation;
                }
            }

            /// Whether its elastic law has a stress inside out, too.
            fn recovers(&self) -> bool {
                $(self.$word.is_some() && <materials::$law<f64> as Law>::RECOVERS ||)* false
            }
        }
    };
}
each_elastic_law!(material);

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
    /// Its law, of no element yet, where that turns by frames of edges.
    pub fn by_frame(&self) -> Option<CorotationalFrame<f64>> {
        self.corotational?.by_frame()
    }

    /// What keeps its elements from recovering when they are turned inside out; `None` where they can.
    pub fn cannot_recover_because_of(&self) -> Option<&'static str> {
        let needs = [
            ("an elastic law that ends at J = 0", !self.recovers()),
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

/// An elastic law of your own: a formula of its energy, a WGSL file, or one in Rust; and the parameters it needs.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OwnLaw {
    /// The energy (J/m³) as a formula of the invariants of the deformation and the parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<String>,
    /// In place of `energy` the file (.wgsl), its path relative to the scene file; empty where there is none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub file: String,
    /// In place of both the name of a law in Rust, which the program adds to its registry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rust: Option<String>,
    /// A number for each name in the formula, for each member of the struct of `var<uniform> elastic`, or for each
    /// parameter of the law in Rust.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
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
