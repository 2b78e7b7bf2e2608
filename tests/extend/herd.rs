//! A node system that looks at other nodes than its own: each node follows its neighbour by row. On a GPU it must not
//! share a kernel with what moves them, and says so.

use sinew::components::{Column, Precision};
use sinew::gpu_or_reason;
use sinew::prelude::*;
use sinew::systems::{Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, SimdScalar};
use std::path::Path;

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Herd {
    /// Force over mass and distance (1/s²).
    stiffness: f64,
}

fn system() -> System {
    System::of_nodes::<Herd>("herd", Phase::Loads, "draws each node after the next")
        .on_each_body::<Herd>()
        .with_shader::<Herd>("tests/extend/herd.wgsl", include_str!("herd.wgsl"))
}

impl NodeSystem for Herd {
    type Columns = (&'static Displacement, &'static Mass, &'static mut ExternalForce);
    /// Displacements of all nodes (m).
    type Prepared = Vec<DVec3>;
    const READS_ELSEWHERE: &'static [&'static str] = &[Displacement::NAME];

    fn prepare(&self, before: &Before<'_>) -> Self::Prepared {
        before.displacement.vectors().collect()
    }

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: 2.0 * self.stiffness, damping: 0.0 }
    }

    fn act<T: SimdScalar>(&self, all: &Self::Prepared, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            let node = nodes.first + row;
            let apart = all[(node + 1) % all.len()] - all[node];
            nodes.add_load(row, self.stiffness * nodes.mass()[row].to_f64() * apart);
        }
    }
}

const SCENE: &str = r#"(
    duration: 1,
    bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (6, 6, 6)), material: "tissue", spin: (0, 0, 3))},
    materials: {"tissue": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))},
    constraints: [Fixed(on: Set("z0"))],
    parameters: {"herd": (stiffness: 2e3)},
)"#;

fn begun(backend: BackendChoice) -> Simulation {
    let scene = SceneFile::from_text("herd.ron", SCENE, Path::new("."), &[]).unwrap();
    let options = Options { backend, precision: Precision::F32, ..Options::default() };
    Simulation::with_systems(&scene, &options, &Registry::default().with(system())).unwrap()
}

#[test]
fn what_looks_at_other_nodes_shares_no_kernel_with_what_moves_them() {
    let mut host = begun(BackendChoice::Cpu);
    let told = host.explain_on_gpu(&Registry::default().with(system())).unwrap();
    let kernels: Vec<&str> = told.kernels.iter().map(|kernel| kernel.system.as_str()).collect();
    let with = |name: &str| kernels.iter().filter(|kernel| kernel.contains(name)).count();
    assert!(with("herd") > 0 && with("integrate") > 0, "{kernels:?}");
    assert!(!kernels.iter().any(|kernel| kernel.contains("herd") && kernel.contains("integrate")), "{kernels:?}");
    if gpu_or_reason().is_none() {
        return;
    }
    let mut device = begun(BackendChoice::Gpu);
    host.advance(200).unwrap();
    device.advance(200).unwrap();
    let [of_host, of_device] = [&mut host, &mut device].map(|simulation| simulation.displacements("cube").unwrap());
    let largest = of_host.iter().map(|u| u.length()).fold(0.0, f64::max);
    let off = of_host.iter().zip(&of_device).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // both in f32
    assert!(largest > 1e-3 && off <= 1e-4 * largest, "{off} m of {largest} m");
}
