//! How long a touch takes: where a tool is goes in, what it feels comes out, step by step.
//!
//! `cargo run --release --example latency [SCENE] [THREADS]` presses a lens (scenes/lens_pressed.ron, whose pressure is
//! an input here), takes hold of its front where a ray meets it, and moves that up and down. It prints how long one
//! step and how long a millisecond of simulated time take, target in to force out: the median, what 99 in 100 stay
//! below, and the longest; then how much of life sixty frames a second keep up with, where each may take 12 ms.

use sinew::glam::DVec3;
use sinew::{BackendChoice, Error, Grip, Options, SceneFile, Simulation};
use std::time::{Duration, Instant};

/// What a picture leaves of a sixtieth of a second.
const BUDGET: Duration = Duration::from_millis(12);

/// Touches for so long (simulated, s) and prints what it took; returns the largest force of the hand (N).
pub fn run(scene: &SceneFile, threads: usize, seconds: f64) -> Result<f64, Error> {
    let options = Options { backend: BackendChoice::Cpu, threads, grabs: true, ..Options::default() };
    let mut simulation = Simulation::new(scene, &options)?;
    let above = DVec3::new(0.1e-3, 0.1e-3, 1.0);
    let pick = simulation.pick(above, -DVec3::Z)?.ok_or_else(|| Error::Options("the ray misses the lens".into()))?;
    let hand = simulation.grab(&pick, &Grip { most_force: 0.01, ..Grip::default() })?;

    let (mut steps, mut frames) = (Vec::new(), Vec::new());
    let (mut largest, mut deepest) = (0.0_f64, 0.0_f64);
    let mut frame = Duration::ZERO;
    while simulation.time() < seconds {
        let started = Instant::now();
        // target in: it goes 0.5 mm below the front's rest and back, five times a second, while the front is pressed
        let share = 0.5 * (1.0 - (std::f64::consts::TAU * 5.0 * simulation.time()).cos());
        simulation.move_grab(hand, pick.point - 0.5e-3 * share * DVec3::Z)?;
        simulation.set_input("press", 0.2 * share)?;
        simulation.step()?;
        // force out
        let force = simulation.grab_force(hand)?.length();
        let took = started.elapsed();
        steps.push(took);
        frame += took;
        // a haptic device asks a thousand times a second
        if simulation.time() >= 1e-3 * (frames.len() + 1) as f64 {
            frames.push(std::mem::take(&mut frame));
        }
        largest = largest.max(force);
        deepest = deepest.max(0.5e-3 * share);
    }
    println!(
        "{} threads, step {:.1} µs: up to {:.3} mN at {:.2} mm",
        if threads == 0 { "default".into() } else { threads.to_string() },
        1e6 * simulation.time_step(),
        1e3 * largest,
        1e3 * deepest
    );
    told("one step, target in to force out", &mut steps);
    told("1 ms of simulated time", &mut frames);

    simulation.release(hand)?;
    let (mut simulated, mut took) = (0.0, 0.0);
    for _ in 0..5 {
        let until = simulation.time() + 1.0 / 60.0;
        let frame = simulation.advance_for(BUDGET, until)?;
        simulated += frame.simulated;
        took += frame.took.as_secs_f64();
    }
    println!("  5 frames: {:.1} ms simulated in {:.1} ms", 1e3 * simulated, 1e3 * took);
    Ok(largest)
}

fn told(what: &str, times: &mut [Duration]) {
    times.sort();
    let at = |share: f64| 1e6 * times[((times.len() - 1) as f64 * share) as usize].as_secs_f64();
    println!("  {what:34} median {:7.1} µs, 99 % below {:7.1} µs, longest {:7.1} µs", at(0.5), at(0.99), at(1.0));
}

/// What makes a scene whose first load is known beforehand one in which a program presses.
pub const TOUCHED: [&str; 1] = ["loads[0].curve=Input(name: \"press\", rate: 20)"];

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
