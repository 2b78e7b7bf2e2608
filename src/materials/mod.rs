//! Constitutive laws: stress at a point from the displacement gradient.
//!
//! A law is one Rust file with its WGSL twin of the same stem in `shaders/`, and one line of the list in
//! `elastic.rs`. Isochoric stresses add up, viscosity takes
//! its share of their sum, the volumetric stress comes last: S = S_vol + S_iso − Υ.

mod arruda_boyce;
#[doc(hidden)]
pub mod complaints;
mod corotational;
mod corotational_frame;
mod elastic;
mod elasticity;
mod exponential_fibres;
mod fibres;
mod invariants;
mod kinematics;
mod law;
mod linear;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
#[doc(hidden)]
pub mod program;
mod prony;
mod st_venant_kirchhoff;
mod stable_neo_hookean;
mod tangent;
mod user_law;

pub use elastic::Elastic;
pub(crate) use elastic::each_elastic_law;
pub use kinematics::Kinematics;
pub use law::RustLaw;

// what the engine, the crates on top and tests see beside: no version keeps their names and types
#[doc(hidden)]
pub use complaints::Complaints;
#[doc(hidden)]
pub use corotational::{CorotationalParameters, Rotation};
#[doc(hidden)]
pub use corotational_frame::CorotationalFrame;
#[doc(hidden)]
pub use elastic::{ElasticLaw, TEXTS};
#[doc(hidden)]
pub use elasticity::Elasticity;
#[doc(hidden)]
pub use exponential_fibres::ExponentialFibre;
#[doc(hidden)]
pub use fibres::Fibres;
#[doc(hidden)]
pub use kinematics::{FLATTEST, J_FLOOR};
#[doc(hidden)]
pub use law::{Law, Prerequisite};
#[doc(hidden)]
pub use ogden::{OGDEN_TERMS, OgdenParameters, OgdenTerm};
#[doc(hidden)]
pub use prony::PronyTerm;
#[doc(hidden)]
pub use user_law::{EnergySlopes, IsochoricStress, LawPrograms, UserLaw};

macro_rules! laws {
    ($($(#[$doc:meta])* $word:ident: $law:ident;)*) => {
        $(#[doc(hidden)] pub use $word::$law;)*
    };
}
each_elastic_law!(laws);
