//! Laws from an energy at small strains and at the ends of their domains: what formulas lose when they are computed as
//! they are written, and what rounding makes of an invariant that is 0.

use crate::random::{Random, gradient};
use sinew::backend::user_law::{Read, read, read_formula};
use sinew::glam::DMat3;
use sinew::materials::{Elastic, Kinematics};
use sinew::math::{Mat3, Sym3};
use std::collections::BTreeMap;

fn named(parameters: &[(&str, f64)]) -> BTreeMap<String, f64> {
    parameters.iter().map(|(name, x)| (name.to_string(), *x)).collect()
}

fn law(formula: &str, parameters: &[(&str, f64)]) -> Read {
    read_formula(formula, &named(parameters)).unwrap_or_else(|wrong| panic!("{formula}: {wrong:?}"))
}

/// A U(J), with U and U' as series or closed forms that keep all digits: θ ↦ (U, U').
type Exact = fn(f64) -> [f64; 2];

/// ln(1 + x) − x and e^x − 1 − x of any x below ½, summed term by term.
fn log_remainder(x: f64) -> f64 {
    (2..200).map(|k| -(-x).powi(k) / f64::from(k)).sum()
}

fn exp_remainder(x: f64) -> f64 {
    let mut term = x;
    (2..40)
        .map(|k| {
            term *= x / f64::from(k);
            term
        })
        .sum()
}

/// (1 + x)^p − 1 − p x by its binomial series.
fn power_remainder(p: f64, x: f64) -> f64 {
    let mut term = p * x;
    (2..200)
        .map(|k| {
            term *= (p - f64::from(k - 1)) / f64::from(k) * x;
            term
        })
        .sum()
}

const VOLUMETRIC: [(&str, Exact); 9] = [
    ("(J^2 - 1 - 2*log(J))/4", |x| [0.25 * (x * x - 2.0 * log_remainder(x)), 0.5 * (x + x / (1.0 + x))]),
    ("log(J)^2/2", |x| [0.5 * x.ln_1p().powi(2), x.ln_1p() / (1.0 + x)]),
    ("J - 1 - log(J)", |x| [-log_remainder(x), x / (1.0 + x)]),
    ("exp(2*J_minus_1)/4 - J/2", |x| [0.25 * exp_remainder(2.0 * x), 0.5 * (2.0 * x).exp_m1()]),
    ("2*J - 3*J^(2/3)", |x| [-3.0 * power_remainder(2.0 / 3.0, x), -2.0 * (-x.ln_1p() / 3.0).exp_m1()]),
    ("(J^2.6 - 2.6*J)/4.16", |x| [power_remainder(2.6, x) / 4.16, 2.6 / 4.16 * (1.6 * x.ln_1p()).exp_m1()]),
    ("sqrt(1 + J_minus_1^2)", |x| [x * x / (1.0 + (1.0 + x * x).sqrt()), x / (1.0 + x * x).sqrt()]),
    ("1/(2*J) + J/2", |x| [0.5 * x * x / (1.0 + x), 0.5 * x * (2.0 + x) / (1.0 + x).powi(2)]),
    ("-cos(J_minus_1)", |x| [2.0 * (0.5 * x).sin().powi(2), x.sin()]),
];

/// The written forms lose all digits at θ = 1e-5 in f32, and half of them in f64.
#[test]
fn pressures_and_energies_of_volume_keep_their_digits_at_small_strains() {
    for (formula, exact) in VOLUMETRIC {
        let read = law(&format!("500*I1bar_minus_3 + k*({formula})"), &[("k", 1e4)]);
        assert_eq!(read.warnings, [], "{formula}");
        let single = read.law.map(|x| x as f32);
        let mut worst = [0.0_f64; 4];
        for size in [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 0.2, 0.3] {
            for theta in [size, -size] {
                let [energy, pressure] = exact(theta);
                let theta_single = theta as f32;
                let [energy_single, pressure_single] = exact(f64::from(theta_single));
                let errors = [
                    read.law.volumetric_energy(theta) / (1e4 * energy) - 1.0,
                    read.law.pressure(theta) / (1e4 * pressure) - 1.0,
                    f64::from(Elastic::<f32>::volumetric_energy(&single, theta_single)) / (1e4 * energy_single) - 1.0,
                    f64::from(Elastic::<f32>::pressure(&single, theta_single)) / (1e4 * pressure_single) - 1.0,
                ];
                for (worst, error) in worst.iter_mut().zip(errors) {
                    *worst = if error.is_nan() { f64::NAN } else { worst.max(error.abs()) };
                }
            }
        }
        println!("{formula}: {}", worst.map(|x| format!("{x:.1e}")).join(", "));
        // 64 roundings of half an ε; in f64 the sums of this test have as many
        let bound = |epsilon: f64| 32.0 * epsilon;
        let f32_bound = bound(f32::EPSILON.into());
        let bounds = [bound(f64::EPSILON), bound(f64::EPSILON), f32_bound, f32_bound];
        assert!(worst.iter().zip(bounds).all(|(error, bound)| *error < bound), "{formula}: {worst:?} of {bounds:?}");
    }
}

/// Functions of Ī₁ and Ī₂ with their value and derivative known: x ↦ (Ψ, Ψ').
const ISOCHORIC: [(&str, Exact); 8] = [
    ("(exp(b*X) - 1)/(2*b)", |x| [x.exp_m1() / 2.0, 0.5 * x.exp()]),
    ("exp(X)/2", |x| [x.exp_m1() / 2.0, 0.5 * x.exp()]),
    ("-20*log(1 - X/40)", |x| [-20.0 * (-x / 40.0).ln_1p(), 0.5 / (1.0 - x / 40.0)]),
    ("X/2 + X^1.3/7", |x| [x / 2.0 + x.powf(1.3) / 7.0, 0.5 + 1.3 / 7.0 * x.powf(0.3)]),
    ("X/2 + X^1.5 + X^2.5", |x| [x / 2.0 + x.powf(1.5) + x.powf(2.5), 0.5 + 1.5 * x.sqrt() + 2.5 * x.powf(1.5)]),
    ("X/2 + X^n/3", |x| [x / 2.0 + x * x / 3.0, 0.5 + 2.0 / 3.0 * x]),
    ("sqrt(1 + X)", |x| [x / (1.0 + (1.0 + x).sqrt()), 0.5 / (1.0 + x).sqrt()]),
    ("0.75*(X + 3)^(2/3)*3^(1/3)", |x| {
        [2.25 * (2.0 / 3.0 * (x / 3.0).ln_1p()).exp_m1(), 0.5 * (1.0 + x / 3.0).powf(-1.0 / 3.0)]
    }),
];

/// In Ī₁ and Ī₂ and at rest, around it and far from it; energies to all digits of Ī₁ − 3.
#[test]
fn functions_of_both_invariants_have_their_derivatives_near_rest() {
    let mut random = Random(5);
    for (formula, exact) in ISOCHORIC {
        for second in [false, true] {
            let name = if second { "I2bar_minus_3" } else { "I1bar_minus_3" };
            let whole = format!("mu*({}) + 5e3*J_minus_1^2", formula.replace('X', name));
            let mut parameters = vec![("mu", 2e3)];
            parameters.extend(formula.contains("b*").then_some(("b", 1.0)));
            parameters.extend(formula.contains("^n").then_some(("n", 2.0)));
            let read = law(&whole, &parameters);
            assert_eq!(read.warnings, [], "{whole}");
            let mut worst: [f64; 2] = [0.0; 2];
            for size in [0.0, 1e-9, 1e-6, 1e-4, 1e-2, 0.3] {
                let h = random.matrix() * size;
                let k = Kinematics::new(&gradient::<f64>(h + DMat3::IDENTITY));
                let x = if second { k.i2_change() } else { k.i1_change() }.max(0.0);
                let [energy, slope] = exact(x);
                let [first, second] = if second { [0.0, slope] } else { [slope, 0.0] };
                let expected = k.stress_of_slopes(2e3 * first, 2e3 * second);
                let found = read.law.isochoric(&k);
                let scale = 2e3 * largest(&k.green_strain).max(f64::MIN_POSITIVE);
                let error = (0..6).map(|i| (found.0[i] - expected.0[i]).abs()).fold(0.0, f64::max);
                let energy = (read.law.isochoric_energy(&k) - 2e3 * energy).abs() / (2e3 * energy).max(1e-300);
                for (worst, error) in worst.iter_mut().zip([error / scale, energy]) {
                    *worst = if error.is_nan() { f64::NAN } else { worst.max(error) };
                }
            }
            println!("{whole}: {}", worst.map(|x| format!("{x:.1e}")).join(", "));
            assert!(worst.iter().all(|error| *error < 1e-13), "{whole}: {worst:?}");
        }
    }
}

fn largest(of: &Sym3<f64>) -> f64 {
    of.0.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

/// Rounding takes Ī₁ − 3 of a change of volume below 0, where fractional powers are no numbers.
#[test]
fn what_rounding_makes_of_no_isochoric_strain_is_no_strain() {
    let read = law(
        "mu/2*I1bar_minus_3 + c*I1bar_minus_3^1.3 + c*I2bar_minus_3^1.5 + k/2*J_minus_1^2",
        &[("mu", 1e3), ("c", 100.0), ("k", 1e4)],
    );
    let mut below = 0;
    let mut random = Random(11);
    for number in 0..300 {
        let size = 10.0_f64.powf(-6.0 + 5.5 * f64::from(number) / 300.0);
        for f in [DMat3::IDENTITY * (1.0 + size), DMat3::IDENTITY * (1.0 - size), random.rotation()] {
            let k = Kinematics::new(&gradient::<f64>(f));
            below += usize::from(k.i1_change() < 0.0) + usize::from(k.i2_change() < 0.0);
            let (stress, energy) = (read.law.isochoric(&k), read.law.isochoric_energy(&k));
            // an ε of strain makes ε^1.3 of slope, and an energy of the square at most
            assert!(largest(&stress) < 1e-11 && (0.0..1e-11).contains(&energy), "{f}: {stress:?}, {energy:e}");
        }
    }
    assert!(below > 100, "only {below} invariants are below 0: nothing is tried");
    // the text that a GPU runs
    assert!(read.law.parts().text.contains("max(i1_change(k), 0.0)"));
}

/// Beyond the stretch at which chains are straight Gent's law has no stress: none of the wrong sign.
#[test]
fn beyond_the_end_of_its_domain_a_law_has_no_stress() {
    let read = law("-mu*Jm/2*log(1 - I1bar_minus_3/Jm) + k/2*log(J)^2", &[("mu", 1e3), ("Jm", 0.5), ("k", 1e4)]);
    assert_eq!(read.findings.finite_up_to, Some(0.5));
    let shear = |amount: f64| {
        let mut h = Mat3([[0.0; 3]; 3]);
        h.0[0][1] = amount;
        Kinematics::new(&h)
    };
    // Ī₁ − 3 is the square of the shear
    for (square, inside) in [(0.4, true), (0.499, true), (0.501, false), (0.8, false), (5.0, false)] {
        let k = shear(f64::sqrt(square));
        let (stress, energy) = (read.law.isochoric(&k).0, read.law.isochoric_energy(&k));
        assert_eq!(stress.iter().all(|s| s.is_finite()), inside, "at {square}: {stress:?}");
        assert_eq!(energy.is_finite(), inside, "at {square}: {energy}");
        assert!(!inside || stress[3] > 0.0);
    }
    let single = read.law.map(|x| x as f32);
    assert!(
        Elastic::<f32>::isochoric(&single, &Kinematics::new(&Mat3([[0.0, 0.9, 0.0], [0.0; 3], [0.0; 3]]))).0[3]
            .is_nan()
    );
}

/// A modulus at a kink is that of the side that is there, whatever the other modulus is.
#[test]
fn moduli_at_a_kink_are_those_of_the_energy() {
    for ratio in [10.0, 1e4, 1e7] {
        let read = law("mu/2*max(I1bar_minus_3, 0) + k/2*J_minus_1^2", &[("mu", 1e3), ("k", 1e3 * ratio)]);
        let [shear, bulk] = read.law.small_strain_moduli();
        assert!((shear / 1e3 - 1.0).abs() < 1e-5, "κ/μ = {ratio}: {shear}");
        assert!((bulk / (1e3 * ratio) - 1.0).abs() < 1e-12, "κ/μ = {ratio}: {bulk}");
    }
}

/// Exponents, array indices, loop bounds and branches by parameters, in WGSL.
#[test]
fn what_parameters_choose_is_known_when_the_energy_is_derived() {
    let file = "struct Law { mu: f32, n: f32, which: f32, kappa: f32 }
@group(0) @binding(0) var<uniform> elastic: Law;
const factors = array<f32, 3>(0.25, 0.5, 2.0);
fn elastic_energy(s: Invariants) -> f32 {
    var energy = factors[i32(elastic.which)] * elastic.mu * s.I1bar_minus_3;
    for (var i = 0; i < i32(elastic.n); i++) {
        energy += elastic.mu / 10.0 * pow(s.I1bar_minus_3, elastic.n);
    }
    if s.J_minus_1 > 0.0 {
        return energy + elastic.kappa * s.J_minus_1 * s.J_minus_1;
    }
    if elastic.which > 0.5 {
        energy += 0.5 * elastic.kappa * s.J_minus_1 * s.J_minus_1;
    }
    return energy + 0.5 * elastic.kappa * s.J_minus_1 * s.J_minus_1;
}
";
    let given = named(&[("mu", 1e3), ("n", 2.0), ("which", 1.0), ("kappa", 1e4)]);
    let read = read("energy.wgsl", file, &given).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    assert_eq!(read.warnings, []);
    assert!(read.law.parts().uniform.is_empty());
    let by_hand = law("mu/2*I1bar_minus_3 + mu/5*I1bar_minus_3^2 + k*J_minus_1^2", &[("mu", 1e3), ("k", 1e4)]);
    assert_eq!(read.law.small_strain_moduli(), [1e3, 2e4]);
    let mut random = Random(3);
    for _ in 0..100 {
        let k = Kinematics::new(&gradient::<f64>(random.deformation()));
        let (found, expected) = (read.law.isochoric(&k), by_hand.law.isochoric(&k));
        let error = (0..6).map(|i| (found.0[i] - expected.0[i]).abs()).fold(0.0, f64::max);
        assert!(error < 1e-13 * largest(&expected), "{found:?} instead of {expected:?}");
        let (found, expected) = (read.law.pressure(k.volume_change), by_hand.law.pressure(k.volume_change));
        assert!((found - expected).abs() <= 1e-13 * expected.abs(), "{found} instead of {expected}");
    }
}

/// Energies in f32 at strains of 1e-4, on the whole and as the check finds them.
#[test]
fn energies_in_f32_are_told_of_where_they_lose_digits() {
    let kept = law("mu/2*I1bar_minus_3 + kappa/4*(J^2 - 1 - 2*log(J))", &[("mu", 1e3), ("kappa", 1e6)]);
    assert!(kept.findings.single_precision_energy_error < 2e-3, "{:?}", kept.findings);
    // the same by hand, as textbooks have it
    let text = "fn elastic_isochoric(k: Kinematics) -> Sym3 { return stress_of_slope(k, 500.0); }
fn elastic_pressure(volume_change: f32) -> f32 { return 5e5 * (volume_change + volume_change / (1.0 + volume_change)); }
fn elastic_isochoric_energy(k: Kinematics) -> f32 { return 500.0 * i1_change(k); }
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    let j = 1.0 + volume_change;
    return 2.5e5 * (j * j - 1.0 - 2.0 * log(j));
}
";
    let lost = read("own.wgsl", text, &named(&[])).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    assert!(lost.findings.single_precision_energy_error > 0.1, "{:?}", lost.findings);
    let [warning] = lost.warnings.as_slice() else { panic!("{:?}", lost.warnings) };
    assert!(warning.warning && warning.message.starts_with("in f32 the energy errs by "), "{warning:?}");
}

/// 4 ∂²Ψ/∂C² : ΔE against differences of the stress of fourth order.
#[test]
fn tangents_are_the_derivatives_of_the_stress() {
    const STEP: f64 = 1e-3;
    let laws = [
        law("mu/2*I1bar_minus_3 + k/4*(J^2 - 1 - 2*log(J))", &[("mu", 1e3), ("k", 1e4)]),
        law("a*I1bar_minus_3 + b*I2bar_minus_3 + k/2*J_minus_1^2", &[("a", 300.0), ("b", 200.0), ("k", 1e4)]),
        law("mu/(2*b)*(exp(b*I1bar_minus_3) - 1) + k/2*log(J)^2", &[("mu", 1e3), ("b", 1.5), ("k", 1e4)]),
        law(
            "c*(I1bar_minus_3*I2bar_minus_3 + I2bar_minus_3^2 + 4*I1bar_minus_3) + k*(J - log(J))",
            &[("c", 100.0), ("k", 1e4)],
        ),
    ];
    let mut random = Random(8);
    for read in &laws {
        let parts = read.law.parts();
        let mut worst: f64 = 0.0;
        for number in 0..60 {
            let f = match number {
                0 => DMat3::IDENTITY,
                _ => random.deformation(),
            };
            let change = random.matrix();
            let stress = |by: f64| {
                let k = Kinematics::new(&gradient::<f64>(f + change * by));
                read.law.isochoric(&k).plus(&k.adjugate_c.scaled(read.law.pressure(k.volume_change) / k.j))
            };
            // from −3 to 3 steps: of sixth order
            let mut expected = Sym3([0.0; 6]);
            for (steps, factor) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
                let difference = stress(steps * STEP).plus_scaled(-1.0, &stress(-steps * STEP));
                expected = expected.plus_scaled(factor / STEP, &difference);
            }
            let e = (f.transpose() * change + change.transpose() * f) * 0.5;
            let strain = Sym3([e.x_axis.x, e.y_axis.y, e.z_axis.z, e.y_axis.x, e.z_axis.y, e.z_axis.x]);
            let found = parts.tangent_times(&Kinematics::new(&gradient::<f64>(f)), &strain).unwrap();
            let error = (0..6).map(|i| (found.0[i] - expected.0[i]).abs()).fold(0.0, f64::max) / largest(&expected);
            worst = if error.is_nan() { f64::NAN } else { worst.max(error) };
        }
        println!("{:?}: {worst:.1e}", read.law);
        assert!(worst < 1e-8, "{:?}: {worst:e}", read.law);
    }
}

/// A constant that is no number, in the midst of arithmetic, is none in the text that a GPU runs either.
#[test]
fn what_is_no_number_has_no_name_in_the_derived_wgsl() {
    let file = "struct Law { mu: f32, outside: f32, kappa: f32 }
@group(0) @binding(0) var<uniform> elastic: Law;
fn elastic_energy(s: Invariants) -> f32 {
    var energy = elastic.mu * s.I1bar_minus_3 + elastic.kappa * s.J_minus_1 * s.J_minus_1;
    if s.J > 10.0 {
        energy += log(elastic.outside) * s.J;
    }
    return energy;
}
";
    let read_energy = read("energy.wgsl", file, &named(&[("mu", 1e3), ("outside", -1.0), ("kappa", 1e4)]));
    let law = read_energy.unwrap_or_else(|wrong| panic!("{wrong:?}")).law;
    let text = &law.parts().text;
    assert!(text.contains("no_number(0.0)") && !text.contains("NaN"), "{text}");
    let written = read("derived.wgsl", text, &named(&[])).unwrap_or_else(|wrong| panic!("{wrong:?}\n{text}")).law;
    for law in [&law, &written] {
        assert!(law.volumetric_energy(8.0).is_finite() && law.volumetric_energy(10.0).is_nan());
        assert!(law.pressure(8.0).is_finite() && law.pressure(10.0).is_nan());
    }
}
