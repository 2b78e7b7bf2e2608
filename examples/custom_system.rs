//! A system of one's own: a magnet that circles above a gel and pulls what is near.
//!
//! `cargo run --release --example custom_system [FOLDER]` runs examples/magnet.ron on the CPU and, if there is one, on the
//! GPU, prints what the system cost, and writes what a run writes into FOLDER, for `sinew render` and ParaView.

use sinew::backend::gpu::NoGpu;
use sinew::bevy_ecs::prelude::*;
use sinew::components::{Clock, Displacement, ExternalForce, Mass, RestPosition};
use sinew::glam::DVec3;
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, Options, SceneFile, Simulation, output::Folder};
use std::path::Path;

/// What the scene says under `parameters`.
#[derive(Resource, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Magnet {
    center: DVec3,
    radius: f64,
    turns: f64,
    acceleration: f64,
    reach: f64,
}

/// The system: what it asks for is what it gets, and what the engine brings to the host for it in a GPU run.
fn magnet(
    magnet: Res<Magnet>,
    clock: Res<Clock>,
    mut bodies: Query<(&RestPosition, &Displacement, &Mass, &mut ExternalForce)>,
) {
    let angle = std::f64::consts::TAU * magnet.turns * clock.time();
    let place = magnet.center + magnet.radius * DVec3::new(angle.cos(), angle.sin(), 0.0);
    // it comes up slowly: a sudden pull would ring
    let strength = magnet.acceleration * (clock.time() / 0.2).min(1.0);
    for (rest, displacement, mass, mut force) in &mut bodies {
        for row in 0..rest.0.len() {
            let toward = place - (rest.0[row] + displacement.vector(row));
            let near = (-toward.length_squared() / magnet.reach.powi(2)).exp();
            let pull = mass.get(row) * strength * near * toward.normalize_or_zero();
            // other loads may have been here before
            let sum = force.vector(row) + pull;
            force.set_vector(row, sum);
        }
    }
}

/// Runs the scene, prints what it cost, and returns the height of the highest bulge (m).
pub fn run(scene: &SceneFile, backend: BackendChoice, folder: Option<&str>) -> Result<f64, sinew::Error> {
    let does = "pulls what is near a circling magnet";
    let system = System::custom("magnet", Phase::Loads, does, magnet).with_parameters::<Magnet>();
    let registry = Registry::default().with(system);
    let options = Options { backend, ..Options::default() };
    let mut simulation = Simulation::with_systems(scene, &options, &registry)?;
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
        println!("  {:16} {time}", system.name);
        if !system.brought.is_empty() {
            println!("  {:16} brought: {}; sent: {}", "", system.brought.join(", "), system.sent.join(", "));
        }
    }
    if let Some(traffic) = summary.traffic {
        let megabytes = (traffic.down + traffic.up) as f64 / 1e6;
        println!("  {megabytes:.1} MB travelled for the systems on the host, in {:.2} s", traffic.seconds);
    }
    let highest = simulation.displacements("gel")?.iter().map(|u| u.z).fold(0.0, f64::max);
    println!("  the highest bulge is {:.1} mm at t = {:.2} s", 1e3 * highest, simulation.time());
    Ok(highest)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1);
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/magnet.ron");
    let scene = SceneFile::load(scene, &[]).map_err(sinew::Error::from)?;
    run(&scene, BackendChoice::Cpu, folder.as_deref())?;
    match run(&scene, BackendChoice::Gpu, None) {
        Err(sinew::Error::NoGpu(NoGpu::NoDriver)) => println!("there is no GPU here, nor a software one"),
        Err(other) => return Err(other.into()),
        Ok(_) => {}
    }
    Ok(())
}
