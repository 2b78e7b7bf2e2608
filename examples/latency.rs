//! How long a touch takes: where a tool is goes in, what it feels comes out, step by step.
//!
//! `cargo run --release --example latency [SCENE] [THREADS]` touches a lens (scenes/lens_pressed.ron without its
//! pressure) with a ball that goes up and down, and prints how long one step and how long a millisecond of simulated
//! time take: the median, what 99 in 100 stay below, and the longest. A scene's curves are known beforehand; what only
//! the moment knows comes in through a resource that the program writes between steps and a system of its own reads.

use sinew::bevy_ecs::prelude::*;
use sinew::components::{Displacement, ExternalForce, RestPosition};
use sinew::glam::DVec3;
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation};
use std::time::{Duration, Instant};

/// The tool: a ball that pushes nodes out of itself, by so much force a node and depth (N/m).
#[derive(Resource, Default, Clone)]
struct Tool {
    center: DVec3,
    radius: f64,
    stiffness: f64,
    /// What the tool feels (N), written by the system.
    reaction: DVec3,
}

/// Pushes, and sums what pushes back. Nodes of the surface alone would do; all of them are few.
fn touch(mut tool: ResMut<Tool>, mut bodies: Query<(&RestPosition, &Displacement, &mut ExternalForce)>) {
    let mut reaction = DVec3::ZERO;
    for (rest, displacement, mut force) in &mut bodies {
        for (row, rest) in rest.0.iter().enumerate() {
            let out = *rest + displacement.vector(row) - tool.center;
            let depth = tool.radius - out.length();
            if depth > 0.0 {
                let push = tool.stiffness * depth * out.normalize_or_zero();
                let sum = force.vector(row) + push;
                force.set_vector(row, sum);
                reaction -= push;
            }
        }
    }
    tool.reaction = reaction;
}

/// Touches for so long (simulated, s) and prints what it took; returns the largest reaction (N).
pub fn run(scene: &SceneFile, threads: usize, seconds: f64) -> Result<f64, Error> {
    let system = System::custom("touch", Phase::Loads, "pushes nodes out of a tool", touch);
    let registry = Registry::default().with(system);
    let options = Options { backend: BackendChoice::Cpu, threads, ..Options::default() };
    let mut simulation = Simulation::with_systems(scene, &options, &registry)?;
    // a node's share of the lens's own stiffness, E times the size of an element
    let mut tool = Tool { radius: 1e-3, stiffness: 2.0, ..Tool::default() };

    let (mut steps, mut frames) = (Vec::new(), Vec::new());
    let (mut largest, mut deepest) = (0.0_f64, 0.0_f64);
    let mut frame = Duration::ZERO;
    while simulation.time() < seconds {
        let started = Instant::now();
        // load in: the tool's tip goes 0.5 mm below the front's rest and back, five times a second
        let depth = 0.25e-3 * (1.0 - (std::f64::consts::TAU * 5.0 * simulation.time()).cos());
        tool.center = DVec3::new(0.0, 0.0, 2e-3 + tool.radius - depth);
        simulation.world_mut().insert_resource(tool.clone());
        simulation.step()?;
        // reaction out
        let reaction = simulation.world().resource::<Tool>().reaction;
        let took = started.elapsed();
        steps.push(took);
        frame += took;
        // a haptic device asks a thousand times a second
        if simulation.time() >= 1e-3 * (frames.len() + 1) as f64 {
            frames.push(std::mem::take(&mut frame));
        }
        largest = largest.max(reaction.z);
        deepest = deepest.max(depth);
    }
    println!(
        "{} threads, step {:.1} µs: up to {:.3} mN at {:.2} mm",
        if threads == 0 { "default".into() } else { threads.to_string() },
        1e6 * simulation.time_step(),
        1e3 * largest,
        1e3 * deepest
    );
    told("one step, load in to reaction out", &mut steps);
    told("1 ms of simulated time", &mut frames);
    Ok(largest)
}

fn told(what: &str, times: &mut [Duration]) {
    times.sort();
    let at = |share: f64| 1e6 * times[((times.len() - 1) as f64 * share) as usize].as_secs_f64();
    println!("  {what:34} median {:7.1} µs, 99 % below {:7.1} µs, longest {:7.1} µs", at(0.5), at(0.99), at(1.0));
}

/// What makes a scene of a body alone one that is touched.
pub const TOUCHED: [&str; 3] = [
    "loads=[]",
    "schedule=[\"boundary\", \"element_forces\", \"gather\", \"touch\", \"integrate\", \"observe\"]",
    // the tool is stiffness that the limit does not know
    "integration.safety=0.8",
];

#[allow(dead_code)]
fn main() -> Result<(), Error> {
    let mut arguments = std::env::args().skip(1);
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lens_pressed.ron").to_string();
    let path = arguments.next().unwrap_or(default);
    let threads = arguments.next().and_then(|word| word.parse().ok()).unwrap_or(0);
    let sets: Vec<String> = TOUCHED.iter().map(|set| set.to_string()).chain(arguments).collect();
    run(&SceneFile::load(&path, &sets)?, threads, 1.0)?;
    Ok(())
}
