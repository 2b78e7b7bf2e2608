//! Moduli of small strains, as scenes give them.

use super::Complaints;
use serde::{Deserialize, Serialize};

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

impl Elasticity {
    /// Shear and bulk modulus (Pa).
    pub fn moduli(&self) -> (f64, f64) {
        match *self {
            Self::Young { young, poisson } => (young / (2.0 * (1.0 + poisson)), young / (3.0 * (1.0 - 2.0 * poisson))),
            Self::Moduli { shear, bulk } => (shear, bulk),
        }
    }

    /// Tells what is wrong with them.
    pub fn check(&self, complaints: &mut Complaints) {
        match *self {
            Self::Young { young, poisson } => {
                complaints.above_zero("young", young, "Pa");
                if poisson >= 0.5 {
                    complaints
                        .must("poisson", "between -1 and 0.5", poisson)
                        .note("0.5 means no change of volume at all: an infinite bulk modulus, and a stable step of 0")
                        .note("soft tissue is usually given 0.45 to 0.499");
                } else if poisson <= -1.0 {
                    complaints
                        .must("poisson", "between -1 and 0.5", poisson)
                        .note("at -1 and below the bulk modulus is infinite or negative");
                }
            }
            Self::Moduli { shear, bulk } => {
                complaints.above_zero("shear", shear, "Pa");
                complaints.bulk_modulus(bulk, shear, "`shear`");
            }
        }
    }
}

/// What a law of a shear and a bulk modulus is in scenes: the same for all, `shear` and `bulk` are its fields.
macro_rules! by_moduli {
    () => {
        type Parameters = $crate::materials::Elasticity;

        fn of(elasticity: &Self::Parameters) -> Self {
            let (shear, bulk) = elasticity.moduli();
            Self { shear, bulk }
        }

        fn check(elasticity: &Self::Parameters, complaints: &mut $crate::materials::Complaints) {
            elasticity.check(complaints);
        }

        fn with_moduli(shear: f64, bulk: f64) -> Self::Parameters {
            $crate::materials::Elasticity::Moduli { shear, bulk }
        }
    };
}
pub(super) use by_moduli;
