//! Materials of made-up scenes.

use crate::dice::{number, one_of, size};
use fastrand::Rng;

/// Two materials, `m` and `n`; and whether elements go when they turn inside out.
pub fn materials(r: &mut Rng) -> (String, bool) {
    let both = ["m", "n"].map(|name| format!("\"{name}\": ({})", material(r)));
    let decides = both.iter().any(|text| text.contains("inversion: Remove"));
    (both.join(", "), decides)
}

fn material(r: &mut Rng) -> String {
    let shear = size(r, 100.0, 1e5);
    let bulk = shear * size(r, 2.0, 200.0);
    let moduli = format!("Moduli(shear: {shear:?}, bulk: {bulk:?})");
    let law = match r.u8(..9) {
        0 => format!("linear: {moduli}"),
        1 => format!("st_venant_kirchhoff: {moduli}"),
        2 => format!("stable_neo_hookean: {moduli}"),
        3 => format!("mooney_rivlin: (c10: {:?}, c01: {:?}, bulk: {bulk:?})", 0.4 * shear, 0.1 * shear),
        4 => format!(
            "ogden: (terms: [(mu: {:?}, alpha: {:?}), (mu: {:?}, alpha: {:?})], bulk: {bulk:?})",
            0.3 * shear,
            number(r, 1.0, 8.0),
            -0.1 * shear,
            number(r, -5.0, -1.0)
        ),
        5 => format!("arruda_boyce: (shear: {shear:?}, locking_stretch: {:?}, bulk: {bulk:?})", number(r, 1.5, 7.0)),
        _ => format!("neo_hookean: {moduli}"),
    };
    let recovers = law.starts_with("stable");
    let mut all = vec![format!("density: {:?}", size(r, 500.0, 3000.0)), law];
    let direction = |r: &mut Rng| match r.bool() {
        true => format!("Along({:?}, {:?}, 1)", r.f64(), r.f64()),
        false => "Around(axis: (0, 0.2, 1))".to_string(),
    };
    if r.u8(..4) == 0 {
        all.push(format!(
            "fibres: (eta: {:?}, direction: {}, tension_only: {})",
            shear * size(r, 0.1, 20.0),
            direction(r),
            r.bool()
        ));
    }
    if r.u8(..6) == 0 {
        all.push(format!(
            "exponential_fibres: [(k1: {:?}, k2: {:?}, dispersion: {:?}, direction: {})]",
            shear * size(r, 0.1, 3.0),
            size(r, 0.5, 20.0),
            number(r, 0.0, 0.33),
            direction(r)
        ));
    }
    if r.u8(..3) == 0 {
        let term = |r: &mut Rng| format!("(alpha: {:?}, tau: {:?})", number(r, 0.0, 0.45), size(r, 1e-5, 10.0));
        let integrator = one_of(r, &["Exact", "BackwardEuler"]);
        all.push(format!(
            "prony: (terms: [{}, {}], volumetric: [{}], integrator: {integrator}, reproject: {})",
            term(r),
            term(r),
            term(r),
            r.bool()
        ));
    }
    if r.u8(..3) == 0 {
        all.push(format!("damping: {:?}", size(r, 0.1, 100.0)));
    }
    let plain = !all.iter().any(|part| part.contains("fibres") || part.contains("prony"));
    match r.u8(..6) {
        0 => all.push("inversion: Remove".into()),
        1 => all.push("inversion: Stop".into()),
        2 if recovers && plain => all.push("inversion: Recover".into()),
        _ => {}
    }
    all.join(", ")
}
