//! Constitutive laws: stress at a point from the displacement gradient.
//!
//! A law is one Rust file with its WGSL twin of the same stem in `shaders/`. Isochoric stresses add up, viscosity takes
//! its share of their sum, the volumetric stress comes last: S = S_vol + S_iso − Υ.

mod arruda_boyce;
mod elastic;
mod exponential_fibres;
mod fibres;
mod invariants;
mod kinematics;
mod linear;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
pub mod program;
mod prony;
mod st_venant_kirchhoff;
mod stable_neo_hookean;
mod tangent;
mod user_law;

pub use arruda_boyce::ArrudaBoyce;
pub(crate) use elastic::each_elastic_law;
pub use elastic::{Elastic, ElasticLaw};
pub use exponential_fibres::ExponentialFibre;
pub use fibres::Fibres;
pub use kinematics::{FLATTEST, J_FLOOR, Kinematics};
pub use linear::Linear;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use ogden::{OGDEN_TERMS, Ogden};
pub use prony::PronyTerm;
pub use st_venant_kirchhoff::StVenantKirchhoff;
pub use stable_neo_hookean::StableNeoHookean;
pub use user_law::{EnergySlopes, IsochoricStress, LawPrograms, UserLaw};
