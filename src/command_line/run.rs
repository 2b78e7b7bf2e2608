//! `sinew run`: a scene to an output folder.

use super::arguments::{RunArguments, default_folder};
use super::failure::Failure;
use super::progress::{self, Progress};
use super::terminal::{self, Paint};
use super::{Outcome, interrupt, report};
use sinew::output::{Folder, OutputError, replace, summary};
use sinew::{Error, Options, SceneFile, Simulation, Summary};
use std::io::Write;
use std::path::Path;
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
    let (summary, ended) = run(&scene, &arguments.how.options(), &folder)?;
    terminal::say(&report::text(&summary, &scene, &folder, Paint::of_stdout()))?;
    ended
}

/// Runs a scene into a folder: what it amounted to, and how it ended. An outer error means that there is no summary.
pub fn run(scene: &SceneFile, options: &Options, path: &Path) -> Result<(Summary, Outcome), Failure> {
    let made = progress::during("reading meshes, building the simulation", || Simulation::new(scene, options));
    let mut simulation = made?;
    terminal::aside(&simulation.warnings().render(Paint::of_stderr().is_on()));
    let mut folder = Folder::create(path)?;
    for picture in PICTURES {
        folder.claim(picture)?;
    }
    let copy = folder.claim(SCENE)?;
    replace(&copy, |file| file.write_all(scene.text().as_bytes()).map_err(OutputError::system("write", &copy)))?;
    simulation.write_into(&mut folder)?;
    interrupt::listen();
    let ended = steps(&mut simulation, scene.scene.duration);
    let finished = finish(&mut simulation, &mut folder, &ended);
    interrupt::rest();
    match (ended, finished) {
        (ended, Ok(summary)) => Ok((summary, ended)),
        // what broke the run explains why it cannot be summed up
        (Err(failure), Err(_)) => Err(failure),
        (Ok(()), Err(failure)) => Err(failure),
    }
}

/// Observes the start and takes all steps.
fn steps(simulation: &mut Simulation, duration: f64) -> Outcome {
    simulation.observe()?;
    let all = simulation.planned_steps();
    let mut progress = Progress::begin(all, duration, simulation.scene().is_static());
    let mut chunk = 1;
    let mut advance = || {
        while !simulation.is_finished() && simulation.step_count() < all {
            if interrupt::is_asked() {
                return Err(Failure::Interrupted);
            }
            let started = Instant::now();
            simulation.advance(chunk.min(all - simulation.step_count()))?;
            let share = CHUNK.as_secs_f64() / started.elapsed().as_secs_f64().max(1e-9);
            // at most four times more: a chunk without output says little of one with it
            chunk = ((chunk as f64 * share.clamp(0.1, 4.0)) as u64).clamp(1, 1 << 20);
            match simulation.equilibrium() {
                None => progress.tell(simulation.step_count(), all, simulation.time()),
                Some(found) => progress.tell_residual(simulation.step_count(), found),
            }
        }
        Ok(())
    };
    let ended = advance();
    progress.end();
    ended
}

/// Writes what stands at the end: the summary, and the nodes if their state means something.
fn finish(simulation: &mut Simulation, folder: &mut Folder, ended: &Outcome) -> Result<Summary, Failure> {
    let word = match ended {
        Ok(()) => "finished".to_string(),
        Err(Failure::Interrupted) => "interrupted".to_string(),
        Err(Failure::Engine(error)) => error.to_string(),
        Err(_) => "failed".to_string(),
    };
    let summed = simulation.summary(&word)?;
    // a run that broke down ends in numbers that mean nothing, one that found no equilibrium in none that was asked for;
    // the fields hold the last good state
    let meaningless = |error: &Error| matches!(error, Error::Unstable(_) | Error::NotConverged(_));
    if !matches!(ended, Err(Failure::Engine(error)) if meaningless(error)) {
        simulation.write_nodes(folder)?;
    }
    summary::write(&folder.claim("summary.json")?, &summed)?;
    Ok(summed)
}
