//! Laws of one's own in WGSL: what the translation makes of our own WGSL twins is the Rust law, on every backend.

use crate::configurations::{ELEMENTS, cpu_and_long_gpu, near};
use crate::random::Random;
use sinew::backend::user_law::{LawCheck, read};
use sinew::glam::DMat3;
use sinew::materials::{ArrudaBoyce, Elastic, Kinematics, MooneyRivlin, NeoHookean, Ogden, UserLaw};
use sinew::math::Mat3;
use std::collections::BTreeMap;
use std::path::Path;

const NEO_HOOKEAN: &str = include_str!("../../shaders/neo_hookean.wgsl");

fn law(text: &str, parameters: &[(&str, f64)]) -> (UserLaw<f64>, LawCheck) {
    let parameters: BTreeMap<String, f64> = parameters.iter().map(|(name, x)| (name.to_string(), *x)).collect();
    let read = read("law.wgsl", text, &parameters).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    assert_eq!(read.warnings, []);
    (read.law, read.findings)
}

fn kinematics(f: DMat3) -> Kinematics<f64> {
    let h = f - DMat3::IDENTITY;
    Kinematics::new(&Mat3(std::array::from_fn(|i| std::array::from_fn(|j| h.col(j)[i]))))
}

/// A translation against its Rust twin: stresses, pressures, energies, moduli.
fn is_the_rust_law<L: Elastic<f64>>(text: &str, parameters: &[(&str, f64)], rust: &L) {
    let (own, findings) = law(text, parameters);
    let [shear, bulk] = rust.small_strain_moduli();
    let mut random = Random(7);
    for _ in 0..300 {
        let k = kinematics(random.deformation());
        let (found, expected) = (own.isochoric(&k).0, rust.isochoric(&k).0);
        let scale = expected.iter().fold(shear, |scale: f64, x| scale.max(x.abs()));
        for i in 0..6 {
            assert!((found[i] - expected[i]).abs() <= 1e-12 * scale, "{found:?} instead of {expected:?}");
        }
        let pairs = [
            (own.pressure(k.volume_change), rust.pressure(k.volume_change)),
            (own.isochoric_energy(&k), rust.isochoric_energy(&k)),
            (own.volumetric_energy(k.volume_change), rust.volumetric_energy(k.volume_change)),
        ];
        for (found, expected) in pairs {
            assert!((found - expected).abs() <= 1e-12 * (shear + expected.abs()), "{found} instead of {expected}");
        }
    }
    let moduli = own.small_strain_moduli();
    near("shear modulus", moduli[0], shear, shear, 1e-8);
    near("bulk modulus", moduli[1], bulk, bulk, 1e-8);
    assert!(findings.derivative_error < 1e-6 && findings.single_precision_error < 1e-4, "{findings:?}");
    assert_eq!(findings.finite_up_to, None);
}

#[test]
fn our_own_wgsl_read_as_a_users_law_is_the_rust_law() {
    let bulk = ("bulk", 1e4);
    let rust = NeoHookean { shear: 1034.4828, bulk: 1e4 };
    is_the_rust_law(NEO_HOOKEAN, &[("shear", 1034.4828), bulk], &rust);
    let text = include_str!("../../shaders/mooney_rivlin.wgsl");
    is_the_rust_law(text, &[("c10", 400.0), ("c01", 150.0), bulk], &MooneyRivlin { c10: 400.0, c01: 150.0, bulk: 1e4 });
    let text = include_str!("../../shaders/arruda_boyce.wgsl");
    let rust = ArrudaBoyce { shear: 1000.0, locking_stretch: 1.7, bulk: 1e4 };
    is_the_rust_law(text, &[("shear", 1000.0), ("locking_stretch", 1.7), bulk], &rust);
}

/// Ψ = 2μ/α² Σ(λ̄^α − 1), Ogden's law with one term, written with eigenvalues: what a law in principal stretches looks
/// like.
#[test]
fn a_law_in_principal_stretches_is_ogdens() {
    let text = "struct Law { mu: f32, alpha: f32, bulk: f32 } @group(0) @binding(0) var<uniform> elastic: Law;
fn logarithms(values: vec3<f32>) -> vec3<f32> {
    let l = 0.5 * vec3<f32>(logarithm_of_one_plus(2.0 * values.x), logarithm_of_one_plus(2.0 * values.y), logarithm_of_one_plus(2.0 * values.z));
    return l - (l.x + l.y + l.z) / 3.0;
}
fn powers(l: vec3<f32>) -> vec3<f32> {
    let x = elastic.alpha * l;
    return vec3<f32>(exponential_less_one(x.x), exponential_less_one(x.y), exponential_less_one(x.z));
}
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let eigen = sym_eigen(k.green_strain);
    let p = powers(logarithms(eigen.values));
    let principal = elastic.mu * (p - (p.x + p.y + p.z) / 3.0) / (1.0 + 2.0 * eigen.values);
    var stress = sym_scaled(sym_square_of(eigen.vectors[0]), principal.x);
    stress = sym_plus(stress, sym_scaled(sym_square_of(eigen.vectors[1]), principal.y));
    return sym_plus(stress, sym_scaled(sym_square_of(eigen.vectors[2]), principal.z));
}
fn elastic_pressure(change: f32) -> f32 { return elastic.bulk * change; }
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let p = powers(logarithms(sym_eigen(k.green_strain).values));
    return elastic.mu / elastic.alpha * (p.x + p.y + p.z);
}
fn elastic_volumetric_energy(change: f32) -> f32 { return 0.5 * elastic.bulk * change * change; }
";
    let (own, findings) = law(text, &[("mu", 300.0), ("alpha", 5.0), ("bulk", 1e4)]);
    let rust = Ogden::new(&[(300.0, 5.0)], 1e4);
    let mut random = Random(9);
    for _ in 0..100 {
        let k = kinematics(random.deformation());
        let (found, expected) = (own.isochoric(&k).0, rust.isochoric(&k).0);
        let scale = expected.iter().fold(1.0, |scale: f64, x| scale.max(x.abs()));
        let error = (0..6).fold(0.0, |worst: f64, i| worst.max((found[i] - expected[i]).abs()));
        assert!(error <= 1e-9 * scale, "{found:?} instead of {expected:?}");
    }
    println!("{findings:?}, {:?}", own.parts().isochoric.size());
}

fn scene(law: &str, elements: &str) -> String {
    format!(
        // a step that follows the highest frequency differs by how exactly that is found
        r#"(duration: 0.02, integration: (when_unstable: Watch), materials: {{"tissue": (density: 1000, {law}, damping: 2, prony: (terms: [(alpha: 0.3, tau: 0.1)]),
fibres: (eta: 500, direction: Along(1, 1, 0)))}},
bodies: {{"bar": (mesh: Box(size: (0.04, 0.02, 0.02), cells: (4, 2, 2), elements: {elements}), material: "tissue")}},
constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
loads: [Gravity(acceleration: (0, 0, -200))])"#
    )
}

/// A law's text with names that kernels have: of a struct, of functions of elements, of what is generated.
#[test]
fn a_law_may_call_things_as_kernels_call_theirs() {
    let text = include_str!("../../shaders/neo_hookean.wgsl");
    let whole = "return elastic.bulk * theta;";
    assert!(text.contains(whole) && text.contains("NeoHookean"));
    let text = text.replace("NeoHookean", "Block").replace(whole, "return place(elastic.bulk) * theta;")
        + "\nconst NODES: f32 = 1.0;\nfn place(x: f32) -> f32 { return isochoric_stress(x); }\n\
           fn isochoric_stress(block: f32) -> f32 { return NODES * block; }\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("own.wgsl"), text).unwrap();
    let built_in = "neo_hookean: Moduli(shear: 1034.4828, bulk: 1e4)";
    let own = r#"law: (file: "own.wgsl", parameters: {"shear": 1034.4828, "bulk": 1e4})"#;
    for elements in ["Tet4", "Hex8MeanDilatation"] {
        for configuration in cpu_and_long_gpu() {
            let [expected, found] = [built_in, own].map(|law| {
                let mut run = configuration.start_in(&scene(law, elements), folder.path());
                run.advance_to(0.02).unwrap();
                run.displacements("bar").unwrap()
            });
            let largest = expected.iter().fold(0.0, |largest: f64, u| largest.max(u.length()));
            let error = found.iter().zip(&expected).fold(0.0, |worst: f64, (a, b)| worst.max((*a - *b).length()));
            assert!(largest > 1e-3, "the bar falls by {largest} m only");
            let bound = if configuration.name.starts_with("GPU") { 0.0 } else { configuration.bound(1e-10, 2e-5) };
            near(&format!("{elements} on {}", configuration.name), error / largest, 0.0, 1.0, bound);
        }
    }
}

/// On every backend and element a whole run under our own WGSL as a user's law goes as under the Rust law; on the GPU,
/// where the text is the same, to the bit.
#[test]
fn a_run_under_a_law_of_ones_own_goes_as_under_the_same_law_built_in() {
    let built_in = "neo_hookean: Moduli(shear: 1034.4828, bulk: 1e4)";
    let own = r#"law: (file: "neo_hookean.wgsl", parameters: {"shear": 1034.4828, "bulk": 1e4})"#;
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders"));
    for elements in ELEMENTS {
        for configuration in cpu_and_long_gpu() {
            let mut runs = [built_in, own].map(|law| {
                let mut run = configuration.start_in(&scene(law, elements), folder);
                run.advance_to(0.02).unwrap();
                (run.displacements("bar").unwrap(), run.energies().unwrap())
            });
            let ((found, energies), (expected, built_in)) =
                (std::mem::take(&mut runs[1]), std::mem::take(&mut runs[0]));
            let largest = expected.iter().fold(0.0, |largest: f64, u| largest.max(u.length()));
            let error = found.iter().zip(&expected).fold(0.0, |worst: f64, (a, b)| worst.max((*a - *b).length()));
            assert!(largest > 1e-3, "the bar falls by {largest} m only");
            // more nodes, more terms
            let of_singles = if elements == "Tet10" { 5e-5 } else { 2e-5 };
            let bound =
                if configuration.name.starts_with("GPU") { 0.0 } else { configuration.bound(1e-10, of_singles) };
            near(&format!("{elements} on {}", configuration.name), error / largest, 0.0, 1.0, bound);
            near("elastic energy", energies.strain, built_in.strain, built_in.strain, configuration.bound(1e-10, 1e-4));
        }
    }
}
