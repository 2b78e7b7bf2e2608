//! Laws in Rust from outside: the same as the same law from its energy, on both backends; and what is refused.

use super::gent::Gent;
use sinew::components::Precision;
use sinew::gpu_or_reason;
use sinew::materials::{Elastic, Kinematics, RustLaw};
use sinew::math::{Mat3, Real, Sym3};
use sinew::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

const IN_RUST: &str = r#"rust: "gent", parameters: {"shear": 2000, "bulk": 4e4, "limit": 0.5}"#;
const ENERGY: &str = r#"energy: "-mu * Jm / 2 * log(1 - I1bar_minus_3 / Jm) + kappa / 2 * J_minus_1 * J_minus_1",
    parameters: {"mu": 2000, "kappa": 4e4, "Jm": 0.5}"#;

/// Of all elements: as a bar that is pulled by a quarter.
const ELEMENTS: [&str; 6] = ["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation", "Wedge6", "Tet10"];

fn scene(elements: &str, law: &str, more: &str) -> SceneFile {
    let text = format!(
        // a step that follows the highest frequency differs by how exactly that is found
        r#"(duration: 0.02, integration: (step: 5e-5, when_unstable: Watch), bodies: {{"bar": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (4, 1, 1), elements: {elements}), material: "m")}},
        materials: {{"m": (density: 1000, law: ({law}), damping: 50{more})}},
        constraints: [
            Fixed(on: Plane(normal: (1, 0, 0), at: 0)),
            Prescribed(on: Plane(normal: (1, 0, 0), at: 0.04), displacement: (0.01, 0.002, 0), curve: Smooth(end: 0.02)),
        ])"#
    );
    SceneFile::from_text("gent.ron", &text, Path::new("."), &[]).unwrap_or_else(|e| panic!("{}", e.render(false)))
}

fn moved(scene: &SceneFile, backend: BackendChoice, precision: Precision) -> Vec<DVec3> {
    let registry = Registry::default().with_law::<Gent<f64>>("gent");
    let options = Options { backend, precision, ..Options::default() };
    let mut simulation = Simulation::with_systems(scene, &options, &registry).unwrap();
    simulation.finish().unwrap();
    simulation.displacements("bar").unwrap()
}

/// The largest difference over the largest displacement.
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().map(|u| u.length()).fold(0.0, f64::max);
    let difference =
        |(a, b): (&DVec3, &DVec3)| if a.is_finite() && b.is_finite() { (*a - *b).length() } else { f64::NAN };
    let worst = a.iter().zip(b).map(difference).fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x) });
    assert!(largest > 0.009 && worst.is_finite());
    worst / largest
}

#[test]
fn a_law_in_rust_is_that_of_its_energy_on_both_backends() {
    let viscous = ", prony: (terms: [(alpha: 0.3, tau: 0.01)]), fibres: (eta: 3e3, direction: Along(1, 0, 0))";
    for (elements, more) in ELEMENTS.into_iter().flat_map(|elements| ["", viscous].map(|more| (elements, more))) {
        let (in_rust, by_energy) = (scene(elements, IN_RUST, more), scene(elements, ENERGY, more));
        let reference = moved(&by_energy, BackendChoice::Cpu, Precision::F64);
        let mut found = vec![
            apart(&reference, &moved(&in_rust, BackendChoice::Cpu, Precision::F64)),
            apart(&reference, &moved(&in_rust, BackendChoice::Cpu, Precision::F32)),
        ];
        if gpu_or_reason().is_some() {
            found.push(apart(&reference, &moved(&in_rust, BackendChoice::Gpu, Precision::F32)));
        }
        println!("{elements}: {found:?}");
        // hundreds of steps of other roundings
        assert!(found[0] < 1e-11 && found[1..].iter().all(|apart| *apart < 1e-4), "{elements}: {found:?}");
    }
}

#[test]
fn it_runs_in_kernels_of_its_own() {
    let registry = Registry::default().with_law::<Gent<f64>>("gent");
    let mut simulation = Simulation::with_systems(&scene("Tet4", IN_RUST, ""), &Options::default(), &registry).unwrap();
    let told = format!("{}", simulation.explain(&registry).unwrap());
    assert!(told.contains("compiled for it"), "{told}");
}

/// What is said of a scene with laws that a program has.
fn complaint(law: &str, registry: &Registry) -> String {
    Simulation::check(&scene("Tet4", law, ""), registry).render(false)
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
        assert!(told.contains(expected) && told.contains("gent.ron:2:"), "{law}:\n{told}");
    }
    let told = complaint(IN_RUST, &Registry::default());
    assert!(told.contains("this program has no law `gent`") && told.contains("registry"), "{told}");
}

/// The neo-Hookean law but for one thing, by a word.
#[derive(Clone, Copy)]
struct Odd<R> {
    modulus: R,
    but_for: But,
}

#[derive(Clone, Copy, PartialEq)]
enum But {
    Bits,
    Measures,
    ShortWay,
    Moduli,
    Energy,
}

/// Each by the number that a scene gives.
const ODD: [But; 5] = [But::Bits, But::Measures, But::ShortWay, But::Moduli, But::Energy];

impl RustLaw for Odd<f64> {
    type Parameters = BTreeMap<String, f64>;

    fn of(parameters: Self::Parameters) -> Result<Self, String> {
        Ok(Self { modulus: 1e3, but_for: ODD[parameters["but_for"] as usize] })
    }
}

impl<R: Real> Elastic<R> for Odd<R> {
    type Of<Q: Real> = Odd<Q>;

    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Odd<Q> {
        Odd { modulus: number(self.modulus), but_for: self.but_for }
    }
    fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
        if self.but_for == But::Measures { Kinematics::linear(gradient) } else { Kinematics::new(gradient) }
    }
    fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        let pressure = if self.but_for == But::ShortWay { pressure + pressure } else { pressure };
        gradient.plus_identity_times(&isochoric.plus(&self.volumetric(k, pressure)))
    }
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        let shear = match self.but_for {
            But::Bits => self.modulus.power_of_two(),
            But::Energy => self.modulus + self.modulus,
            _ => self.modulus,
        };
        k.inverse_c_times(&k.green_strain.deviator().scaled(shear * k.j_m23 * shear.constant(2.0)))
    }
    fn pressure(&self, theta: R) -> R {
        self.modulus * theta
    }
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.modulus * self.modulus.constant(0.5) * k.i1_change()
    }
    fn volumetric_energy(&self, theta: R) -> R {
        self.modulus * self.modulus.constant(0.5) * theta * theta
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        let shear = if self.but_for == But::Moduli { self.modulus + self.modulus } else { self.modulus };
        [shear, self.modulus]
    }
}

#[test]
fn a_law_that_is_none_is_refused() {
    let registry = Registry::default().with_law::<Odd<f64>>("odd");
    for (number, expected) in [
        "cannot be recorded: it asks a number for its `power_of_two`",
        "cannot be recorded: it has a `kinematics` of its own",
        "has a shorter way to its stress that leads elsewhere",
        "`small_strain_moduli` of the law `odd` are 2.000000e3 and 1.000000e3 Pa",
        "`isochoric` is not the derivative of `isochoric_energy`",
    ]
    .into_iter()
    .enumerate()
    {
        let told = complaint(&format!(r#"rust: "odd", parameters: {{"but_for": {number}}}"#), &registry);
        assert!(told.contains(expected) && told.contains("gent.ron:2:"), "{number}:\n{told}");
    }
}
