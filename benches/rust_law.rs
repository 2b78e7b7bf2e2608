//! What a law in Rust from outside costs beside the same law built in: `cargo bench --bench rust_law`. Blocks of steps
//! under the two by turns, the best of each.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::components::Precision;
use sinew::materials::{Elastic, Kinematics, MooneyRivlin, NeoHookean, RustLaw};
use sinew::math::{Real, Sym3};
use sinew::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

macro_rules! copy_of {
    ($name:ident: $law:ident { $($parameter:ident),* }) => {
        /// The law as somebody else would write it: what it must say, and no shorter way.
        #[derive(Clone, Copy)]
        struct $name<R: Real>($law<R>);

        impl RustLaw for $name<f64> {
            type Parameters = BTreeMap<String, f64>;

            fn of(parameters: Self::Parameters) -> Result<Self, String> {
                Ok(Self($law { $($parameter: parameters[stringify!($parameter)]),* }))
            }
        }

        impl<R: Real> Elastic<R> for $name<R> {
            type Of<Q: Real> = $name<Q>;

            #[inline(always)]
            fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> $name<Q> {
                $name(self.0.map(number))
            }
            #[inline(always)]
            fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
                self.0.isochoric(k)
            }
            #[inline(always)]
            fn pressure(&self, theta: R) -> R {
                self.0.pressure(theta)
            }
            #[inline(always)]
            fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
                self.0.isochoric_energy(k)
            }
            #[inline(always)]
            fn volumetric_energy(&self, theta: R) -> R {
                self.0.volumetric_energy(theta)
            }
            fn small_strain_moduli(&self) -> [R; 2] {
                self.0.small_strain_moduli()
            }
        }
    };
}
copy_of!(OwnNeoHookean: NeoHookean { shear, bulk });
copy_of!(OwnMooneyRivlin: MooneyRivlin { c10, c01, bulk });

/// Ψ = μ/(2b) (e^(b(Ī₁ − 3)) − 1) + κ/2 (J − 1)² (Demiray 1972), as it is written by hand: no polynomial, and not built
/// in.
#[derive(Clone, Copy)]
struct Demiray<R> {
    mu: R,
    b: R,
    bulk: R,
}

impl RustLaw for Demiray<f64> {
    type Parameters = BTreeMap<String, f64>;

    fn of(parameters: Self::Parameters) -> Result<Self, String> {
        Ok(Self { mu: parameters["mu"], b: parameters["b"], bulk: parameters["bulk"] })
    }
}

impl<R: Real> Elastic<R> for Demiray<R> {
    type Of<Q: Real> = Demiray<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Demiray<Q> {
        Demiray { mu: number(self.mu), b: number(self.b), bulk: number(self.bulk) }
    }
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        k.stress_of_slope(self.mu.constant(0.5) * self.mu * (self.b * k.i1_change()).exp())
    }
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.mu.constant(0.5) * self.mu / self.b * (self.b * k.i1_change()).exp_m1()
    }
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }
    fn small_strain_moduli(&self) -> [R; 2] {
        [self.mu, self.bulk]
    }
}

fn simulation(elements: &str, cells: u32, material: &str, precision: Precision) -> Simulation {
    let text = format!(
        "(duration: 1000.0,
          bodies: {{ \"cube\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: {elements}),
                               material: \"tissue\") }},
          materials: {{ \"tissue\": (density: 1000, {material}) }},
          constraints: [Fixed(on: Set(\"z0\"))],
          loads: [Gravity(acceleration: (0, 0, -2))])"
    );
    let scene = SceneFile::from_text("cube", &text, Path::new("."), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let registry = Registry::default()
        .with_law::<OwnNeoHookean<f64>>("neo")
        .with_law::<OwnMooneyRivlin<f64>>("mooney")
        .with_law::<Demiray<f64>>("demiray");
    let options = Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() };
    Simulation::with_systems(&scene, &options, &registry).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// By name: as it is built in, if it is, in Rust from outside, and from its energy.
const LAWS: [(&str, [Option<&str>; 3]); 3] = [
    (
        "neo-Hookean",
        [
            Some("neo_hookean: Moduli(shear: 1034.5, bulk: 10000)"),
            Some("law: (rust: \"neo\", parameters: {\"shear\": 1034.5, \"bulk\": 10000})"),
            Some(
                "law: (energy: \"mu/2*I1bar_minus_3 + k/2*J_minus_1^2 + 1e-9*k*J_minus_1^4\", parameters: {\"mu\": 1034.5, \"k\": 10000})",
            ),
        ],
    ),
    (
        "Mooney-Rivlin",
        [
            Some("mooney_rivlin: (c10: 300, c01: 217, bulk: 10000)"),
            Some("law: (rust: \"mooney\", parameters: {\"c10\": 300, \"c01\": 217, \"bulk\": 10000})"),
            Some(
                "law: (energy: \"a*I1bar_minus_3 + b*I2bar_minus_3 + k/2*J_minus_1^2 + 1e-9*k*J_minus_1^4\", parameters: {\"a\": 300, \"b\": 217, \"k\": 10000})",
            ),
        ],
    ),
    (
        "Demiray",
        [
            None,
            Some("law: (rust: \"demiray\", parameters: {\"mu\": 1034.5, \"b\": 1, \"bulk\": 10000})"),
            Some(
                "law: (energy: \"mu/(2*b)*(exp(b*I1bar_minus_3) - 1) + k/2*J_minus_1^2\", parameters: {\"mu\": 1034.5, \"b\": 1, \"k\": 10000})",
            ),
        ],
    ),
];

const BLOCK: u64 = 20;

fn main() {
    for (kind, cells, count) in [("Tet4", 16, 6), ("Hex8", 24, 1), ("Hex8MeanDilatation", 16, 1)] {
        for (word, precision) in [("f32", Precision::F32), ("f64", Precision::F64)] {
            for (name, laws) in LAWS {
                let mut all = laws.map(|law| law.map(|law| simulation(kind, cells, law, precision)));
                let mut best = [f64::INFINITY; 3];
                for _ in 0..60 {
                    for (simulation, best) in all.iter_mut().zip(&mut best) {
                        let Some(simulation) = simulation else { continue };
                        let started = Instant::now();
                        simulation.advance(BLOCK).expect("steps");
                        *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
                    }
                }
                let [built_in, rust, energy] = best.map(|time| time * 1e9 / f64::from(cells.pow(3) * count));
                let times = rust / built_in;
                match built_in.is_finite() {
                    true => print!(
                        "{kind} {word}, {name}: {built_in:.1} ns an element and step built in, in Rust {times:.2} times as much, "
                    ),
                    false => print!("{kind} {word}, {name}: "),
                }
                println!("{rust:.1} in Rust from outside, {energy:.1} from its energy: {:.2} times", energy / rust);
            }
        }
    }
}
