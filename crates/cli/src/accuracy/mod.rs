//! `sinew accuracy`: what accuracy costs in time.

mod page;
mod reporter;

use super::arguments::{AccuracyArguments, BackendName, default_folder};
use super::failure::Failure;
use super::run::SCENE;
use super::terminal::{self, Paint};
use super::{Outcome, interrupt, progress};
use reporter::Reporter;
use sinew::backend::gpu::Choice;
use sinew::output::{Folder, OutputError, replace, summary};
use sinew::scene::schema::AccuracyReference;
use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};
use sinew_pictures::plot::{png, svg};
use sinew_studies::accuracy::engine::has_gpu;
use sinew_studies::accuracy::{Engine, Reference, Refusal, Settings, Study, TargetVerdict, files, plot, study, tables};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The error that is good enough when nobody says which.
const TARGET: f64 = 0.01;

/// Studies a scene, says what came out, writes it into a folder.
pub fn command(arguments: &AccuracyArguments) -> Outcome {
    let started = Instant::now();
    let file = arguments.scene.load()?;
    let diagnostics =
        progress::during("reading meshes, looking for mistakes", || Simulation::check(&file, &Registry::default()));
    if diagnostics.has_errors() {
        return Err(diagnostics.into());
    }
    terminal::aside(&diagnostics.render(Paint::of_stderr().is_on()));
    let path = arguments.out.clone().unwrap_or_else(|| accuracy_folder(&arguments.scene.scene));
    let mut folder = Folder::create_for(&path, &format!("sinew accuracy of {}", file.path.display()))?;
    let gpu = arguments.backend != BackendName::Cpu && has_gpu(&Choice::parse(&arguments.gpu));
    let mut engine = Engine::new(&file, arguments.options(), gpu, arguments.effects, interrupt::is_asked)
        .up_to(arguments.finest.unwrap_or(f64::INFINITY));
    interrupt::listen();
    let made = settings(arguments, &file, started, &mut engine)
        .and_then(|settings| study(&mut engine, &settings, &mut Reporter::default()).map_err(failure));
    interrupt::rest();
    let study = made?;
    let title = if file.scene.title.is_empty() { "a scene" } else { &file.scene.title };
    write(&study, &mut folder, &file, title, &command_line(arguments))?;
    terminal::say(&page::text(&study, title, &path, Paint::of_stdout()))?;
    ended(&study, arguments.target.or(file.scene.accuracy.target).is_some())
}

fn accuracy_folder(scene: &Path) -> PathBuf {
    let mut name = default_folder(scene).into_os_string();
    name.push("-accuracy");
    name.into()
}

/// How the command ends: only who names a target asks whether it is met.
fn ended(study: &Study, asked: bool) -> Outcome {
    match study.findings.verdict {
        _ if study.interrupted => Err(Failure::Interrupted),
        TargetVerdict::NotMet if asked => Err(Failure::TargetMissed),
        TargetVerdict::CannotTell if asked => Err(Failure::TargetUnclear),
        _ => Ok(()),
    }
}

fn failure(refusal: Refusal) -> Failure {
    match refusal {
        Refusal::Refused(why) => Failure::Options(why),
        Refusal::Broke(why) => Failure::Broke(why),
        Refusal::TooLong => Failure::Options("the scene could not even be read and prepared in its --budget".into()),
        Refusal::Interrupted => Failure::Interrupted,
    }
}

fn settings(
    arguments: &AccuracyArguments,
    file: &SceneFile,
    started: Instant,
    engine: &mut Engine<'_>,
) -> Result<Settings, Failure> {
    let wanted = &file.scene.accuracy;
    let mut paths = arguments.reference.clone();
    let mut reference = None;
    if paths.is_empty() {
        match &wanted.reference {
            AccuracyReference::SelfMade => {}
            AccuracyReference::Values(values) => reference = Some(Reference::of_values(values)),
            AccuracyReference::Files(files) => {
                let found: Result<Vec<_>, _> = files.iter().map(|path| file.file(path)).collect();
                paths = found.map_err(|outside| Failure::Options(outside.to_string()))?;
            }
        }
    }
    if !paths.is_empty() {
        let samples = engine.sample_count().map_err(failure)?;
        reference = Some(files::read(&paths, file.scene.duration, samples).map_err(Failure::Options)?);
    }
    // what is named on the command line is not what the scene speaks of
    if arguments.reference.is_empty() {
        reference = reference.map(|reference| reference.off_by(&wanted.uncertainty));
    }
    Ok(Settings {
        started,
        budget: arguments.budget,
        target: arguments.target.or(wanted.target).unwrap_or(TARGET),
        judged_by: arguments.by.clone().or_else(|| wanted.judged_by.clone()),
        reference,
    })
}

/// The command as somebody would type it again.
fn command_line(arguments: &AccuracyArguments) -> String {
    let mut line = format!("sinew accuracy {}", arguments.scene.scene.display());
    for set in &arguments.scene.set {
        line += &format!(" --set '{set}'");
    }
    line += &format!(" --budget {}s", arguments.budget);
    for path in &arguments.reference {
        line += &format!(" --reference {}", path.display());
    }
    if let Some(by) = &arguments.by {
        line += &format!(" --by {by}");
    }
    if let Some(finest) = arguments.finest {
        line += &format!(" --finest {finest}");
    }
    if arguments.effects {
        line += " --effects";
    }
    line
}

fn write(study: &Study, folder: &mut Folder, file: &SceneFile, title: &str, command: &str) -> Outcome {
    let drawing = plot::drawing(study, title);
    let picture = png(&drawing, 2.0).map_err(Failure::Plot)?;
    let mut files: Vec<(&str, Vec<u8>)> = vec![
        ("accuracy.csv", tables::csv(study).into_bytes()),
        ("accuracy.md", tables::markdown(study, title, command).into_bytes()),
        ("accuracy.svg", svg(&drawing).into_bytes()),
        ("accuracy.png", picture),
        (SCENE, file.text().as_bytes().to_vec()),
    ];
    if !study.findings.effects.is_empty() {
        files.push(("effects.csv", tables::effects_csv(study).into_bytes()));
    }
    for (name, bytes) in files {
        let path = folder.claim(name)?;
        replace(&path, |file| file.write_all(&bytes).map_err(OutputError::system("write", &path)))?;
    }
    summary::write(&folder.claim("accuracy.json")?, study)?;
    Ok(())
}
