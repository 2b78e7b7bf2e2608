//! A system of one's own: a magnet that circles above a gel and pulls what is near. It works node by node and shares
//! passes with the engine's own systems, on both backends.
//!
//! `cargo run --release --example custom_system [FOLDER]` runs examples/magnet.ron on the CPU and, if there is one, on
//! the GPU, prints what each pass cost, and writes what a run writes into FOLDER, for `sinew render` and ParaView.

use sinew::NoGpu;
use sinew::bevy_ecs::prelude::*;
use sinew::components::{Displacement, ExternalForce, Mass, RestPosition};
use sinew::glam::DVec3;
use sinew::systems::{
    Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, Phase, Registry, SimdScalar, System,
};
use sinew::{BackendChoice, Folder, Options, SceneFile, Simulation};
use std::path::Path;

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct Magnet {
    center: DVec3,
    radius: f64,
    turns: f64,
    acceleration: f64,
    reach: f64,
}

impl NodeSystem for Magnet {
    /// What it reads and writes: on a GPU, the buffers of examples/magnet.wgsl.
    type Columns = (&'static RestPosition, &'static Displacement, &'static Mass, &'static mut ExternalForce);
    /// Where the magnet is (m), and how much it pulls (m/s²).
    type Prepared = (DVec3, f64);

    fn prepare(&self, before: &Before<'_>) -> (DVec3, f64) {
        let time = before.clock.time();
        let angle = std::f64::consts::TAU * self.turns * time;
        let place = self.center + self.radius * DVec3::new(angle.cos(), angle.sin(), 0.0);
        // it comes up slowly: a sudden pull would ring
        (place, self.acceleration * (time / 0.2).min(1.0))
    }

    /// The norm of ∂/∂x of exp(−r²/R²) x/r, at half its reach and beyond: nothing of the gel comes nearer.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: 2.34 * self.acceleration / self.reach, damping: 0.0 }
    }

    fn act<T: SimdScalar>(&self, &(place, strength): &(DVec3, f64), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            let toward = place - nodes.place(row);
            let near = (-toward.length_squared() / self.reach.powi(2)).exp();
            nodes.add_load(row, nodes.mass()[row].to_f64() * strength * near * toward.normalize_or_zero());
        }
    }
}

/// The systems of the engine and this one.
pub fn registry() -> Registry {
    let magnet = System::of_nodes::<Magnet>("magnet", Phase::Loads, "pulls what is near a circling magnet")
        .on_each_body::<Magnet>()
        .with_shader::<Magnet>("examples/magnet.wgsl", include_str!("magnet.wgsl"));
    Registry::default().with(magnet)
}

/// Runs the scene and prints what it cost.
pub fn run(
    scene: &SceneFile,
    registry: &Registry,
    backend: BackendChoice,
    folder: Option<&str>,
) -> Result<Simulation, sinew::Error> {
    let options = Options { backend, ..Options::default() };
    let mut simulation = Simulation::with_systems(scene, &options, registry)?;
    if let Some(path) = folder {
        simulation.write_into(&mut Folder::create(Path::new(path))?)?;
        simulation.observe()?;
    }
    simulation.finish()?;

    let summary = simulation.summary("finished")?;
    println!("{}: {} steps in {:.2} s", summary.backend, summary.steps, summary.run_seconds);
    for system in &summary.systems {
        let time =
            system.seconds.map_or("(on the device)".into(), |s| format!("{:.1} %", 100.0 * s / summary.run_seconds));
        println!("  {:58} {time}", system.name);
        if !system.brought.is_empty() {
            println!("  {:16} brought: {}; sent: {}", "", system.brought.join(", "), system.sent.join(", "));
        }
    }
    if let Some(traffic) = summary.traffic {
        let megabytes = (traffic.down + traffic.up) as f64 / 1e6;
        println!("  {megabytes:.1} MB travelled for the systems on the host, in {:.2} s", traffic.seconds);
    }
    Ok(simulation)
}

/// The height of the highest bulge of the gel (m).
pub fn bulge(simulation: &mut Simulation) -> Result<f64, sinew::Error> {
    Ok(simulation.displacements("gel")?.iter().map(|u| u.z).fold(0.0, f64::max))
}

/// Runs the magnet's scene on the CPU and, if there is one, on the GPU.
pub fn compare(registry: &Registry, folder: Option<&str>) -> Result<(), Box<dyn std::error::Error>> {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/magnet.ron");
    let scene = SceneFile::load(scene, &[]).map_err(sinew::Error::from)?;
    for (backend, folder) in [(BackendChoice::Cpu, folder), (BackendChoice::Gpu, None)] {
        match run(&scene, registry, backend, folder) {
            Err(sinew::Error::NoGpu(NoGpu::NoDriver)) => println!("there is no GPU here, nor a software one"),
            Err(other) => return Err(other.into()),
            Ok(mut simulation) => {
                let highest = 1e3 * bulge(&mut simulation)?;
                println!("  the highest bulge is {highest:.1} mm at t = {:.2} s", simulation.time());
            }
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    compare(&registry(), std::env::args().nth(1).as_deref())
}
