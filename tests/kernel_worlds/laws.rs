//! Laws and fibres that worlds are made with, as scenes write them.

pub const LAWS: [&str; 10] = [
    "linear: Moduli(shear: 1034, bulk: 10000)",
    "st_venant_kirchhoff: Moduli(shear: 1034, bulk: 10000)",
    "neo_hookean: Moduli(shear: 1034, bulk: 10000)",
    "stable_neo_hookean: Moduli(shear: 1034, bulk: 10000)",
    "mooney_rivlin: (c10: 300, c01: 200, bulk: 10000)",
    "ogden: (terms: [(mu: 1400, alpha: 1.3), (mu: 3, alpha: 5), (mu: -30, alpha: -2)], bulk: 10000)",
    "arruda_boyce: (shear: 700, locking_stretch: 1.8, bulk: 10000)",
    "law: (energy: \"c1*I1bar_minus_3 + c2*I2bar_minus_3 + c/2*(exp(b*I1bar_minus_3^2) - 1) + kappa/4*(J^2 - 1 - 2*log(J))\", parameters: {\"c1\": 300, \"c2\": 150, \"c\": 20, \"b\": 0.4, \"kappa\": 10000})",
    GROWING,
    "corotational: Moduli(shear: 1034, bulk: 10000)",
];

/// A law of which each element has numbers of its own.
pub const FRAMED: &str = "corotational: Moduli(shear: 1034, bulk: 10000, rotation: Frame)";

/// For each of the built-in laws of [`LAWS`] numbers that two copies may have.
pub const VARIED: [(&str, &str); 8] = [
    (LAWS[0], "\"tissue.linear.shear\": Values([700, 1500])"),
    (LAWS[1], "\"tissue.st_venant_kirchhoff.bulk\": Values([8000, 15000])"),
    (LAWS[2], "\"tissue.neo_hookean.shear\": Linear(1500, 700), \"tissue.neo_hookean.bulk\": Linear(9000, 12000)"),
    (LAWS[3], "\"tissue.stable_neo_hookean.shear\": Values([700, 1500])"),
    (LAWS[4], "\"tissue.mooney_rivlin.c10\": Values([200, 400]), \"tissue.mooney_rivlin.c01\": Values([100, 300])"),
    (LAWS[5], "\"tissue.ogden.terms[0].alpha\": Values([1.3, 2.5]), \"tissue.ogden.terms[1].mu\": Values([2, 5])"),
    (LAWS[6], "\"tissue.arruda_boyce.locking_stretch\": Values([1.8, 2.6])"),
    (LAWS[9], "\"tissue.corotational.shear\": Values([700, 1500])"),
];

/// A number of viscosity that two copies may have.
pub const VARIED_TERM: &str = "\"tissue.prony.terms[0].alpha\": Values([0.4, 0.2])";

/// An energy whose terms of first order cancel as it is written.
pub const GROWING: &str = "law: (energy: \"mu/2*I1bar_minus_3 + kappa/b^2*(exp(b*J_minus_1) - b*J_minus_1)\", parameters: {\"mu\": 1034, \"b\": 3, \"kappa\": 10000})";

/// One family along a line, and one around an axis that pushes, too.
pub const FAMILIES: &str = "[(k1: 900, k2: 0.4, dispersion: 0.1, direction: Along(1, 2, 3)),
    (k1: 700, k2: 0.3, direction: Around(axis: (0.3, 0.2, 1)), tension_only: false)]";

pub const ALONG: &str = "Along(1, 2, 3)";
pub const AROUND: &str = "Around(center: (0.1, 0.2, -0.3), axis: (0.3, 0.2, 1))";
