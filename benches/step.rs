//! What a step costs on one thread, what a large body costs to set up, and how much memory it takes.
//!
//! `cargo bench --bench step` prints ns an element and step beside criterion's own figures. `cargo bench --bench step -- 10`
//! runs the small ones only.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use criterion::{Criterion, Throughput};
use sinew::components::Precision;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;
use std::time::{Duration, Instant};

/// A cube under gravity, `cells` along each edge. `effects` are further fields of the material.
fn cube(elements: &str, cells: u32, effects: &str) -> SceneFile {
    let text = format!(
        "(duration: 1000.0,
          bodies: {{ \"cube\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: {elements}),
                               material: \"tissue\") }},
          materials: {{ \"tissue\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), {effects}) }},
          constraints: [Fixed(on: Set(\"z0\"))],
          loads: [Gravity(acceleration: (0, 0, -9.81))])"
    );
    SceneFile::from_text("cube", &text, Path::new("."), &[]).unwrap_or_else(|wrong| panic!("{wrong}"))
}

fn simulation(scene: &SceneFile, precision: Precision, threads: usize) -> Simulation {
    let options = Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() };
    Simulation::new(scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"))
}

const EFFECTS: [(&str, &str); 2] = [
    ("neo_hookean", ""),
    ("fibres_prony", "fibres: (eta: 2000, direction: Along(1, 0, 0)), prony: (terms: [(alpha: 0.5, tau: 0.58)])"),
];

fn steps(criterion: &mut Criterion) {
    for cells in [10, 20, 30] {
        let mut group = criterion.benchmark_group(format!("{cells}^3 cells"));
        group.sample_size(20).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
        for (kind, count) in [("Tet4", 6), ("Hex8", 1)] {
            let elements = u64::from(cells).pow(3) * count;
            group.throughput(Throughput::Elements(elements));
            for (name, effects) in EFFECTS {
                for (precision, word) in [(Precision::F32, "f32"), (Precision::F64, "f64")] {
                    if precision == Precision::F64 && !effects.is_empty() {
                        continue;
                    }
                    let mut simulation = simulation(&cube(kind, cells, effects), precision, 1);
                    let mut best = f64::INFINITY;
                    group.bench_function(format!("{kind} {name} {word}"), |bencher| {
                        bencher.iter_custom(|count| {
                            let started = Instant::now();
                            simulation.advance(count).expect("a step");
                            let elapsed = started.elapsed();
                            best = best.min(elapsed.as_secs_f64() / count as f64);
                            elapsed
                        });
                    });
                    if best.is_finite() {
                        println!("{:>40}  best {:.1} ns an element and step", "", best * 1e9 / elements as f64);
                    }
                }
            }
        }
        group.finish();
    }
}

/// Runs in a process of its own, so that its peak memory is its own.
fn million() {
    let started = Instant::now();
    let scene = cube("Tet4", 55, "");
    let mut simulation = simulation(&scene, Precision::F32, 0);
    let built = started.elapsed();
    simulation.advance(1).expect("a step");
    let first = started.elapsed();
    simulation.advance(20).expect("steps");
    let elements = 6 * 55_u64.pow(3);
    let a_step = (started.elapsed() - first).as_secs_f64() / 20.0;
    println!("a million tetrahedra ({elements}), f32, all threads:");
    println!("  set up in {:.2} s, first step after {:.2} s", built.as_secs_f64(), first.as_secs_f64());
    println!("  {:.1} ns an element and step", a_step * 1e9 / elements as f64);
    match peak_memory() {
        Some(bytes) => println!("  peak memory {} MB, {} bytes an element", bytes / 1_000_000, bytes / elements),
        None => println!("  peak memory: only known on Linux"),
    }
}

/// The largest resident set of this process so far (bytes).
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}

fn main() {
    if std::env::var_os("SINEW_BENCH_MILLION").is_some() {
        return million();
    }
    let mut criterion = Criterion::default().configure_from_args();
    steps(&mut criterion);
    criterion.final_summary();
    let filtered = std::env::args().skip(1).any(|argument| !argument.starts_with('-'));
    if !filtered && !std::env::args().any(|argument| argument == "--test") {
        let myself = std::env::current_exe().expect("this program");
        let status = std::process::Command::new(myself).env("SINEW_BENCH_MILLION", "1").status();
        assert!(status.expect("the same program").success());
    }
}
