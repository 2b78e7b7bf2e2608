//! Laws from an energy: the derivative of the formula is the law that somebody wrote by hand, on every backend.

use crate::configurations::{configurations, near, scene_of};
use crate::random::{Random, gradient};
use sinew::backend::user_law::{Read, read, read_formula};
use sinew::glam::DMat3;
use sinew::materials::{ArrudaBoyce, Elastic, Kinematics, MooneyRivlin, NeoHookean, UserLaw};
use sinew::math::{Mat3, Sym3};
use sinew::{BackendChoice, Options, Simulation};
use std::collections::BTreeMap;
use std::path::Path;

const NEO_HOOKEAN: &str = "mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2";
const MOONEY_RIVLIN: &str = "c10*I1bar_minus_3 + c01*I2bar_minus_3 + kappa/2*(J - 1)^2";
/// Σ Cᵢ λ_m^(2−2i) (Ī₁ⁱ − 3ⁱ), written with as many signs as there are.
const ARRUDA_BOYCE: &str = "mu*((I1bar - 3)/2 + (I1bar^2 - 9)/(20*m^2) + 11/1050*(I1bar^3 - 27)/m^4
    + 19/7000*(I1bar^4 - 81)/m^6 + 519/673750*(I1bar^5 - 243)/m^8) + kappa/2*J_minus_1*J_minus_1";
const DEMIRAY: &str = "mu/(2*b)*(exp(b*I1bar_minus_3) - 1) + bulk/2*J_minus_1^2";

fn named(parameters: &[(&str, f64)]) -> BTreeMap<String, f64> {
    parameters.iter().map(|(name, x)| (name.to_string(), *x)).collect()
}

fn law(formula: &str, parameters: &[(&str, f64)]) -> Read {
    let read = read_formula(formula, &named(parameters)).unwrap_or_else(|wrong| panic!("{formula}: {wrong:?}"));
    assert_eq!(read.warnings, [], "{formula}");
    read
}

/// Displacement gradients from 1e-9 to large strains.
fn gradients() -> Vec<(f64, DMat3)> {
    let mut random = Random(21);
    let mut all = Vec::new();
    for size in [1e-9, 1e-6, 1e-3, 0.1] {
        all.extend((0..50).map(|_| (size, random.matrix() * size)));
    }
    all.extend((0..300).map(|_| (1.0, random.deformation() - DMat3::IDENTITY)));
    all
}

fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    numbers.into_iter().fold(0.0, |largest: f64, x| if x.is_nan() { f64::NAN } else { largest.max(x.abs()) })
}

fn difference(a: &Sym3<f64>, b: &Sym3<f64>) -> f64 {
    largest((0..6).map(|i| a.0[i] - b.0[i]))
}

fn mat(h: DMat3) -> Mat3<f64> {
    gradient(h + DMat3::IDENTITY)
}

/// At every size of strain the error is measured against the stress itself, not against the modulus.
fn is_the_law<L: Elastic<f64>>(formula: &str, parameters: &[(&str, f64)], by_hand: &L) {
    let read = law(formula, parameters);
    let [shear, bulk] = by_hand.small_strain_moduli();
    for (found, expected) in read.law.small_strain_moduli().into_iter().zip([shear, bulk]) {
        assert!((found / expected - 1.0).abs() < 1e-14, "{formula}: a modulus of {found} instead of {expected}");
    }
    let mut worst: [f64; 4] = [0.0; 4];
    for (_, h) in gradients() {
        let k = Kinematics::new(&mat(h));
        let (found, expected) = (read.law.isochoric(&k), by_hand.isochoric(&k));
        let errors = [
            difference(&found, &expected) / largest(expected.0),
            (read.law.pressure(k.volume_change) / by_hand.pressure(k.volume_change) - 1.0).abs(),
            read.law.isochoric_energy(&k) / by_hand.isochoric_energy(&k) - 1.0,
            read.law.volumetric_energy(k.volume_change) / by_hand.volumetric_energy(k.volume_change) - 1.0,
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = if error.is_nan() { f64::NAN } else { worst.max(error.abs()) };
        }
    }
    println!("{formula}: {}, {:?}", worst.map(|x| format!("{x:.1e}")).join(", "), read.law.parts().isochoric.size());
    assert!(worst.iter().all(|error| *error < 1e-12), "{formula}: {worst:?}");
}

#[test]
fn derivatives_of_energies_are_the_laws_written_by_hand() {
    let kappa = ("kappa", 1e4);
    is_the_law(NEO_HOOKEAN, &[("mu", 1034.4828), kappa], &NeoHookean { shear: 1034.4828, bulk: 1e4 });
    // with cancellation written into the formula that the derivation takes out
    let written = "mu/2*(I1bar - 3) + kappa/2*(1 - J)^2";
    is_the_law(written, &[("mu", 1034.4828), kappa], &NeoHookean { shear: 1034.4828, bulk: 1e4 });
    let by_hand = MooneyRivlin { c10: 400.0, c01: 150.0, bulk: 1e4 };
    is_the_law(MOONEY_RIVLIN, &[("c10", 400.0), ("c01", 150.0), kappa], &by_hand);
    let by_hand = ArrudaBoyce { shear: 1000.0, locking_stretch: 1.7, bulk: 1e4 };
    is_the_law(ARRUDA_BOYCE, &[("mu", 1000.0), ("m", 1.7), kappa], &by_hand);
    // a law with its stresses in WGSL
    let parameters = [("mu", 2000.0), ("b", 2.0), ("bulk", 1e5)];
    let text = include_str!("../../examples/own_law.wgsl");
    let by_hand = read("own_law.wgsl", text, &named(&parameters)).unwrap_or_else(|wrong| panic!("{wrong:?}")).law;
    // its moduli are from differences
    let read = law(DEMIRAY, &parameters);
    for (found, expected) in read.law.small_strain_moduli().into_iter().zip([2000.0, 1e5]) {
        assert!((found / expected - 1.0).abs() < 1e-14);
    }
    for (_, h) in gradients() {
        let k = Kinematics::new(&mat(h));
        let (found, expected) = (read.law.isochoric(&k), by_hand.isochoric(&k));
        assert!(difference(&found, &expected) < 1e-12 * largest(expected.0), "{found:?} instead of {expected:?}");
        let expected = by_hand.isochoric_energy(&k);
        near("energy", read.law.isochoric_energy(&k), expected, 2000.0 + expected, 1e-12);
    }
}

/// Yeoh's law with its stress as textbooks have it, 2(c₁ + 2c₂x + 3c₃x²) J^(−2/3) (I − I₁/3 C⁻¹), from F.
#[test]
fn yeohs_law_is_that_of_the_textbook() {
    let (c1, c2, c3) = (500.0, -40.0, 9.0);
    let formula = "c1*I1bar_minus_3 + c2*I1bar_minus_3^2 + c3*I1bar_minus_3^3 + kappa/4*(J^2 - 1 - 2*log(J))";
    let read = law(formula, &[("c1", c1), ("c2", c2), ("c3", c3), ("kappa", 2e4)]);
    assert_eq!(read.law.small_strain_moduli(), [1000.0, 2e4]);
    for (_, h) in gradients() {
        let f = h + DMat3::IDENTITY;
        let (c, j) = (f.transpose() * f, f.determinant());
        let trace = c.x_axis.x + c.y_axis.y + c.z_axis.z;
        let x = j.powf(-2.0 / 3.0) * trace - 3.0;
        let slope = c1 + 2.0 * c2 * x + 3.0 * c3 * x * x;
        let stress = (DMat3::IDENTITY - c.inverse() * (trace / 3.0)) * (2.0 * slope * j.powf(-2.0 / 3.0));
        let expected = Sym3([
            stress.x_axis.x,
            stress.y_axis.y,
            stress.z_axis.z,
            stress.y_axis.x,
            stress.z_axis.y,
            stress.z_axis.x,
        ]);
        let k = Kinematics::new(&mat(h));
        let scale = 1000.0 + largest(expected.0);
        let error = difference(&read.law.isochoric(&k), &expected) / scale;
        assert!(error < 1e-12, "{error:e} of the modulus at {h}");
        let pressure = 1e4 * (j - 1.0 / j);
        near("pressure", read.law.pressure(k.volume_change), pressure, 2e4 + pressure.abs(), 1e-12);
    }
}

/// Every function and operator, in U(J) with a known derivative: the formula, U'(J) in Rust.
#[test]
fn every_function_has_its_derivative() {
    type Slope = fn(f64) -> f64;
    let functions: [(&str, Slope); 24] = [
        ("J_minus_1^2", |j| 2.0 * (j - 1.0)),
        ("-(1 - J)^3 + 4*(J - 1)^2", |j| 3.0 * (1.0 - j).powi(2) + 8.0 * (j - 1.0)),
        ("J^2 - 2*log(J)", |j| 2.0 * j - 2.0 / j),
        ("log(J)^2", |j| 2.0 * j.ln() / j),
        ("log2(J)^2", |j| 2.0 * j.log2() / (j * 2.0_f64.ln())),
        ("exp(J_minus_1) - J", |j| (j - 1.0).exp() - 1.0),
        ("exp2(J_minus_1) - log(2)*J", |j| 2.0_f64.ln() * ((j - 1.0).exp2() - 1.0)),
        ("sqrt(1 + J_minus_1^2)", |j| (j - 1.0) / (1.0 + (j - 1.0).powi(2)).sqrt()),
        ("inverseSqrt(J) + J/2", |j| 0.5 - 0.5 * j.powf(-1.5)),
        ("1/J + J", |j| 1.0 - 1.0 / (j * j)),
        ("J^-2/2 + J", |j| 1.0 - j.powi(-3)),
        ("2*J - 3*J^(2/3)", |j| 2.0 - 2.0 * j.powf(-1.0 / 3.0)),
        ("J - 3*J^(1/3)", |j| 1.0 - j.powf(-2.0 / 3.0)),
        ("pow(J, 1.7) - 1.7*J", |j| 1.7 * (j.powf(0.7) - 1.0)),
        ("pow(2, J) - 2*log(2)*J", |j| 2.0_f64.ln() * (j.exp2() - 2.0)),
        ("J^J - J", |j| j.powf(j) * (j.ln() + 1.0) - 1.0),
        ("tanh(J_minus_1)^2", |j| 2.0 * (j - 1.0).tanh() * (1.0 - (j - 1.0).tanh().powi(2))),
        ("-cos(3*J_minus_1)", |j| 3.0 * (3.0 * (j - 1.0)).sin()),
        ("sin(J_minus_1)^2", |j| (2.0 * (j - 1.0)).sin()),
        ("abs(J_minus_1)^3 + J_minus_1^2", |j| 3.0 * (j - 1.0) * (j - 1.0).abs() + 2.0 * (j - 1.0)),
        ("sign(J_minus_1)*J_minus_1^3 + J_minus_1^2", |j| 3.0 * (j - 1.0) * (j - 1.0).abs() + 2.0 * (j - 1.0)),
        ("max(J - 1, 0)^2 + min(J, 1)^2 - 2*min(J, 1)", |j| 2.0 * (j - 1.0)),
        ("step(1, J)*J_minus_1^2 + J_minus_1^2", |j| (j - 1.0) * if j < 1.0 { 2.0 } else { 4.0 }),
        ("clamp(J_minus_1, -0.7, 0.7)^2", |j| if (j - 1.0).abs() < 0.7 { 2.0 * (j - 1.0) } else { 0.0 }),
    ];
    for (formula, slope) in functions {
        let whole = format!("500*I1bar_minus_3 + k*({formula})");
        let read = read_formula(&whole, &named(&[("k", 1e3)])).unwrap_or_else(|wrong| panic!("{formula}: {wrong:?}"));
        for j in [0.4, 0.65, 0.9, 0.999_999_9, 1.0, 1.000_000_1, 1.1, 1.45, 1.75] {
            let (found, expected) = (read.law.pressure(j - 1.0), 1e3 * slope(j));
            let error = (found - expected).abs();
            assert!(error < 1e-12 * (1e3 + expected.abs()), "{formula} at J = {j}: {found} instead of {expected}");
        }
    }
}

/// Rounding of f32 alone: no more than 32 roundings of half an ε stand one behind another (12 in the strain measures, 8
/// in the slopes, 12 in the stress), each of a number no larger than ‖C⁻¹‖² times the modulus of this deformation times
/// the strain, and more by what slopes grow with Ī₁.
#[test]
fn in_f32_only_rounding_is_lost() {
    let laws = [
        law(NEO_HOOKEAN, &[("mu", 1034.4828), ("kappa", 1e4)]),
        law(MOONEY_RIVLIN, &[("c10", 400.0), ("c01", 150.0), ("kappa", 1e4)]),
        law(ARRUDA_BOYCE, &[("mu", 1000.0), ("m", 1.7), ("kappa", 1e4)]),
        law(DEMIRAY, &[("mu", 2000.0), ("b", 1.0), ("bulk", 1e5)]),
    ];
    for read in &laws {
        let mut worst: f64 = 0.0;
        for (_, h) in gradients() {
            let single: Mat3<f32> = gradient(h + DMat3::IDENTITY);
            let double = Mat3(single.0.map(|row| row.map(f64::from)));
            let (k, exact) = (Kinematics::new(&single), Kinematics::new(&double));
            let (found, expected) = (in_f32(&read.law, &k), read.law.isochoric(&exact));
            let inverse = largest(exact.adjugate_c.0) / exact.j.powi(2);
            let strain = largest(exact.green_strain.0);
            // what the slopes grow by, from the law itself
            let modulus = read.law.small_strain_moduli()[0].max(largest(expected.0) / strain);
            let scale = inverse.powi(2).max(1.0) * modulus * strain * (1.0 + exact.i1_change());
            worst = worst.max(difference(&found, &expected) / scale);
        }
        println!("{:?}: {:.1} ε", read.law, worst / f64::from(f32::EPSILON));
        assert!(worst < 16.0 * f64::from(f32::EPSILON), "{:?}: {worst:e}", read.law);
    }
}

fn in_f32(law: &UserLaw<f64>, k: &Kinematics<f32>) -> Sym3<f64> {
    let law = law.map(|number| number as f32);
    Sym3(Elastic::<f32>::isochoric(&law, k).0.map(f64::from))
}

/// A formula with every kind of instruction that a GPU is given.
const EVERYTHING: &str =
    "c/2*(exp(b*I1bar_minus_3^2) - 1) + mu/2*log(1 + I1bar_minus_3) + c*max(I2bar_minus_3, I1bar_minus_3 - 1)
    + mu*(sqrt(1 + I1bar_minus_3) + tanh(I1bar_minus_3) - cos(I1bar_minus_3)/9 + sin(I1bar_minus_3) + I1bar^1.3)
    + kappa/2*(J^2/2 - log(J)) + kappa*(1/J + J + 2*J - 3*J^(2/3)) + kappa*abs(J_minus_1)^3";

fn everything() -> [(&'static str, f64); 4] {
    [("c", 50.0), ("b", 0.3), ("mu", 400.0), ("kappa", 1e4)]
}

/// The text that a GPU runs is a law by itself: read as one, it gives the same digits.
#[test]
fn the_derived_wgsl_is_the_same_law() {
    for (formula, parameters) in [
        (MOONEY_RIVLIN, &[("c10", 400.0), ("c01", 150.0), ("kappa", 1e4)][..]),
        (DEMIRAY, &[("mu", 2000.0), ("b", 2.0), ("bulk", 1e5)]),
        (EVERYTHING, &everything()),
    ] {
        let law = law(formula, parameters).law;
        let text = &law.parts().text;
        let written =
            read("derived.wgsl", text, &BTreeMap::new()).unwrap_or_else(|wrong| panic!("{wrong:?}\n{text}")).law;
        for (_, h) in gradients() {
            let k = Kinematics::new(&mat(h));
            let (found, expected) = (written.isochoric(&k), law.isochoric(&k));
            let error = difference(&found, &expected) / largest(expected.0);
            assert!(error < 1e-12, "{formula}: {found:?} instead of {expected:?}\n{text}");
            let j = k.volume_change;
            for (found, expected, scale) in [
                (written.pressure(j), law.pressure(j), 1e5),
                (written.isochoric_energy(&k), law.isochoric_energy(&k), 1e3),
                (written.volumetric_energy(j), law.volumetric_energy(j), 1e5),
            ] {
                let scale = scale + expected.abs();
                assert!((found - expected).abs() < 1e-12 * scale, "{formula}: {found} instead of {expected}\n{text}");
            }
        }
    }
}

fn scene(law: &str, elements: &str) -> String {
    format!(
        r#"(duration: 0.02, integration: (when_unstable: Watch), materials: {{"tissue": (density: 1000, {law}, damping: 2, prony: (terms: [(alpha: 0.3, tau: 0.1)]),
fibres: (eta: 500, direction: Along(1, 1, 0)))}},
bodies: {{"bar": (mesh: Box(size: (0.04, 0.02, 0.02), cells: (4, 2, 2), elements: {elements}), material: "tissue")}},
constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
loads: [Gravity(acceleration: (0, 0, -200))])"#
    )
}

/// Arruda and Boyce's energy, its powers in a loop.
const ENERGY_FILE: &str = "struct Law { mu: f32, m: f32, kappa: f32 } @group(0) @binding(0) var<uniform> elastic: Law;
const series = array<f32, 5>(1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673750.0);
fn volumetric(change: f32) -> f32 { return 0.5 * elastic.kappa * change * change; }
fn elastic_energy(s: Invariants) -> f32 {
    var energy = 0.0;
    var power = s.I1bar;
    var chain = 1.0;
    for (var i = 0; i < 5; i++) {
        energy += series[i] * chain * power;
        power *= s.I1bar;
        chain /= elastic.m * elastic.m;
    }
    return elastic.mu * energy + volumetric(s.J_minus_1);
}
";

/// On every backend and element a run under an energy, as a formula and as WGSL, goes as under the built-in law. In f32
/// the two differ by roundings, as runs on the CPU and on the GPU do: the bound is theirs (`user_laws.rs`).
#[test]
#[ignore = "long"]
fn a_run_under_an_energy_goes_as_under_the_law_built_in() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("energy.wgsl"), ENERGY_FILE).unwrap();
    let built_in = "arruda_boyce: (shear: 900, locking_stretch: 2, bulk: 1e4)";
    let parameters = r#"parameters: {"mu": 900, "m": 2, "kappa": 1e4}"#;
    let laws = [
        built_in.to_owned(),
        format!(r#"law: (energy: "{ARRUDA_BOYCE}", {parameters})"#),
        format!(r#"law: (file: "energy.wgsl", {parameters})"#),
    ];
    for elements in ["Tet4", "Hex8", "Tet4NodalPressure", "Hex8MeanDilatation"] {
        for configuration in configurations() {
            let runs: Vec<_> = laws
                .iter()
                .map(|law| {
                    let mut run = configuration.start_in(&scene(law, elements), folder.path());
                    run.advance_to(0.02).unwrap();
                    (run.displacements("bar").unwrap(), run.energies().unwrap().strain)
                })
                .collect();
            let (expected, strain) = &runs[0];
            let largest = expected.iter().fold(0.0, |largest: f64, u| largest.max(u.length()));
            assert!(largest > 1e-3, "the bar falls by {largest} m only");
            for (found, energy) in &runs[1..] {
                let error = found.iter().zip(expected).fold(0.0, |worst: f64, (a, b)| worst.max((*a - *b).length()));
                let what = format!("{elements} on {}", configuration.name);
                near(&what, error / largest, 0.0, 1.0, configuration.bound(1e-10, 2e-5));
                near("elastic energy", *energy, *strain, *strain, configuration.bound(1e-10, 1e-4));
            }
        }
    }
}

/// The neo-Hookean and the Mooney-Rivlin law are recognised by their derivatives, and are to the last bit what they are
/// built in.
#[test]
fn an_energy_of_a_law_built_in_is_that_law() {
    let kappa = r#""kappa": 10000"#;
    let pairs = [
        (
            "neo_hookean: Moduli(shear: 1034.5, bulk: 10000)",
            format!(r#"law: (energy: "mu*(I1bar - 3)/2 + kappa*(J - 1)^2/2", parameters: {{"mu": 1034.5, {kappa}}})"#),
        ),
        (
            "mooney_rivlin: (c10: 300, c01: 217, bulk: 10000)",
            format!(r#"law: (energy: "{MOONEY_RIVLIN}", parameters: {{"c10": 300, "c01": 217, {kappa}}})"#),
        ),
    ];
    for (built_in, energy) in pairs {
        for configuration in configurations() {
            let [expected, found] = [built_in, energy.as_str()].map(|law| {
                let mut run = configuration.start(&scene(law, "Hex8"));
                run.advance(20).unwrap();
                run.displacements("bar").unwrap()
            });
            assert!(expected == found && expected.iter().any(|u| u.length() > 0.0), "{energy}: {}", configuration.name);
        }
    }
    // another pressure makes it another law
    let other = "mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2 + kappa/100*J_minus_1^4";
    assert!(law(other, &[("mu", 1e3), ("kappa", 1e4)]).built_in.is_none());
}

/// What the formula or a parameter says is part of what a simulation is.
#[test]
fn a_snapshot_belongs_to_its_formula_and_parameters() {
    let law = r#"law: (energy: "mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2", parameters: {"mu": 1000, "kappa": 10000})"#;
    let start = |law: &str| {
        let file =
            scene_of(&scene(law, "Hex8").replace("(when_unstable", "(step: 1e-5, when_unstable"), Path::new("."));
        let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
        Simulation::new(&file, &options).unwrap_or_else(|error| panic!("{error}"))
    };
    let mut run = start(law);
    run.advance(3).unwrap();
    let kept = run.snapshot().unwrap();
    start(law).restore(&kept).unwrap();
    for (old, new) in [("\"mu\": 1000", "\"mu\": 1001"), ("J_minus_1^2", "J_minus_1^2.0"), ("mu/2*", "0.5*mu*")] {
        assert!(law.contains(old));
        let refused = start(&law.replacen(old, new, 1)).restore(&kept).unwrap_err().to_string();
        assert!(refused.contains("materials"), "{new}: {refused}");
    }
}
