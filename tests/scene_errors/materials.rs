//! Materials that no scene can have.

use crate::good::{brief, with};

const LAW: &str = "neo_hookean: Young(young: 3e3, poisson: 0.45)";

/// What is said of a material whose law is replaced.
fn said(law: &str) -> String {
    brief(&with(LAW, law), &[])
}

#[test]
fn each() {
    for law in [
        "",
        "neo_hookean: Young(young: 3e3, poisson: 0.45), ogden: (terms: [(mu: 1, alpha: 2)], bulk: 10)",
        "linear: Young(young: 3e3, poisson: 0.5)",
        "linear: Young(young: 3e3, poisson: 0.4), fibres: (eta: 1, direction: Along(1, 0, 0))",
        "st_venant_kirchhoff: Moduli(shear: -1, bulk: 2)",
        "mooney_rivlin: (c10: -1, c01: 1, bulk: 2)",
        "mooney_rivlin: (c10: 3, c01: -1, bulk: 20)",
        "mooney_rivlin: (c10: 3, c01: 1, bulk: 1)",
        "mooney_rivlin: (c10: 3, c01: 1)",
        "ogden: (terms: [], bulk: 2)",
        "ogden: (terms: [(mu: 1, alpha: 0), (mu: -1, alpha: 2)], bulk: 2)",
        "ogden: (terms: [(mu: 1, alpha: 2), (mu: 1, alpha: 2), (mu: 1, alpha: 2), (mu: 1, alpha: 2), (mu: 1, alpha: 2)], bulk: 20)",
        "arruda_boyce: (shear: 1, locking_stretch: 1, bulk: 2)",
        "arruda_boyce: (shear: 0, locking_stretch: 2, bulk: 0)",
        "neo_hookean: Moduli(shear: 1, bulk: 20), exponential_fibres: []",
        "neo_hookean: Moduli(shear: 1, bulk: 20), exponential_fibres: [(k1: -1, k2: -1, dispersion: 0.4, direction: Along(0, 0, 0))]",
        "neo_hookean: Moduli(shear: 1, bulk: 20), exponential_fibres: [(k1: 1, k2: 1, direction: Field(\"f\"))]",
        "neo_hookean: Moduli(shear: 1, bulk: 20), prony: (volumetric: [(alpha: 1, tau: 0)])",
        "neo_hookean: Moduli(shear: 1, bulk: 20), prony: ()",
    ] {
        println!("{law}\n{}\n", said(law));
    }
}
