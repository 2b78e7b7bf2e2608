//! `sinew run`: a scene to an output folder.

use super::arguments::{RunArguments, default_folder};
use super::failure::Failure;
use super::progress::{self, Progress};
use super::terminal::{self, Paint};
use super::wording::quantity;
use super::{Outcome, check, interrupt, report};
use sinew::output::{Folder, OutputError, replace, summary};
use sinew::scene::schema::InitialState;
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation, Snapshot, Summary};
use sinew_pictures::render::keep;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The scene as it was run, in the output folder.
pub const SCENE: &str = "scene.ron";
/// What `sinew render` leaves in the output folder; the next run clears it.
pub const PICTURES: [&str; 2] = ["picture.png", "animation.gif"];

/// Steps are taken in chunks of about this time, so that the bar moves and Ctrl-C is heard.
const CHUNK: Duration = Duration::from_millis(50);

/// Runs a scene and tells on stdout what it amounted to.
pub fn command(arguments: &RunArguments) -> Outcome {
    let scene = arguments.scene.load()?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene.scene));
    let (folder, from) = match &arguments.resume {
        None => (folder, None),
        Some(file) => {
            let folder = if arguments.out.is_some() { folder } else { with_suffix(&folder, "-resumed") };
            (beside(file, folder)?, Some(Snapshot::read(file)?))
        }
    };
    let mut options = arguments.how.options();
    if let Some(snapshot) = &from {
        // what a program holds in it stays held
        options.grabs |= Simulation::can_grab_in(snapshot)?;
    }
    let mut outcome = run(&scene, &options, &folder, from.as_ref());
    if let Some((cpu, why)) = after_the_gpu(&options, &outcome) {
        terminal::note(&format!("{why}\n`--backend auto` takes the CPU then, from the start\n"));
        outcome = run(&scene, &cpu, &folder, from.as_ref());
    }
    let (summary, ended) = outcome?;
    match arguments.json {
        false if terminal::is_quiet() => terminal::aside(&report::warnings_alone(&summary)),
        false => terminal::say(&report::text(&summary, &scene, &folder, Paint::of_stdout()))?,
        true => {
            let text = summary::text(&summary).map_err(|reason| Failure::Silent(std::io::Error::other(reason)))?;
            terminal::hand_out(&format!("{text}\n"))?;
        }
    }
    ended
}

/// How to run again what the GPU gave up and was not asked for, and what it said.
fn after_the_gpu(options: &Options, outcome: &Result<(Summary, Outcome), Failure>) -> Option<(Options, String)> {
    let (Err(failure) | Ok((_, Err(failure)))) = outcome else { return None };
    match failure {
        Failure::Engine(error) if options.backend == BackendChoice::Auto && matches!(**error, Error::GpuFailed(_)) => {
            Some((Options { backend: BackendChoice::Cpu, ..options.clone() }, error.to_string()))
        }
        _ => None,
    }
}

/// `out/cube` and `-resumed` are `out/cube-resumed`.
fn with_suffix(folder: &Path, suffix: &str) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_os_string();
    name.push(suffix);
    folder.with_file_name(name)
}

/// The folder to write into, if it is not the one that the snapshot lies in: that would be cleared.
fn beside(snapshot: &Path, folder: PathBuf) -> Result<PathBuf, Failure> {
    let canonical = |path: &Path| path.canonicalize().ok();
    let lies_in = canonical(snapshot).and_then(|path| path.parent().map(Path::to_path_buf));
    match lies_in.is_some() && lies_in == canonical(&folder) {
        true => Err(Failure::Options(format!(
            "{} lies in the folder that is to be written anew; name another with --out",
            snapshot.display()
        ))),
        false => Ok(folder),
    }
}

/// Runs a scene into a folder, from its start or from a snapshot: what it amounted to, and how it ended. An outer error
/// means that there is no summary.
pub fn run(
    scene: &SceneFile,
    options: &Options,
    path: &Path,
    from: Option<&Snapshot>,
) -> Result<(Summary, Outcome), Failure> {
    let made = progress::during("reading meshes, building the simulation", || Simulation::new(scene, options));
    let mut simulation = made?;
    terminal::aside(&simulation.warnings().render(Paint::of_stderr().is_on()));
    if let Some(snapshot) = from {
        go_on_from(snapshot, &mut simulation)?;
    }
    tell_of_inputs(&simulation);
    if from.is_none() && scene.scene.start != InitialState::Undeformed {
        interrupt::listen();
        let settled = progress::settle(&mut simulation);
        interrupt::rest();
        settled?;
    }
    let mut folder = Folder::create_for(path, &scene.path.display().to_string())?;
    for picture in PICTURES {
        folder.claim(picture)?;
    }
    let copy = folder.claim(SCENE)?;
    replace(&copy, |file| file.write_all(scene.text().as_bytes()).map_err(OutputError::system("write", &copy)))?;
    keep(scene, &mut folder)?;
    simulation.write_into(&mut folder)?;
    if terminal::is_verbose() {
        terminal::detail(&check::details(&mut simulation, path)?);
    }
    interrupt::listen();
    let ended = steps(&mut simulation, scene.scene.duration);
    let finished = finish(&mut simulation, &mut folder, ended);
    interrupt::rest();
    finished
}

/// Says what stays as it is because there is no program that would set it.
fn tell_of_inputs(simulation: &Simulation) {
    let inputs = simulation.inputs();
    let all: Vec<String> = inputs.iter().map(|input| format!("{} stays at {}", input.name, input.target)).collect();
    let ports: Vec<String> = simulation.ports().keys().cloned().collect();
    if !ports.is_empty() {
        let text = "nobody feeds it: a program does (docs/interaction.md), this command does not";
        terminal::note(&format!("{}: {text}\n", ports.join(", ")));
    }
    if !all.is_empty() {
        let text = "a program sets inputs while it runs (docs/interaction.md), this command does not";
        terminal::note(&format!("{}: {text}\n", all.join(", ")));
    }
}

/// Goes on from a snapshot, if there is anything left to do.
fn go_on_from(snapshot: &Snapshot, simulation: &mut Simulation) -> Outcome {
    simulation.restore(snapshot)?;
    if !simulation.is_finished() {
        return Ok(());
    }
    let (time, end) = (snapshot.time(), simulation.scene().duration);
    Err(Failure::Options(format!("the snapshot is of t = {time} s and the scene lasts until {end} s: nothing is left")))
}

/// Observes the start and takes all steps.
fn steps(simulation: &mut Simulation, duration: f64) -> Outcome {
    simulation.observe()?;
    let mut progress = Progress::begin(simulation.planned_steps(), duration, simulation.scene().is_static());
    let (mut chunk, mut changes) = (1, 0);
    let mut advance = || {
        // how many steps there are changes when the step does
        while !simulation.is_finished() && simulation.step_count() < simulation.planned_steps() {
            if interrupt::is_asked() {
                return Err(Failure::Interrupted);
            }
            let started = Instant::now();
            simulation.advance_towards_end(chunk)?;
            tell_of_changes(simulation, &mut changes);
            let share = CHUNK.as_secs_f64() / started.elapsed().as_secs_f64().max(1e-9);
            // at most four times more: a chunk without output says little of one with it
            chunk = ((chunk as f64 * share.clamp(0.1, 4.0)) as u64).clamp(1, 1 << 20);
            match simulation.equilibrium() {
                None => progress.tell(simulation.step_count(), simulation.planned_steps(), simulation.time()),
                Some(found) => progress.tell_residual(simulation.step_count(), found),
            }
        }
        Ok(())
    };
    let ended = advance();
    progress.end();
    ended
}

/// Says that the step has changed, where details are wanted.
fn tell_of_changes(simulation: &Simulation, known: &mut u64) {
    let changes = simulation.step_history().map_or(0, |history| history.changes);
    if changes != *known {
        *known = changes;
        let (step, time) = (quantity(simulation.time_step(), "s"), quantity(simulation.time(), "s"));
        terminal::detail(&format!("t = {time}: the step is {step}\n"));
    }
}

/// Writes what stands at the end: the nodes if their state means something, and the summary, which says of a result
/// that is no number what it says of a run that broke down.
fn finish(simulation: &mut Simulation, folder: &mut Folder, ended: Outcome) -> Result<(Summary, Outcome), Failure> {
    // a run that broke down ends in numbers that mean nothing, one that found no equilibrium, or was interrupted on the
    // way there, in none that was asked for; the fields hold the last good state
    let meaningless = |error: &Error| matches!(error, Error::Unstable(_) | Error::NotConverged(_));
    let is_on_the_way = simulation.equilibrium().is_some_and(|found| !found.reached);
    let ended = match ended {
        Err(Failure::Engine(error)) if meaningless(&error) => Err(Failure::Engine(error)),
        Err(Failure::Interrupted) if is_on_the_way => Err(Failure::Interrupted),
        ended => match simulation.write_nodes(folder) {
            Ok(()) => ended,
            Err(error) if meaningless(&error) => Err(error.into()),
            Err(error) => return Err(ended.err().unwrap_or_else(|| error.into())),
        },
    };
    let word = match &ended {
        Ok(()) => "finished".to_string(),
        Err(Failure::Interrupted) => "interrupted".to_string(),
        Err(Failure::Engine(error)) => error.to_string(),
        Err(_) => "failed".to_string(),
    };
    match (sum_up(simulation, folder, &word), ended) {
        (Ok(summary), ended) => Ok((summary, ended)),
        // what broke the run explains why it cannot be summed up
        (Err(_), Err(failure)) | (Err(failure), Ok(())) => Err(failure),
    }
}

/// Writes the summary.
fn sum_up(simulation: &mut Simulation, folder: &mut Folder, ended: &str) -> Result<Summary, Failure> {
    let summed = simulation.summary(ended)?;
    summary::write(&folder.claim("summary.json")?, &summed)?;
    Ok(summed)
}
