//! Laws in Rust from outside: the same as the same law from its energy, on both backends; and what is refused.

use super::gent::Gent;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::Precision;
use sinew::materials::{Elastic, Kinematics, RustLaw};
use sinew::math::{Mat3, Real, Sym3};
use sinew::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

const IN_RUST: &str = r#"rust: "gent", parameters: {"shear": 2000, "bulk": 4e4, "limit": 0.5}"#;
const ENERGY: &str = r#"energy: "-mu * Jm / 2 * log(1 - I1bar_minus_3 / Jm) + kappa / 2 * J_minus_1 * J_minus_1",
    parameters: {"mu": 2000, "kappa": 4e4, "Jm": 0.5}"#;

/// Bars of all elements, pulled by a third, with whatever else a material has.
fn scene(law: &str, more: &str) -> SceneFile {
    let kinds = ["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation", "Wedge6", "Tet10"];
    let bodies = kinds.map(|kind| {
        format!(r#""{kind}": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (4, 1, 1), elements: {kind}), material: "m")"#)
    });
    let text = format!(
        r#"(duration: 0.02, bodies: {{{}}}, materials: {{"m": (density: 1000, law: ({law}), damping: 50{more})}},
        constraints: [
            Fixed(on: Plane(normal: (1, 0, 0), at: 0)),
            Prescribed(on: Plane(normal: (1, 0, 0), at: 0.04), displacement: (0.013, 0.002, 0), curve: Smooth(over: 0.02)),
        ])"#,
        bodies.join(", ")
    );
    SceneFile::from_text("gent.ron", &text, Path::new("."), &[]).unwrap_or_else(|e| panic!("{}", e.render(false)))
}

fn moved(scene: &SceneFile, backend: BackendChoice, precision: Precision) -> Vec<DVec3> {
    let registry = Registry::default().with_law::<Gent<f64>>("gent");
    let options = Options { backend, precision, ..Options::default() };
    let mut simulation = Simulation::with_systems(scene, &options, &registry).unwrap();
    simulation.finish().unwrap();
    let bodies: Vec<String> = scene.scene.bodies.keys().cloned().collect();
    bodies.iter().flat_map(|body| simulation.displacements(body).unwrap()).collect()
}

/// The largest difference over the largest displacement.
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().map(|u| u.length()).fold(0.0, f64::max);
    let difference =
        |(a, b): (&DVec3, &DVec3)| if a.is_finite() && b.is_finite() { (*a - *b).length() } else { f64::NAN };
    let worst = a.iter().zip(b).map(difference).fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x) });
    assert!(largest > 0.01 && worst.is_finite());
    worst / largest
}

#[test]
fn a_law_in_rust_is_that_of_its_energy_on_both_backends() {
    let viscous = ", prony: (terms: [(alpha: 0.3, tau: 0.01)]), fibres: (eta: 3e3, direction: Uniform((1, 0, 0)))";
    for more in ["", viscous] {
        let (in_rust, by_energy) = (scene(IN_RUST, more), scene(ENERGY, more));
        let reference = moved(&by_energy, BackendChoice::Cpu, Precision::F64);
        let double = moved(&in_rust, BackendChoice::Cpu, Precision::F64);
        let single = moved(&in_rust, BackendChoice::Cpu, Precision::F32);
        let energy_single = moved(&by_energy, BackendChoice::Cpu, Precision::F32);
        let found = [apart(&reference, &double), apart(&reference, &single), apart(&reference, &energy_single)];
        println!("{found:?}");
        // thousands of steps of other roundings
        assert!(found[0] < 1e-11 && found[1] < 1e-4 && found[2] < 1e-4, "{found:?}");
        if gpu_or_reason().is_some() {
            let device = moved(&in_rust, BackendChoice::Gpu, Precision::F32);
            assert!(apart(&reference, &device) < 1e-4, "{}", apart(&reference, &device));
        }
    }
}

#[test]
fn it_runs_in_kernels_of_its_own() {
    let registry = Registry::default().with_law::<Gent<f64>>("gent");
    let mut simulation = Simulation::with_systems(&scene(IN_RUST, ""), &Options::default(), &registry).unwrap();
    let told = format!("{}", simulation.explain(&registry).unwrap());
    assert!(told.contains("compiled for it"), "{told}");
}

/// What is said of a scene with laws that a program has.
fn complaint(law: &str, registry: &Registry) -> String {
    Simulation::check(&scene(law, ""), registry).render(false)
}

#[test]
fn wrong_parameters_are_told_at_their_place() {
    let registry = Registry::default().with_law::<Gent<f64>>("gent");
    for (law, expected) in [
        (r#"rust: "gent", parameters: {"shear": 1, "bulk": 2}"#, "missing field `limit`"),
        (r#"rust: "gent", parameters: {"shear": 1, "bulk": 2, "limt": 1}"#, "unknown field `limt`, expected one of"),
        (r#"rust: "gent", parameters: {"shear": 1, "bulk": 2, "limit": -1}"#, "`limit` must be above 0, found -1"),
        (r#"rust: "gent", parameters: {"shear": -1, "bulk": 2, "limit": 1}"#, "modulus at small strains is"),
        (r#"rust: "gnt", parameters: {}"#, "this program has no law `gnt`"),
        (r#"rust: "gent", file: "law.wgsl""#, "the law has both `file` and `rust`"),
    ] {
        let told = complaint(law, &registry);
        assert!(told.contains(expected) && told.contains("gent.ron:1:"), "{law}:\n{told}");
    }
    let told = complaint(IN_RUST, &Registry::default());
    assert!(told.contains("this program has no law `gent`") && told.contains("Registry"), "{told}");
}

macro_rules! odd_law {
    ($name:ident: $($item:tt)*) => {
        /// Neo-Hookean but for one thing.
        #[derive(Clone, Copy)]
        struct $name<R>(R);

        impl RustLaw for $name<f64> {
            type Parameters = BTreeMap<String, f64>;

            fn of(_: Self::Parameters) -> Result<Self, String> {
                Ok(Self(1e3))
            }
        }

        impl<R: Real> Elastic<R> for $name<R> {
            type Of<Q: Real> = $name<Q>;

            fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> $name<Q> {
                $name(number(self.0))
            }
            fn pressure(&self, theta: R) -> R {
                self.0 * theta
            }
            fn volumetric_energy(&self, theta: R) -> R {
                self.0 * self.0.constant(0.5) * theta * theta
            }
            fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
                self.0 * self.0.constant(0.5) * k.i1_change()
            }
            $($item)*
        }
    };
}

/// S_iso of the neo-Hookean law.
fn isochoric<R: Real>(shear: R, k: &Kinematics<R>) -> Sym3<R> {
    k.inverse_c_times(&k.green_strain.deviator().scaled(shear * k.j_m23 * shear.constant(2.0)))
}

odd_law!(Bits:
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        isochoric(self.0.power_of_two(), k)
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        [self.0; 2]
    }
);
odd_law!(Measures:
    fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
        Kinematics::linear(gradient)
    }
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        isochoric(self.0, k)
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        [self.0; 2]
    }
);
odd_law!(ShortWay:
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        isochoric(self.0, k)
    }
    fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        gradient.plus_identity_times(&isochoric.plus(&self.volumetric(k, pressure + pressure)))
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        [self.0; 2]
    }
);
odd_law!(Moduli:
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        isochoric(self.0, k)
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        [self.0 + self.0, self.0]
    }
);
odd_law!(Twice:
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        isochoric(self.0 + self.0, k)
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        [self.0 + self.0, self.0]
    }
);

#[test]
fn a_law_that_is_none_is_refused() {
    let registry = Registry::default()
        .with_law::<Bits<f64>>("bits")
        .with_law::<Measures<f64>>("measures")
        .with_law::<ShortWay<f64>>("short_way")
        .with_law::<Moduli<f64>>("moduli")
        .with_law::<Twice<f64>>("twice");
    for (name, expected) in [
        ("bits", "cannot be recorded: it asks a number for its `power_of_two`"),
        ("measures", "cannot be recorded: it has a `kinematics` of its own"),
        ("short_way", "has a shorter way to its stress that leads elsewhere"),
        ("moduli", "`small_strain_moduli` of the law `moduli` are 2.000000e3 and 1.000000e3 Pa"),
        ("twice", "`isochoric` is not the derivative of `isochoric_energy`"),
    ] {
        let told = complaint(&format!(r#"rust: "{name}""#), &registry);
        assert!(told.contains(expected) && told.contains("gent.ron:1:"), "{name}:\n{told}");
    }
}
