//! A system of one's own that only the host can do: the magnet of examples/custom_system.rs as a bevy system, which
//! sees whole columns. On a GPU these travel to the host and back in every step.
//!
//! `cargo run --release --example host_system` runs examples/magnet.ron on the CPU and, if there is one, on the GPU,
//! and prints what the system cost.

use sinew::NoGpu;
use sinew::bevy_ecs::prelude::*;
use sinew::components::{Clock, Displacement, ExternalForce, Mass, RestPosition};
use sinew::glam::DVec3;
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, Options, SceneFile, Simulation};

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

/// The systems of the engine and this one.
pub fn registry() -> Registry {
    let does = "pulls what is near a circling magnet, on the host";
    Registry::default().with(System::custom("magnet", Phase::Loads, does, magnet).with_parameters::<Magnet>())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/magnet.ron");
    let scene = SceneFile::load(scene, &[]).map_err(sinew::Error::from)?;
    for backend in [BackendChoice::Cpu, BackendChoice::Gpu] {
        let options = Options { backend, ..Options::default() };
        let mut simulation = match Simulation::with_systems(&scene, &options, &registry()) {
            Err(sinew::Error::NoGpu(NoGpu::NoDriver)) => {
                println!("there is no GPU here, nor a software one");
                continue;
            }
            made => made?,
        };
        simulation.finish()?;
        let summary = simulation.summary("finished")?;
        println!("{}: {} steps in {:.2} s", summary.backend, summary.steps, summary.run_seconds);
        if let Some(magnet) = summary.systems.iter().find(|system| system.name == "magnet") {
            let share = 100.0 * magnet.seconds.unwrap_or(0.0) / summary.run_seconds;
            println!("  magnet: {share:.1} %, brought {}, sent {}", magnet.brought.join(", "), magnet.sent.join(", "));
        }
        if let Some(traffic) = summary.traffic {
            let megabytes = (traffic.down + traffic.up) as f64 / 1e6;
            println!("  {megabytes:.1} MB travelled for it, in {:.2} s", traffic.seconds);
        }
    }
    Ok(())
}
