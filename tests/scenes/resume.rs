//! What goes on from a snapshot is what was never interrupted, in a new simulation and in one that is further already:
//! every scene that ships, every hard case and every scene of `tests/endings`, on CPU f64, CPU f32 and, of many every
//! other one, on the GPU. Whole snapshots are compared, byte by byte: columns, clock, guards, resume state.

use sinew::backend::gpu::gpu_or_reason;
use sinew::components::Precision;
use sinew::{BackendChoice, Options, SceneFile, Simulation, Snapshot};
use std::path::Path;

/// Snapshots of a scene, its end included.
const SNAPSHOTS: u64 = 6;
/// Elements times steps that a scene is run for, on the CPU and on a GPU, which may be one in software.
const WORK: (u64, u64) = (40_000, 6_000);

fn options() -> Vec<Options> {
    let of = |backend, precision| Options { backend, precision, threads: 1, ..Options::default() };
    let mut all = vec![of(BackendChoice::Cpu, Precision::F64), of(BackendChoice::Cpu, Precision::F32)];
    if gpu_or_reason().is_some() {
        all.push(of(BackendChoice::Gpu, Precision::F32));
    }
    all
}

/// How a scene went: snapshots that were gone on from, or why there are none.
enum Went {
    Resumed(usize),
    HasNone(String),
}

/// Runs a scene from snapshot to snapshot, and each piece again in another simulation. Panics where they differ.
fn resume_at_every_snapshot(name: &str, scene: &SceneFile, options: &Options) -> Went {
    if scene.scene.is_static() {
        return Went::HasNone("a static analysis".into());
    }
    let start = || Simulation::new(scene, options);
    let mut whole = match start() {
        Ok(simulation) => simulation,
        Err(error) => return Went::HasNone(error.to_string()),
    };
    let elements =
        whole.world_mut().query::<&sinew::components::Block>().iter(whole.world()).map(|b| b.count as u64).sum::<u64>();
    let work = if options.backend == BackendChoice::Gpu { WORK.1 } else { WORK.0 };
    let steps = whole.planned_steps().min(work / elements.max(1)).max(SNAPSHOTS);
    let mut before = whole.snapshot().unwrap();
    let mut resumed = 0;
    // new for the first piece; then it has gone a step too far
    let mut other = start().unwrap();
    for number in 1..=SNAPSHOTS {
        let target = steps * number / SNAPSHOTS;
        let ended = whole.advance(target.saturating_sub(whole.step_count()));
        // through the bytes of a file
        other.restore(&Snapshot::from_bytes(&before.to_bytes().unwrap()).unwrap()).unwrap();
        let other_ended = other.advance(target.saturating_sub(other.step_count()));
        let told = |ended: &Result<(), sinew::Error>| ended.as_ref().err().map(ToString::to_string);
        let context = format!(
            "{name}, {:?} {:?}: gone on from step {} to {target}",
            options.backend,
            options.precision,
            before.step()
        );
        assert_eq!(told(&ended), told(&other_ended), "{context}: another end");
        if ended.is_err() {
            break;
        }
        let (now, again) = (whole.snapshot().unwrap(), other.snapshot().unwrap());
        if now.to_bytes().unwrap() != again.to_bytes().unwrap() {
            panic!("{context}: another state\n{}", now.differences(&again).join("\n"));
        }
        (before, resumed) = (now, resumed + 1);
        // how that ends is no matter
        let _ = other.advance(1);
    }
    Went::Resumed(resumed)
}

/// All scenes of a kind; at least so many must have snapshots.
fn all(scenes: Vec<(String, SceneFile)>, least: usize) {
    for options in options() {
        let mut counted = 0;
        // on a GPU, which may be one in software, every other one takes long enough
        let turns = if options.backend == BackendChoice::Gpu && scenes.len() > 2 * least { 2 } else { 1 };
        for (name, scene) in scenes.iter().step_by(turns) {
            match resume_at_every_snapshot(name, scene, &options) {
                Went::Resumed(count) => counted += usize::from(count > 0),
                Went::HasNone(why) => println!("{name}: left out: {}", why.lines().next().unwrap_or_default()),
            }
        }
        println!("{:?} {:?}: {counted} of {} scenes", options.backend, options.precision, scenes.len());
        assert!(counted >= least / turns, "only {counted} scenes have snapshots");
    }
}

fn in_folder(folder: &str, sets: &[&str]) -> Vec<(String, SceneFile)> {
    let folder = format!("{}/{folder}", env!("CARGO_MANIFEST_DIR"));
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let scenes = paths.into_iter().filter(|path| path.extension().is_some_and(|extension| extension == "ron"));
    scenes
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, SceneFile::load(&path, &sets).unwrap_or_else(|wrong| panic!("{}", wrong.render(false))))
        })
        .collect()
}

/// Who goes on from a state observes it once more, and so may any program.
#[test]
fn a_state_that_is_observed_again_is_checked_once() {
    let text = "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
        guards: (every: 10, off: [Energy]), integration: (step: 5e-4))";
    let scene = SceneFile::from_text("observed", text, Path::new("."), &[])
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    for options in options() {
        let start = || Simulation::new(&scene, &options).unwrap();
        let mut whole = start();
        whole.advance(20).unwrap();
        let checked = whole.guards();
        assert_eq!(checked.checks, 2, "{:?}", options.backend);
        let kept = Snapshot::from_bytes(&whole.snapshot().unwrap().to_bytes().unwrap()).unwrap();
        let mut other = start();
        other.restore(&kept).unwrap();
        for simulation in [&mut whole, &mut other] {
            for _ in 0..2 {
                simulation.observe().unwrap();
                assert_eq!(simulation.guards(), checked, "{:?}", options.backend);
            }
            simulation.advance(10).unwrap();
            assert_eq!(simulation.guards().checks, 3, "{:?}", options.backend);
        }
    }
}

#[test]
#[ignore = "long"]
fn shipped_scenes_resume_at_every_snapshot() {
    let mut scenes = in_folder("scenes", &[]);
    scenes.extend(in_folder("scenes/accuracy", &[]));
    all(scenes, 7);
}

#[test]
#[ignore = "long"]
fn hard_cases_resume_at_every_snapshot() {
    all(in_folder("scenes/hard", &[]), 25);
}

#[test]
#[ignore = "long"]
fn scenes_that_ended_wrongly_resume_at_every_snapshot() {
    all(in_folder("tests/endings", &[]), 6);
    let scaled = ["constraints[1].displacement=(0,0,-0.06)", "integration.when_unstable=ScaleMass(most: 1)"];
    let scenes = in_folder("tests/endings", &[]).into_iter().filter(|(name, _)| name == "resume_with_scaled_mass.ron");
    let path = format!("{}/tests/endings/resume_with_scaled_mass.ron", env!("CARGO_MANIFEST_DIR"));
    let scaled =
        SceneFile::load(path, &scaled.map(String::from)).unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    all(scenes.map(|(name, _)| (name, scaled.clone())).collect(), 1);
}
