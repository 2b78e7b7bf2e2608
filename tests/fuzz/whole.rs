//! Whole runs of made-up scenes: what must hold of each, whatever it is.
//!
//! A run ends well or says why it did not; what it calls a result is finite, and no element of it is inside out that
//! must not be. The same bits come from any number of threads, from passes shared or apart, and from what goes on from
//! a snapshot. Other sums of forces, number types and backends agree but for rounding, where no threshold decides.

use crate::dice::Temper;
use crate::ended::{Run, near, same, whole_of};
use crate::solvers::Solvers;
use crate::{generate, number, sound};
use fastrand::Rng;
use glam::DVec3;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::{Precision, Scheme};
use sinew::output::Folder;
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation, Snapshot};
use std::collections::BTreeMap;
use std::path::Path;

/// Scenes of the everyday test; `SINEW_FUZZ_SCENES` says how many instead, `SINEW_FUZZ_SEED` where to begin.
const EVERYDAY: usize = 40;
/// Steps of a scene, and of some that are violent.
const STEPS: std::ops::Range<u64> = 8..120;
const MANY_STEPS: std::ops::Range<u64> = 120..600;
/// No more of any: steps may become many times smaller than the first.
pub const MOST_STEPS: u64 = 1500;
/// Changes that a run goes on from a snapshot after, and the step before which they are waited for.
const MOST_CHANGES: usize = 2;
const SOON: u64 = 100;
/// Scenes that are tried for a seed: many are refused, for sets without nodes, or elements that start inside out.
const TRIALS: u64 = 4;
/// One scene in so many runs on a GPU, too: a software device takes its time.
const GPU_ONE_IN: u64 = 13;

/// What ends a run in which contact between bodies went beyond the bound of its energy.
pub const CONTACT_MADE_ENERGY: &str = "more than its law can";

fn options(precision: Precision) -> Options {
    Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() }
}

fn file(text: &str, sets: &[String]) -> Result<SceneFile, String> {
    SceneFile::from_text("made", text, Path::new("."), sets).map_err(|wrong| wrong.render(false))
}

fn told(error: &Error) -> Result<String, String> {
    match error {
        // nothing that a scene says gives contact leave to make more energy than its law can
        Error::Unstable(broken) if broken.what.to_string().contains(CONTACT_MADE_ENERGY) => {
            Err(broken.what.to_string())
        }
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

fn start(scene: &SceneFile, options: &Options) -> Result<Simulation, String> {
    Simulation::new(scene, options).map_err(|error| format!("does not start: {error}"))
}

/// Runs to the end.
fn run(scene: &SceneFile, options: &Options) -> Result<Run, String> {
    let mut simulation = start(scene, options)?;
    let ended = simulation.advance_towards_end(MOST_STEPS);
    finished(&mut simulation, ended)
}

/// The same from snapshot to snapshot, each taken up by another simulation: at some steps, and where what is known of
/// the stable step has changed.
fn run_in_parts(scene: &SceneFile, options: &Options, whole: &Run, rng: &mut Rng) -> Result<Run, String> {
    let mut simulation = start(scene, options)?;
    let places = [rng.u64(1..5), rng.u64(1..=whole.steps.max(1)), whole.steps / 2, whole.steps.saturating_sub(1)];
    let mut known = what_is_known(&simulation);
    let mut changes = 0;
    let mut ended = Ok(());
    while ended.is_ok() && !simulation.is_finished() && simulation.step_count() < MOST_STEPS {
        let step = simulation.step_count();
        let until = places.iter().copied().filter(|place| *place > step).fold(MOST_STEPS, u64::min);
        // step by step as long as a change is waited for
        let waits = options.backend == BackendChoice::Cpu && changes < MOST_CHANGES && step < SOON;
        ended = simulation.advance_towards_end(if waits { 1 } else { until - step });
        let (step, knows) = (simulation.step_count(), what_is_known(&simulation));
        let changed = knows != known && changes < MOST_CHANGES;
        changes += usize::from(changed);
        if ended.is_ok() && (changed || places.contains(&step)) {
            let at_step = |what: String| format!("its own snapshot of step {step}: {what}");
            let bytes =
                simulation.snapshot().and_then(|kept| Ok(kept.to_bytes()?)).map_err(|e| at_step(e.to_string()))?;
            let kept = Snapshot::from_bytes(&bytes).map_err(|e| at_step(e.to_string()))?;
            simulation = start(scene, options)?;
            simulation.restore(&kept).map_err(|e| at_step(e.to_string()))?;
        }
        known = knows;
    }
    finished(&mut simulation, ended)
}

/// Runs into an output folder, as the command does. Of a run that broke down, what is left goes on from the last good
/// state just as it did; of any other, all can be written at the end but what is no number.
fn run_into_a_folder(scene: &SceneFile, options: &Options, whole: &Run) -> Result<(), String> {
    let place = tempfile::tempdir().map_err(|e| e.to_string())?;
    let mut folder = Folder::create(place.path()).map_err(|e| e.to_string())?;
    let mut simulation = start(scene, options)?;
    simulation.write_into(&mut folder).map_err(|e| e.to_string())?;
    let ended = simulation.observe().and_then(|()| simulation.advance_towards_end(MOST_STEPS));
    match ended {
        Ok(()) if whole.ended.is_ok() => {
            let finished = simulation.is_finished() && !scene.scene.is_static();
            let same = !finished || displacements(&mut simulation) == whole.displacements;
            if !same {
                return Err("into a folder: other displacements".into());
            }
            match simulation.write_nodes(&mut folder) {
                // what follows from finite displacements may still overflow: the forces of high powers of them
                Ok(()) | Err(Error::Unstable(_)) => Ok(()),
                Err(error) => Err(format!("at the end: {error}")),
            }
        }
        Ok(()) => Err(format!("into a folder: no end, and without: {:?}", whole.ended)),
        Err(Error::Unstable(broken)) => {
            let Some(good) = broken.last_good else { return Ok(()) };
            let kept = Snapshot::read(&place.path().join(&good.snapshot)).map_err(|e| format!("last state: {e}"))?;
            let mut other = start(scene, options)?;
            other.restore(&kept).map_err(|e| format!("last state: {e}"))?;
            let ended = other.advance_towards_end(MOST_STEPS.saturating_sub(other.step_count()));
            let other_end = finished(&mut other, ended)?;
            // of bodies that overlap only who draws pictures is warned
            let is_warned = other.guards().warnings.iter().any(|warning| warning.criterion == "overlap");
            let but_bytes = |run: &Run| Run { bytes: Vec::new(), ..whole_of(run) };
            match is_warned && whole.displacements == other_end.displacements {
                true => same("gone on from the last good state", &but_bytes(whole), &but_bytes(&other_end)),
                false => same("gone on from the last good state", whole, &other_end),
            }
        }
        Err(error) => told(&error).map(|_| ()),
    }
}

/// What changes when the step, masses or elements follow what is stable.
fn what_is_known(simulation: &Simulation) -> Option<(u64, u64, u64, f64)> {
    simulation.step_history().map(|seen| (seen.changes, seen.eigenvalue_estimates, seen.removed, seen.added_mass))
}

/// How a run ended, and whether what it calls a result is one.
fn finished(simulation: &mut Simulation, ended: Result<(), Error>) -> Result<Run, String> {
    let ended = match ended {
        Ok(()) => Ok(()),
        Err(error) => Err(told(&error)?),
    };
    // what is cut off says nothing yet
    if ended.is_ok() && simulation.is_finished() {
        sound::check(simulation)?;
    }
    let bytes = match simulation.scene().is_static() || ended.is_err() {
        true => Vec::new(),
        false => simulation.snapshot().and_then(|kept| Ok(kept.to_bytes()?)).map_err(|e| e.to_string())?,
    };
    let displacements = displacements(simulation);
    let (steps, time_step, time) = (simulation.step_count(), simulation.time_step(), simulation.time());
    let imbalance = simulation.guards().imbalance.abs();
    Ok(Run { ended, steps, time_step, time, bytes, displacements, imbalance })
}

/// What became of a scene.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Ending {
    Refused,
    Finished,
    BrokeDown,
}

/// What made-up scenes hold beside bodies, constraints and loads.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Plain,
    /// Tools, and what bodies do to each other.
    Surgery,
    /// Implicit steps, and rest by Newton's iterations.
    Solvers,
}

impl Kind {
    /// Seeds whose scenes found something once: those first.
    fn found_once(self) -> &'static [u64] {
        match self {
            // a run that went on from a snapshot had other bits, beside sharp edges
            Self::Surgery => &[20_000_000_372],
            _ => &[],
        }
    }
}

/// The scene of a seed, or where that is refused in words the first of some further ones that is not; `None` where all
/// are.
fn made_of(seed: u64, kind: Kind, rng: &mut Rng) -> Result<Option<(generate::Made, SceneFile)>, String> {
    for further in 0..TRIALS {
        if let Some(made) = one_of(seed + (further << 40), kind, rng)? {
            return Ok(Some(made));
        }
    }
    Ok(None)
}

/// The scene of a seed, as long as its steps make it; `None` where it is refused in words.
fn one_of(seed: u64, kind: Kind, rng: &mut Rng) -> Result<Option<(generate::Made, SceneFile)>, String> {
    // how long a step is tells what the scene lasts
    let begins = |scene: &SceneFile| match Simulation::new(scene, &options(Precision::F64)) {
        Ok(simulation) => Ok(Some(simulation.time_step())),
        // sets without nodes, laws that do not fit
        Err(Error::Scene(_)) => Ok(None),
        Err(error) => Err(format!("does not start: {error}")),
    };
    let surgery = kind == Kind::Surgery;
    let solvers = (kind == Kind::Solvers).then(|| Solvers::of(seed));
    let any = generate::scene(seed, 1.0, None, surgery);
    let first = file(&any.text, &[])?;
    let Some(stable) = begins(&first)? else { return Ok(None) };
    let steps = rng.u64(STEPS);
    let one_in = match any.temper {
        Temper::Mild | Temper::Late => 100,
        Temper::Wild => 5,
        Temper::Heavy => 2,
    };
    let steps = if any.temper != Temper::Mild && rng.u8(..one_in) == 0 { rng.u64(MANY_STEPS) } else { steps };
    let step = stable * solvers.as_ref().map_or(1.0, |solvers| solvers.longer);
    let duration = if first.scene.is_static() { 1.0 } else { step * steps as f64 };
    let mut made = generate::scene(seed, duration, Some(stable), surgery);
    if let Some(solvers) = solvers {
        made.text = solvers.put_into(&made.text, step, made.temper);
        // how far a solve goes, and whether a step is found, rounding may decide
        made.decides = true;
    }
    let scene = file(&made.text, &[])?;
    Ok(begins(&scene)?.map(|_| (made, scene)))
}

/// What is wrong with the scene of a seed, if anything.
fn attempt(seed: u64, kind: Kind, gpu: bool) -> Result<Ending, String> {
    let mut rng = Rng::with_seed(!seed);
    let Some((made, scene)) = made_of(seed, kind, &mut rng)? else { return Ok(Ending::Refused) };
    let mut of_precision = Vec::new();
    for precision in [Precision::F64, Precision::F32] {
        let options = options(precision);
        let whole = run(&scene, &options)?;
        same("with three threads", &whole, &run(&scene, &Options { threads: 3, ..options.clone() })?)?;
        let other_way = file(&made.text, &[format!("fuse={}", !scene.scene.fuse)])?;
        let apart = run(&other_way, &options)?;
        same(
            "shared passes the other way",
            &Run { bytes: Vec::new(), ..whole_of(&whole) },
            &Run { bytes: Vec::new(), ..apart },
        )?;
        if !scene.scene.is_static() {
            same("gone on from snapshots", &whole, &run_in_parts(&scene, &options, &whole, &mut rng)?)?;
        }
        if rng.u8(..4) == 0 {
            run_into_a_folder(&scene, &options, &whole)?;
        }
        if !made.decides {
            let two = run(&scene, &Options { scheme: Some(Scheme::TwoPass), ..options.clone() })?;
            near("in two passes", &whole, &two, if precision == Precision::F64 { 1e-6 } else { 0.05 })?;
        }
        of_precision.push(whole);
    }
    if !made.decides && !scene.scene.is_static() {
        near("in f32", &of_precision[0], &of_precision[1], 0.1)?;
    }
    if gpu {
        let options = Options { backend: BackendChoice::Gpu, ..options(Precision::F32) };
        let on_gpu = run(&scene, &options)?;
        if !made.decides && !scene.scene.is_static() {
            near("on the GPU", &of_precision[1], &on_gpu, 0.1)?;
        }
        if !scene.scene.is_static() {
            let in_parts = run_in_parts(&scene, &options, &on_gpu, &mut rng)?;
            same("on the GPU, gone on from snapshots", &on_gpu, &in_parts)?;
        }
    }
    Ok(if of_precision.iter().all(|run| run.ended.is_ok()) { Ending::Finished } else { Ending::BrokeDown })
}

#[test]
#[ignore = "long"]
fn made_up_scenes_keep_their_word() {
    try_scenes(Kind::Plain);
}

/// The same with tools, contact, attachments, suction and removal by tools.
#[test]
#[ignore = "long"]
fn made_up_surgery_keeps_its_word() {
    try_scenes(Kind::Surgery);
}

/// The same by implicit steps, and at rest by Newton's iterations.
#[test]
#[ignore = "long"]
fn made_up_solvers_keep_their_word() {
    try_scenes(Kind::Solvers);
}

fn try_scenes(kind: Kind) {
    let count = number("SINEW_FUZZ_SCENES", EVERYDAY) as u64;
    let first = number("SINEW_FUZZ_SEED", 0) as u64 * 1_000_000;
    let has_gpu = gpu_or_reason().is_some();
    let (mut found, mut endings) = (Vec::new(), BTreeMap::new());
    for seed in kind.found_once().iter().copied().chain(first..first + count) {
        // many take hours
        if seed > first && (seed - first).is_multiple_of(500) {
            println!("{} scenes, {} findings so far", seed - first, found.len());
        }
        let gpu = has_gpu && seed % GPU_ONE_IN == 0;
        let tried = std::panic::catch_unwind(|| attempt(seed, kind, gpu));
        let wrong = match tried {
            Ok(Ok(ending)) => {
                *endings.entry((Temper::of(seed), ending)).or_insert(0) += 1;
                continue;
            }
            Ok(Err(wrong)) => wrong,
            Err(panic) => {
                let said = panic.downcast_ref::<String>().cloned();
                format!("panics: {}", said.or(panic.downcast_ref::<&str>().map(|s| s.to_string())).unwrap_or_default())
            }
        };
        println!("seed {seed}: {wrong}");
        found.push(format!("seed {seed}: {wrong}"));
    }
    println!("{count} scenes, {} findings; {endings:?}", found.len());
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// One scene of a seed, to look at, and what becomes of it: `SINEW_FUZZ_SHOW=17 cargo test --test fuzz show --
/// --nocapture`; with `SINEW_FUZZ_SURGERY=1` with tools, with
/// `SINEW_FUZZ_SOLVERS=1` by implicit steps.
#[test]
fn show_a_scene() {
    let seed = number("SINEW_FUZZ_SHOW", 0) as u64;
    let kind = match (number("SINEW_FUZZ_SURGERY", 0), number("SINEW_FUZZ_SOLVERS", 0)) {
        (0, 0) => Kind::Plain,
        (0, _) => Kind::Solvers,
        _ => Kind::Surgery,
    };
    match made_of(seed, kind, &mut Rng::with_seed(!seed)).unwrap() {
        Some((made, _)) => println!("{}", made.text),
        None => println!("refused: {}", generate::scene(seed, 1.0, None, kind == Kind::Surgery).text),
    }
    let ending = attempt(seed, kind, false);
    println!("{ending:?}");
    ending.unwrap();
}
