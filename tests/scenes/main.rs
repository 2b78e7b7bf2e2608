//! The scenes that ship: sound, the same on every backend, and physically right.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod accuracy;
mod bar;
mod cataract;
mod column;
mod cube;
mod golden;
mod grasp;
mod groove;
mod lens;
mod lobe;
mod parameters;
mod passes;
mod resume;
mod shipped;
mod surfaces;
mod tools;

use sinew::components::Precision;
use sinew::{BackendChoice, Options, SceneFile, Simulation};

/// A shipped scene with values put in.
fn scene(name: &str, sets: &[&str]) -> SceneFile {
    let path = format!("{}/scenes/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    SceneFile::load(path, &sets).unwrap_or_else(|wrong| panic!("{}", wrong.render(false)))
}

fn reference() -> Options {
    Options { backend: BackendChoice::Cpu, precision: Precision::F64, ..Options::default() }
}

/// The scene's simulation in f64, at its end.
fn run(name: &str, sets: &[&str]) -> Simulation {
    let mut simulation = Simulation::new(&scene(name, sets), &reference()).unwrap();
    simulation.finish().unwrap();
    simulation
}

/// Whether two numbers agree but for a share of the second.
fn near(found: f64, expected: f64, share: f64) -> bool {
    (found - expected).abs() <= share * expected.abs()
}
