//! Laws of one's own in WGSL: what the translation makes of our own WGSL twins is the Rust law, on every backend.

use crate::configurations::{configurations, near};
use crate::random::Random;
use sinew::backend::user_law::{Findings, read};
use sinew::glam::DMat3;
use sinew::materials::{Elastic, Kinematics, NeoHookean, UserLaw};
use sinew::math::Mat3;
use std::collections::BTreeMap;
use std::path::Path;

const NEO_HOOKEAN: &str = include_str!("../../shaders/neo_hookean.wgsl");

fn law(text: &str, parameters: &[(&str, f64)]) -> (UserLaw<f64>, Findings) {
    let parameters: BTreeMap<String, f64> = parameters.iter().map(|(name, x)| (name.to_string(), *x)).collect();
    let read = read("law.wgsl", text, &parameters).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    assert_eq!(read.warnings, []);
    (read.law, read.findings)
}

fn kinematics(f: DMat3) -> Kinematics<f64> {
    let h = f - DMat3::IDENTITY;
    Kinematics::new(&Mat3(std::array::from_fn(|i| std::array::from_fn(|j| h.col(j)[i]))))
}

#[test]
fn our_own_wgsl_read_as_a_users_law_is_the_rust_law() {
    let (own, findings) = law(NEO_HOOKEAN, &[("shear", 1034.4828), ("bulk", 1e4)]);
    let rust = NeoHookean { shear: 1034.4828, bulk: 1e4 };
    let mut random = Random(7);
    for _ in 0..300 {
        let k = kinematics(random.deformation());
        let (found, expected) = (own.isochoric(&k).0, rust.isochoric(&k).0);
        let scale = expected.iter().fold(0.0, |scale: f64, x| scale.max(x.abs()));
        for i in 0..6 {
            assert!((found[i] - expected[i]).abs() <= 1e-12 * scale, "{found:?} instead of {expected:?}");
        }
        let pairs = [
            (own.pressure(k.volume_change), rust.pressure(k.volume_change)),
            (own.isochoric_energy(&k), rust.isochoric_energy(&k)),
            (own.volumetric_energy(k.volume_change), rust.volumetric_energy(k.volume_change)),
        ];
        for (found, expected) in pairs {
            assert!((found - expected).abs() <= 1e-12 * (1e3 + expected.abs()), "{found} instead of {expected}");
        }
    }
    let [shear, bulk] = own.small_strain_moduli();
    near("shear modulus", shear, 1034.4828, 1034.4828, 1e-8);
    near("bulk modulus", bulk, 1e4, 1e4, 1e-8);
    assert!(findings.derivative_error < 1e-6 && findings.single_precision_error < 1e-4, "{findings:?}");
    assert_eq!(findings.finite_up_to, None);
}

fn scene(law: &str, elements: &str) -> String {
    format!(
        r#"(duration: 0.02, materials: {{"tissue": (density: 1000, {law}, damping: 2, prony: (terms: [(alpha: 0.3, tau: 0.1)]),
fibres: (eta: 500, direction: Along(1, 1, 0)))}},
bodies: {{"bar": (mesh: Box(size: (0.04, 0.02, 0.02), cells: (4, 2, 2), elements: {elements}), material: "tissue")}},
constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
loads: [Gravity(acceleration: (0, 0, -200))])"#
    )
}

/// On every backend and element a whole run under our own WGSL as a user's law goes as under the Rust law; on the GPU, where
/// the text is the same, to the bit.
#[test]
fn a_run_under_a_law_of_ones_own_goes_as_under_the_same_law_built_in() {
    let built_in = "neo_hookean: Moduli(shear: 1034.4828, bulk: 1e4)";
    let own = r#"law: (file: "neo_hookean.wgsl", parameters: {"shear": 1034.4828, "bulk": 1e4})"#;
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders"));
    for elements in ["Tet4", "Hex8", "Tet4NodalPressure", "Hex8MeanDilatation"] {
        for configuration in configurations() {
            let mut runs = [built_in, own].map(|law| {
                let mut run = configuration.start_in(&scene(law, elements), folder);
                run.advance_to(0.02).unwrap();
                (run.displacements("bar").unwrap(), run.energies().unwrap())
            });
            let ((found, energies), (expected, built_in)) = (std::mem::take(&mut runs[1]), std::mem::take(&mut runs[0]));
            let largest = expected.iter().fold(0.0, |largest: f64, u| largest.max(u.length()));
            let error = found.iter().zip(&expected).fold(0.0, |worst: f64, (a, b)| worst.max((*a - *b).length()));
            assert!(largest > 1e-3, "the bar falls by {largest} m only");
            let bound = if configuration.name.starts_with("GPU") { 0.0 } else { configuration.bound(1e-10, 2e-5) };
            near(&format!("{elements} on {}", configuration.name), error / largest, 0.0, 1.0, bound);
            near("elastic energy", energies.strain, built_in.strain, built_in.strain, configuration.bound(1e-10, 1e-4));
        }
    }
}
