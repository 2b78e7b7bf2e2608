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
    let registry = Registry::default().with_law::<OwnNeoHookean<f64>>("neo").with_law::<OwnMooneyRivlin<f64>>("mooney");
    let options = Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() };
    Simulation::with_systems(&scene, &options, &registry).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// By name: as it is built in, in Rust from outside, and from its energy.
const LAWS: [(&str, [&str; 3]); 2] = [
    (
        "neo-Hookean",
        [
            "neo_hookean: Moduli(shear: 1034.5, bulk: 10000)",
            "law: (rust: \"neo\", parameters: {\"shear\": 1034.5, \"bulk\": 10000})",
            "law: (energy: \"mu/2*I1bar_minus_3 + k/2*J_minus_1^2 + 1e-9*k*J_minus_1^4\", parameters: {\"mu\": 1034.5, \"k\": 10000})",
        ],
    ),
    (
        "Mooney-Rivlin",
        [
            "mooney_rivlin: (c10: 300, c01: 217, bulk: 10000)",
            "law: (rust: \"mooney\", parameters: {\"c10\": 300, \"c01\": 217, \"bulk\": 10000})",
            "law: (energy: \"a*I1bar_minus_3 + b*I2bar_minus_3 + k/2*J_minus_1^2 + 1e-9*k*J_minus_1^4\", parameters: {\"a\": 300, \"b\": 217, \"k\": 10000})",
        ],
    ),
];

const BLOCK: u64 = 20;

fn main() {
    for (kind, cells, count) in [("Tet4", 16, 6), ("Hex8", 24, 1), ("Hex8MeanDilatation", 16, 1)] {
        for (word, precision) in [("f32", Precision::F32), ("f64", Precision::F64)] {
            for (name, laws) in LAWS {
                let mut all = laws.map(|law| simulation(kind, cells, law, precision));
                let mut best = [f64::INFINITY; 3];
                for _ in 0..60 {
                    for (simulation, best) in all.iter_mut().zip(&mut best) {
                        let started = Instant::now();
                        simulation.advance(BLOCK).expect("steps");
                        *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
                    }
                }
                let [built_in, rust, energy] = best.map(|time| time * 1e9 / f64::from(cells.pow(3) * count));
                println!(
                    "{kind} {word}, {name}: {built_in:.1} ns an element and step built in, {rust:.1} in Rust from \
                     outside ({:.2} times), {energy:.1} from its energy ({:.2} times)",
                    rust / built_in,
                    energy / built_in
                );
            }
        }
    }
}
