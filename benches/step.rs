//! What a step costs on one thread, what a large body costs to set up, and how much memory it takes.
//!
//! `cargo bench --bench step` prints ns an element and step beside criterion's own figures. `cargo bench --bench step
//! -- 10` runs the small ones only, `-- guards` what the guards cost (with SINEW_BENCH_GPU set, on the GPU in f32), `--
//! energies` laws from an energy beside the same laws written by hand, `-- bodies` many small bodies on one thread and
//! on two.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use criterion::{Criterion, Throughput};
use sinew::components::Precision;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// A cube under gravity, `cells` along each edge, of a material with an elastic law and effects.
fn cube(elements: &str, cells: u32, material: &str) -> SceneFile {
    scene(&cube_text(elements, cells, material))
}

fn cube_text(elements: &str, cells: u32, material: &str) -> String {
    format!(
        "(duration: 1000.0,
          bodies: {{ \"cube\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: {elements}),
                               material: \"tissue\") }},
          materials: {{ \"tissue\": (density: 1000, {material}) }},
          constraints: [Fixed(on: Set(\"z0\"))],
          loads: [Gravity(acceleration: (0, 0, -2))])"
    )
}

fn scene(text: &str) -> SceneFile {
    SceneFile::from_text("cube", text, Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")), &[])
        .unwrap_or_else(|wrong| panic!("{wrong}"))
}

fn simulation(scene: &SceneFile, precision: Precision, threads: usize) -> Simulation {
    let options = Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() };
    Simulation::new(scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"))
}

const NEO_HOOKEAN: &str = "neo_hookean: Young(young: 3000, poisson: 0.45)";

/// Materials of about the same stiffness, by what they have.
const MATERIALS: [(&str, &str); 9] = [
    (
        "fibres and viscosity",
        "neo_hookean: Young(young: 3000, poisson: 0.45), fibres: (eta: 2000, direction: Along(1, 0, 0)), prony: (terms: [(alpha: 0.5, tau: 0.58)])",
    ),
    ("linear", "linear: Young(young: 3000, poisson: 0.45)"),
    ("St. Venant-Kirchhoff", "st_venant_kirchhoff: Young(young: 3000, poisson: 0.45)"),
    ("Mooney-Rivlin", "mooney_rivlin: (c10: 300, c01: 217, bulk: 10000)"),
    ("Ogden, one term", "ogden: (terms: [(mu: 413, alpha: 5)], bulk: 10000)"),
    ("Arruda-Boyce", "arruda_boyce: (shear: 900, locking_stretch: 2, bulk: 10000)"),
    (
        "exponential fibres",
        "neo_hookean: Young(young: 3000, poisson: 0.45), exponential_fibres: [(k1: 500, k2: 2, direction: Along(1, 0, 0))]",
    ),
    (
        "volumetric viscosity",
        "neo_hookean: Young(young: 3000, poisson: 0.45), prony: (terms: [(alpha: 0.5, tau: 0.58)], volumetric: [(alpha: 0.2, tau: 0.58)])",
    ),
    ("user's law", "law: (file: \"own_law.wgsl\", parameters: {\"mu\": 1034.5, \"b\": 1, \"bulk\": 10000})"),
];

/// Elements, with how many of them fill a cell.
const ELEMENTS: [(&str, u64); 4] = [("Tet4", 6), ("Hex8", 1), ("Tet4NodalPressure", 6), ("Hex8MeanDilatation", 1)];

fn steps(criterion: &mut Criterion) {
    for cells in [10, 20, 30] {
        let mut group = Group::new(criterion, &format!("{cells}^3 cells"), cells);
        for element in ELEMENTS {
            group.measure(element, "neo-Hookean", NEO_HOOKEAN, Precision::F32);
            group.measure(element, "neo-Hookean", NEO_HOOKEAN, Precision::F64);
            group.measure(element, MATERIALS[0].0, MATERIALS[0].1, Precision::F32);
        }
    }
    let mut group = Group::new(criterion, "materials at 20^3 cells", 20);
    for element in &ELEMENTS[..2] {
        for (name, material) in [("neo-Hookean", NEO_HOOKEAN)].into_iter().chain(MATERIALS) {
            group.measure(*element, name, material, Precision::F32);
        }
    }
}

/// Measurements with so many cells along each edge.
struct Group<'a> {
    criterion: criterion::BenchmarkGroup<'a, criterion::measurement::WallTime>,
    cells: u32,
}

impl<'a> Group<'a> {
    fn new(criterion: &'a mut Criterion, name: &str, cells: u32) -> Self {
        let mut group = criterion.benchmark_group(name);
        group.sample_size(20).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
        Self { criterion: group, cells }
    }

    fn measure(&mut self, (element, count): (&str, u64), name: &str, material: &str, precision: Precision) {
        let elements = u64::from(self.cells).pow(3) * count;
        let word = if precision == Precision::F64 { "f64" } else { "f32" };
        // made when it is measured: a filter on the command line leaves the others out
        let mut made = None;
        let mut best = f64::INFINITY;
        self.criterion.throughput(Throughput::Elements(elements));
        self.criterion.bench_function(format!("{element}, {name}, {word}"), |bencher| {
            let simulation = made.get_or_insert_with(|| simulation(&cube(element, self.cells, material), precision, 1));
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

/// Steps that are timed at once.
const BLOCK: u64 = 8;

/// What the guards of every run cost: blocks of steps with and without counted work by turns, the best of each, so that
/// other work on the machine does not count; and a sample, of which there is one in 256 steps.
fn guards() {
    let gpu = std::env::var_os("SINEW_BENCH_GPU").is_some();
    let configurations = [("f32", Precision::F32, gpu), ("f64", Precision::F64, false)];
    let prescribed = "Prescribed(on: Set(\"z1\"), displacement: (0.001, 0, 0), curve: Smooth(end: 1))";
    for (kind, cells) in [("Tet4", 20), ("Tet4NodalPressure", 20), ("Hex8", 30), ("Hex8MeanDilatation", 20)] {
        for (word, precision, gpu) in configurations {
            let of = |guards: &str, constraint: &str| {
                let text = cube_text(kind, cells, "neo_hookean: Young(young: 3000, poisson: 0.45)")
                    .replace("loads:", &format!("{guards} loads:"));
                let text = text.replace("constraints: [", &format!("constraints: [{constraint}"));
                let backend = if gpu { BackendChoice::Gpu } else { BackendChoice::Cpu };
                let options = Options { backend, precision, threads: 1, ..Options::default() };
                Simulation::new(&scene(&text), &options).unwrap_or_else(|wrong| panic!("{wrong}"))
            };
            let none = "guards: (off: [Energy, Hourglass], every: 1000000000),";
            let moved = format!("{prescribed}, ");
            let every = "guards: (every: 1000000000),";
            let mut all = [of(none, ""), of(every, ""), of(none, &moved), of(every, &moved)];
            let mut best = [f64::INFINITY; 5];
            // blocks short enough to be left alone by the machine's other work
            for _ in 0..80 {
                for (simulation, best) in all.iter_mut().zip(&mut best) {
                    let started = Instant::now();
                    simulation.advance(BLOCK).expect("steps");
                    *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
                }
            }
            let mut sample = f64::INFINITY;
            for _ in 0..20 {
                let started = Instant::now();
                sinew::observation::sample(all[1].world_mut()).expect("a sample");
                sample = sample.min(started.elapsed().as_secs_f64());
            }
            best[4] = best[1] + sample / 256.0;
            let share = |i: usize| 100.0 * (best[i] / best[0] - 1.0);
            println!(
                "guards, {kind} {cells}^3 {word}{}: {:.1} us a step without, work {:+.1} %, all of them {:+.1} %; work \
                 with prescribed nodes {:+.1} %; a sample is {:.1} steps",
                if gpu { " GPU" } else { "" },
                best[0] * 1e6,
                share(1),
                share(4),
                100.0 * (best[3] / best[2] - 1.0),
                sample / best[0]
            );
        }
    }
}

/// The neo-Hookean law with another U(J), its stresses by hand.
const OTHER_VOLUME: &str = "
struct Law { mu: f32, k: f32 }
@group(0) @binding(0) var<uniform> elastic: Law;
fn elastic_isochoric(k: Kinematics) -> Sym3 { return stress_of_slope(k, 0.5 * elastic.mu); }
fn elastic_pressure(volume_change: f32) -> f32 {
    return 0.5 * elastic.k * (volume_change + volume_change / (1.0 + volume_change));
}
fn elastic_isochoric_energy(k: Kinematics) -> f32 { return 0.5 * elastic.mu * i1_change(k); }
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    let square = volume_change * (2.0 + volume_change);
    return 0.25 * elastic.k * (square - 2.0 * logarithm_of_one_plus(volume_change));
}
";

/// Laws by hand, built in or in WGSL, each beside the same law from its energy. A thousandth of a millionth of J⁴ keeps
/// an energy from being recognised as a law built in.
const ENERGIES: [(&str, &str, &str, &str); 5] = [
    (
        "neo-Hookean, built in",
        NEO_HOOKEAN,
        "mu/2*I1bar_minus_3 + k/2*J_minus_1^2 + 1e-9*k*J_minus_1^4",
        "{\"mu\": 1034.5, \"k\": 10000}",
    ),
    (
        "Mooney-Rivlin, built in",
        "mooney_rivlin: (c10: 300, c01: 217, bulk: 10000)",
        "a*I1bar_minus_3 + b*I2bar_minus_3 + k/2*J_minus_1^2 + 1e-9*k*J_minus_1^4",
        "{\"a\": 300, \"b\": 217, \"k\": 10000}",
    ),
    (
        "Arruda-Boyce, built in",
        "arruda_boyce: (shear: 900, locking_stretch: 2, bulk: 10000)",
        "mu*((I1bar - 3)/2 + (I1bar^2 - 9)/(20*m^2) + 11/1050*(I1bar^3 - 27)/m^4 + 19/7000*(I1bar^4 - 81)/m^6 \
         + 519/673750*(I1bar^5 - 243)/m^8) + k/2*J_minus_1^2",
        "{\"mu\": 900, \"m\": 2, \"k\": 10000}",
    ),
    (
        "Demiray, stresses in WGSL",
        "law: (file: \"own_law.wgsl\", parameters: {\"mu\": 1034.5, \"b\": 1, \"bulk\": 10000})",
        "mu/(2*b)*(exp(b*I1bar_minus_3) - 1) + k/2*J_minus_1^2",
        "{\"mu\": 1034.5, \"b\": 1, \"k\": 10000}",
    ),
    (
        "neo-Hookean with another U(J), stresses in WGSL",
        "law: (file: \"other.wgsl\", parameters: {\"mu\": 1034.5, \"k\": 10000})",
        "mu/2*I1bar_minus_3 + k/4*(J^2 - 1 - 2*log(J))",
        "{\"mu\": 1034.5, \"k\": 10000}",
    ),
];

/// What laws from an energy cost: blocks of steps under the two by turns, the best of each.
fn energies() {
    let files: BTreeMap<String, Vec<u8>> =
        [("own_law.wgsl", include_str!("../examples/own_law.wgsl")), ("other.wgsl", OTHER_VOLUME)]
            .map(|(name, text)| (name.to_owned(), text.into()))
            .into();
    let start = |kind: &str, cells: u32, law: &str, precision: Precision| {
        let text = cube_text(kind, cells, law);
        let scene = SceneFile::from_memory("cube", &text, files.clone(), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        simulation(&scene, precision, 1)
    };
    for (kind, cells, count) in [("Tet4", 16, 6), ("Hex8", 24, 1), ("Hex8MeanDilatation", 16, 1)] {
        for (word, precision) in [("f32", Precision::F32), ("f64", Precision::F64)] {
            for (name, by_hand, energy, parameters) in ENERGIES {
                let energy = format!("law: (energy: \"{energy}\", parameters: {parameters})");
                let mut pair = [by_hand, &energy].map(|law| start(kind, cells, law, precision));
                let mut best = [f64::INFINITY; 2];
                for _ in 0..60 {
                    for (simulation, best) in pair.iter_mut().zip(&mut best) {
                        let started = Instant::now();
                        simulation.advance(BLOCK).expect("steps");
                        *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
                    }
                }
                let [by_hand, energy] = best.map(|time| time * 1e9 / f64::from(cells.pow(3) * count));
                println!(
                    "energies, {kind} {word}, {name}: {by_hand:.1} ns an element and step, {energy:.1} from its energy: \
                     {:.2} times",
                    energy / by_hand
                );
            }
        }
    }
}

/// Bodies of one patch each, which threads have to share among them: blocks of steps on one thread and on two by turns.
fn bodies() {
    for (kind, cells, elements) in [("Tet4", 5, 750_u64), ("Hex8", 6, 216)] {
        for count in [1_u32, 2, 5, 20] {
            let bodies: String = (0..count)
                .map(|number| {
                    format!(
                        "\"{number}\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: \
                         {kind}), material: \"tissue\", translate: ({}, 0, 0)), ",
                        0.2 * f64::from(number)
                    )
                })
                .collect();
            let text = format!(
                "(duration: 1000.0, bodies: {{ {bodies} }}, materials: {{ \"tissue\": (density: 1000, {NEO_HOOKEAN}) }},
                  loads: [Gravity(acceleration: (0, 0, -2))])"
            );
            let mut pair = [1, 2].map(|threads| simulation(&scene(&text), Precision::F32, threads));
            let mut best = [f64::INFINITY; 2];
            for _ in 0..100 {
                for (simulation, best) in pair.iter_mut().zip(&mut best) {
                    let started = Instant::now();
                    simulation.advance(BLOCK).expect("steps");
                    *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
                }
            }
            println!(
                "bodies, {count} of {elements} {kind}: {:.1} us a step on one thread, {:.1} on two: {:.2} of it",
                best[0] * 1e6,
                best[1] * 1e6,
                best[1] / best[0]
            );
        }
    }
}

/// Runs in a process of its own, so that its peak memory is its own.
fn million() {
    let started = Instant::now();
    let scene = cube("Tet4", 55, NEO_HOOKEAN);
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
    if std::env::args().any(|argument| argument == "guards") {
        return guards();
    }
    if std::env::args().any(|argument| argument == "energies") {
        return energies();
    }
    if std::env::args().any(|argument| argument == "bodies") {
        return bodies();
    }
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
