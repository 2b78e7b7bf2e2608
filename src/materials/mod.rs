//! Constitutive laws: stress at a point from the displacement gradient.
//!
//! A law is one Rust file with its WGSL twin of the same stem in `shaders/`. Isochoric stresses add up, viscosity takes its
//! share of their sum, the volumetric stress comes last: S = S_vol + S_iso − Υ.

mod elastic;
mod fibres;
mod kinematics;
mod neo_hookean;
mod prony;

pub(crate) use elastic::each_elastic_law;
pub use elastic::{Elastic, ElasticLaw, WithElastic};
pub use fibres::Fibres;
pub use kinematics::{J_FLOOR, Kinematics};
pub use neo_hookean::NeoHookean;
pub use prony::PronyTerm;
