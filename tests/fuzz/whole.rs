//! Whole runs of made-up scenes: what must hold of each, whatever it is.
//!
//! A run ends well or says why it did not; what it calls a result is finite, and no element of it is inside out that must not
//! be. The same bits come from any number of threads, from passes shared or apart, and from what goes on from a snapshot.
//! Other sums of forces, number types and backends agree but for rounding, where no threshold decides.

use crate::generate;
use crate::number;
use glam::DVec3;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::{Authoring, Precision, Scheme};
use sinew::scene::schema::Inversion;
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation, Snapshot};
use std::path::Path;

/// Scenes of the everyday test; `SINEW_FUZZ_SCENES` says how many instead, `SINEW_FUZZ_SEED` where to begin.
const EVERYDAY: usize = 60;
/// Steps of a scene.
const STEPS: std::ops::Range<u64> = 8..120;
/// One scene in so many runs on a GPU, too: a software device takes its time.
const GPU_ONE_IN: u64 = 12;

fn options(precision: Precision) -> Options {
    Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() }
}

fn file(text: &str, sets: &[String]) -> Result<SceneFile, String> {
    SceneFile::from_text("made", text, Path::new("."), sets).map_err(|wrong| wrong.render(false))
}

/// How a run ended: its last state, or what was wrong.
struct Run {
    ended: Result<(), String>,
    bytes: Vec<u8>,
    displacements: Vec<DVec3>,
}

fn told(error: &Error) -> Result<String, String> {
    match error {
        // what was lost when is the same, what the message says of where it was kept is not
        Error::Unstable(broken) => Ok(format!("{} {} {}", broken.body, broken.step, broken.what)),
        Error::NotConverged(_) => Ok("not converged".into()),
        other => Err(format!("ends in {other}")),
    }
}

fn displacements(simulation: &mut Simulation) -> Vec<DVec3> {
    let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    bodies.iter().flat_map(|body| simulation.displacements(body).unwrap_or_default()).collect()
}

/// Runs to the end; with `resume`, half of it, and the rest in another simulation from the snapshot's bytes.
fn run(scene: &SceneFile, options: &Options, resume: bool) -> Result<Run, String> {
    let start = || Simulation::new(scene, options).map_err(|error| format!("does not start: {error}"));
    let mut simulation = start()?;
    let mut ended = Ok(());
    if resume {
        ended = simulation.advance_towards_end(simulation.planned_steps() / 2);
        if ended.is_ok() {
            let bytes = simulation.snapshot().and_then(|kept| Ok(kept.to_bytes()?)).map_err(|e| e.to_string())?;
            let mut other = start()?;
            let kept = Snapshot::from_bytes(&bytes).map_err(|e| format!("its own snapshot: {e}"))?;
            other.restore(&kept).map_err(|e| format!("its own snapshot: {e}"))?;
            simulation = other;
        }
    }
    let ended = ended.and_then(|()| simulation.finish());
    let ended = match ended {
        Ok(()) => Ok(()),
        Err(error) => Err(told(&error)?),
    };
    if ended.is_ok() {
        is_sound(&mut simulation)?;
    }
    let bytes = match scene.scene.is_static() || ended.is_err() {
        true => Vec::new(),
        false => simulation.snapshot().and_then(|kept| Ok(kept.to_bytes()?)).map_err(|e| e.to_string())?,
    };
    let displacements = displacements(&mut simulation);
    Ok(Run { ended, bytes, displacements })
}

/// Whether what is called a result is one: checked here anew, from positions alone.
fn is_sound(simulation: &mut Simulation) -> Result<(), String> {
    let summary = simulation.summary("finished").map_err(|e| e.to_string())?;
    let energies = summary.energies;
    for (name, value) in [
        ("kinetic", energies.kinetic),
        ("strain", energies.strain),
        ("hourglass", energies.hourglass),
        ("removed", energies.removed),
    ] {
        if !value.is_finite() {
            return Err(format!("status 0 with {value} J of {name} energy"));
        }
    }
    let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    for body in bodies {
        let (rest, moved) = (
            simulation.rest_positions(&body).map_err(|e| e.to_string())?,
            simulation.displacements(&body).map_err(|e| e.to_string())?,
        );
        if let Some(node) = moved.iter().position(|u| !u.is_finite()) {
            return Err(format!("status 0 with node {node} of {body} nowhere"));
        }
        let stops = simulation.scene().materials.values().all(|material| material.inversion() == Inversion::Stop);
        let removes = !simulation.scene().removal.is_empty()
            || simulation.scene().when_unstable() == sinew::scene::schema::WhenUnstable::Remove;
        if !stops || removes {
            continue;
        }
        let entity = simulation.body(&body).map_err(|e| e.to_string())?;
        let Some(authoring) = simulation.world().get::<Authoring>(entity) else { continue };
        for tet in &authoring.tets {
            let at = |set: &[DVec3], i: usize| set[tet[i] as usize];
            let six_volumes = |place: &dyn Fn(usize) -> DVec3| {
                (place(1) - place(0)).cross(place(2) - place(0)).dot(place(3) - place(0))
            };
            let (before, now) = (six_volumes(&|i| at(&rest, i)), six_volumes(&|i| at(&rest, i) + at(&moved, i)));
            // a volume that is nothing to rounding may have either sign
            if now / before < -1e-4 {
                return Err(format!("status 0 with an element inside out: J = {:.3e}", now / before));
            }
        }
    }
    Ok(())
}

/// The largest distance between two sets of displacements, as a share of the largest displacement.
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    let largest = a.iter().chain(b).fold(1e-9_f64, |most, u| most.max(u.length()));
    a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((*a - *b).length())) / largest
}

fn same(what: &str, a: &Run, b: &Run) -> Result<(), String> {
    if a.ended != b.ended {
        return Err(format!("{what}: {:?}, and without: {:?}", b.ended, a.ended));
    }
    if a.bytes != b.bytes {
        return Err(format!("{what}: other bits"));
    }
    Ok(())
}

fn near(what: &str, a: &Run, b: &Run, most: f64) -> Result<(), String> {
    if a.ended.is_err() || b.ended.is_err() {
        // near a limit rounding may decide
        return Ok(());
    }
    let apart = apart(&a.displacements, &b.displacements);
    if apart <= most { Ok(()) } else { Err(format!("{what}: displacements differ by {apart:.2e}")) }
}

/// What is wrong with the scene of a seed, if anything.
fn attempt(seed: u64, gpu: bool) -> Result<(), String> {
    // how long a step is tells what the scene lasts
    let known = options(Precision::F64);
    let first = file(&generate::scene(seed, 1.0).text, &[])?;
    let mut rng = fastrand::Rng::with_seed(!seed);
    let duration = match Simulation::new(&first, &known) {
        Ok(simulation) => simulation.time_step() * rng.u64(STEPS) as f64,
        // sets without nodes, laws that do not fit: refused, in words
        Err(Error::Scene(_)) => return Ok(()),
        Err(error) => return Err(format!("does not start: {error}")),
    };
    let made = generate::scene(seed, if first.scene.is_static() { 1.0 } else { duration });
    let scene = file(&made.text, &[])?;
    if Simulation::new(&scene, &known).is_err() {
        return Ok(());
    }
    let mut of_precision = Vec::new();
    for precision in [Precision::F64, Precision::F32] {
        let options = options(precision);
        let whole = run(&scene, &options, false)?;
        same("with three threads", &whole, &run(&scene, &Options { threads: 3, ..options.clone() }, false)?)?;
        let other_way = file(&made.text, &[format!("fuse={}", !scene.scene.fuse)])?;
        let apart = run(&other_way, &options, false)?;
        same(
            "shared passes the other way",
            &Run { bytes: Vec::new(), ..whole_of(&whole) },
            &Run { bytes: Vec::new(), ..apart },
        )?;
        if !scene.scene.is_static() {
            same("gone on from a snapshot", &whole, &run(&scene, &options, true)?)?;
        }
        if !made.decides {
            let two = run(&scene, &Options { scheme: Scheme::TwoPass, ..options.clone() }, false)?;
            near("in two passes", &whole, &two, if precision == Precision::F64 { 1e-6 } else { 0.05 })?;
        }
        of_precision.push(whole);
    }
    if !made.decides && !scene.scene.is_static() {
        near("in f32", &of_precision[0], &of_precision[1], 0.1)?;
    }
    if gpu {
        let options = Options { backend: BackendChoice::Gpu, ..options(Precision::F32) };
        let on_gpu = run(&scene, &options, false)?;
        if !made.decides && !scene.scene.is_static() {
            near("on the GPU", &of_precision[1], &on_gpu, 0.1)?;
        }
        if !scene.scene.is_static() {
            same("on the GPU, gone on from a snapshot", &on_gpu, &run(&scene, &options, true)?)?;
        }
    }
    Ok(())
}

fn whole_of(run: &Run) -> Run {
    Run { ended: run.ended.clone(), bytes: run.bytes.clone(), displacements: run.displacements.clone() }
}

#[test]
fn made_up_scenes_keep_their_word() {
    let count = number("SINEW_FUZZ_SCENES", EVERYDAY) as u64;
    let first = number("SINEW_FUZZ_SEED", 0) as u64 * 1_000_000;
    let has_gpu = gpu_or_reason().is_some();
    let mut found = Vec::new();
    for seed in first..first + count {
        let gpu = has_gpu && seed % GPU_ONE_IN == 0;
        let tried = std::panic::catch_unwind(|| attempt(seed, gpu));
        let wrong = match tried {
            Ok(Ok(())) => continue,
            Ok(Err(wrong)) => wrong,
            Err(panic) => {
                let said = panic.downcast_ref::<String>().cloned();
                format!("panics: {}", said.or(panic.downcast_ref::<&str>().map(|s| s.to_string())).unwrap_or_default())
            }
        };
        println!("seed {seed}: {wrong}");
        found.push(format!("seed {seed}: {wrong}"));
    }
    println!("{count} scenes, {} findings", found.len());
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// One scene of a seed, to look at: `SINEW_FUZZ_SHOW=17 cargo test --test fuzz show -- --nocapture`.
#[test]
fn show_a_scene() {
    let seed = number("SINEW_FUZZ_SHOW", 0) as u64;
    let text = generate::scene(seed, 1.0).text;
    println!("{text}");
    file(&text, &[]).unwrap();
}
