//! Where every physics test runs: CPU f64, CPU f32, and GPU f32 where there is one.

use sinew::backend::gpu::gpu_or_reason;
use sinew::components::Precision;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;

/// All kinds of elements, as scenes name them.
pub const ELEMENTS: [&str; 6] = ["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation", "Wedge6", "Tet10"];

/// A backend with a number type.
pub struct Configuration {
    pub name: &'static str,
    pub options: Options,
}

/// All that this machine has. `SINEW_REQUIRE_GPU` makes a missing GPU a failure.
pub fn configurations() -> Vec<Configuration> {
    let of = |name, backend, precision| Configuration {
        name,
        options: Options { backend, precision, threads: 1, ..Options::default() },
    };
    let mut all =
        vec![of("CPU f64", BackendChoice::Cpu, Precision::F64), of("CPU f32", BackendChoice::Cpu, Precision::F32)];
    if GPU_KERNELS && gpu_or_reason().is_some() {
        all.push(of("GPU f32", BackendChoice::Gpu, Precision::F32));
    }
    all
}

/// The same, where a software GPU takes long: on a GPU only when long tests are asked for (`--include-ignored`).
pub fn cpu_and_long_gpu() -> Vec<Configuration> {
    let mut all = configurations();
    if !std::env::args().any(|argument| argument == "--include-ignored" || argument == "--ignored") {
        all.retain(|run| run.options.backend == BackendChoice::Cpu);
        println!("left out: the same on a GPU, which takes long; `cargo test -- --include-ignored` has it");
    }
    all
}

/// Whether built-in systems have kernels.
const GPU_KERNELS: bool = true;

impl Configuration {
    /// The bound for this number type.
    pub fn bound(&self, f64: f64, f32: f64) -> f64 {
        if self.options.precision == Precision::F64 { f64 } else { f32 }
    }

    /// A simulation of a scene.
    pub fn start(&self, scene: &str) -> Simulation {
        self.start_in(scene, Path::new("."))
    }

    /// A simulation of a scene whose meshes are in a folder.
    pub fn start_in(&self, scene: &str, folder: &Path) -> Simulation {
        let file = scene_of(scene, folder);
        Simulation::new(&file, &self.options).unwrap_or_else(|error| panic!("{}: {error}\n{scene}", self.name))
    }
}

/// A scene from its text.
pub fn scene_of(scene: &str, folder: &Path) -> SceneFile {
    SceneFile::from_text("test", scene, folder, &[]).unwrap_or_else(|wrong| panic!("{}\n{scene}", wrong.render(false)))
}

/// Asserts that a figure is within a bound of what is expected, relative to a scale.
#[track_caller]
pub fn near(what: &str, found: f64, expected: f64, scale: f64, bound: f64) {
    let error = (found - expected).abs() / scale.abs();
    println!("{what}: {found:.9e}, expected {expected:.9e}: error {error:.2e} of {bound:.0e}");
    assert!(error <= bound, "{what}: {found} instead of {expected}: error {error:.3e}, allowed {bound:.1e}");
}
