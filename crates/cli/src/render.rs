//! `sinew render`: pictures of an output folder, or of a scene that is run first where need be.

use super::arguments::{RenderArguments, allowed, default_folder};
use super::failure::Failure;
use super::modes::as_modes;
use super::run::{self, PICTURES, SCENE};
use super::terminal;
use super::{Outcome, progress};
use sinew::output::Lock;
use sinew::scene::schema::{Picture, Scene};
use sinew::scene::validate_picture;
use sinew::{Options as RunOptions, SceneFile};
use sinew_pictures::render::{RenderOptions, Tools, draw_with_progress};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Draws.
pub fn command(arguments: &RenderArguments) -> Outcome {
    let files = files(arguments)?;
    let (folder, mut picture, scene, ended) = source(arguments)?;
    let _lock = match files.iter().any(|(_, file)| file.is_none()) {
        true => Some(Lock::of_pictures(&folder, "sinew render")?),
        false => None,
    };
    picture.from = arguments.from.map_or(picture.from, |from| from.as_dvec3());
    picture.size = arguments.size.unwrap_or(picture.size);
    let tools = scene.filter(|_| picture.tools).map(|scene| tools_of(&scene, &folder)).unwrap_or_default();
    for (animate, file) in files {
        let out = file.unwrap_or_else(|| folder.join(PICTURES[usize::from(animate)]));
        let (field, at, tools) = (arguments.field.clone(), arguments.at, tools.clone());
        let options = RenderOptions { field, at, animate, tools, ..RenderOptions::new(picture.clone(), out) };
        draw(&folder, &as_modes(&folder, options)?)?;
    }
    ended
}

/// What to draw: whether it moves, and the file where it is named.
fn files(arguments: &RenderArguments) -> Result<Vec<(bool, Option<PathBuf>)>, Failure> {
    let Some(file) = &arguments.to else {
        let wanted = [(false, !arguments.animate), (true, !arguments.no_animation)];
        return Ok(wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(animate, _)| (animate, None)).collect());
    };
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("png") => Ok(vec![(false, Some(file.clone()))]),
        Some("gif") => Ok(vec![(true, Some(file.clone()))]),
        _ => Err(Failure::Options(format!("--to {}: a file name that ends in .png or .gif is wanted", file.display()))),
    }
}

/// The tools of a scene that was run into a folder; says which are left out.
fn tools_of(scene: &SceneFile, folder: &Path) -> Tools {
    let (tools, missing) = Tools::of_scene(scene, folder);
    missing.iter().for_each(|note| terminal::note(&format!("{note}\n")));
    tools
}

/// What is to be drawn: the folder, how its scene wants that, the scene if there is one, and how the run ended where
/// one was needed.
type RenderInput = (PathBuf, Picture, Option<SceneFile>, Outcome);

fn source(arguments: &RenderArguments) -> Result<RenderInput, Failure> {
    let what = &arguments.what;
    if what.is_dir() {
        let (picture, scene) = picture_of(what, &arguments.set)?;
        return Ok((what.clone(), picture, scene, Ok(())));
    }
    let scene = SceneFile::load_allowing(what, &arguments.set, allowed(arguments.allow_outside))?;
    let (folder, picture) = (default_folder(what), checked(&scene)?);
    let Some(reason) = why_run(&scene, &folder) else {
        terminal::note(&format!("drawing {}, which is of this scene\n", folder.display()));
        return Ok((folder, picture, Some(scene), Ok(())));
    };
    terminal::note(&format!("running {} first: {reason}\n", what.display()));
    let (_, ended) = run::run(&scene, &RunOptions::default(), &folder, None)?;
    match ended {
        Err(Failure::Interrupted) => Err(Failure::Interrupted),
        // what was written until a breakdown can be seen, and often says why
        ended => Ok((folder, picture, Some(scene), ended)),
    }
}

/// How the scene of an output folder wants to be drawn, with values put into that, and the scene if there is one.
fn picture_of(folder: &Path, set: &[String]) -> Result<(Picture, Option<SceneFile>), Failure> {
    if !folder.join("sinew.json").exists() {
        let text = format!("{} is no output folder of sinew (it has no sinew.json)", folder.display());
        return Err(Failure::Options(text));
    }
    let path = folder.join(SCENE);
    if set.is_empty() {
        // what is no run, a mesh for instance, has no scene
        let scene = SceneFile::load(path, &[]).ok();
        return Ok((scene.as_ref().map(|scene| scene.scene.picture.clone()).unwrap_or_default(), scene));
    }
    if !path.exists() {
        return Err(Failure::Options(format!("{} has no {SCENE} that --set could put a value into", folder.display())));
    }
    let (run, wanted) = (SceneFile::load(&path, &[])?, SceneFile::load(&path, set)?);
    match is_the_same_run(&run.scene, &wanted.scene) {
        true => Ok((checked(&wanted)?, Some(wanted))),
        false => Err(Failure::Options(format!(
            "--set: {} is drawn as it was run, and only its `picture` can be changed, such as picture.zoom=2; name the scene \
             to have it run with another value",
            folder.display()
        ))),
    }
}

/// The picture of a scene, if its values make sense.
fn checked(scene: &SceneFile) -> Result<Picture, Failure> {
    let mut found = scene.diagnostics();
    validate_picture(scene, &mut found);
    if found.has_errors() { Err(found.into()) } else { Ok(scene.scene.picture.clone()) }
}

/// Whether scenes differ in how they are drawn at most.
fn is_the_same_run(one: &Scene, other: &Scene) -> bool {
    let one = Scene { picture: other.picture.clone(), ..one.clone() };
    one == *other
}

/// Why a scene has to be run before it can be drawn.
fn why_run(scene: &SceneFile, folder: &Path) -> Option<String> {
    let changed = |path: &Path| fs::metadata(path).and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let drawn = folder.join("sinew.json");
    if !drawn.exists() || !folder.join("fields.pvd").exists() {
        return Some(format!("{} has no output of it", folder.display()));
    }
    let run = SceneFile::load(folder.join(SCENE), &[]);
    if !run.is_ok_and(|run| is_the_same_run(&run.scene, &scene.scene)) {
        return Some(format!("{} was written of another, or with other values", folder.display()));
    }
    let written = changed(&drawn);
    let named: Vec<String> = scene.named_files().iter().flat_map(|file| file.names()).collect();
    let mut files = named.iter().filter_map(|name| scene.file(name).ok());
    let newer = files.find(|file| changed(file) > written);
    newer.map(|file| format!("{} has changed since {} was written", file.display(), folder.display()))
}

fn draw(folder: &Path, options: &RenderOptions) -> Outcome {
    let bar = terminal::is_interactive().then(|| progress::bar(0, "{bar:30} {percent:>3} %  {msg}"));
    if let Some(bar) = &bar {
        bar.set_message(format!("drawing {}", options.out.display()));
    }
    let drawn = draw_with_progress(folder, options, &mut |done, all| {
        if let Some(bar) = &bar {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        }
    });
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    let drawn = drawn?;
    // what is no run has no times
    let last = if options.captions.is_empty() { format!("t = {:.4} s", drawn.time) } else { drawn.caption };
    let frames = match drawn.frames {
        1 => last,
        frames => format!("{frames} frames until {last}"),
    };
    let field = options.field.as_deref().unwrap_or(options.picture.field.array());
    terminal::say(&format!("{}  {field}, {frames}\n", drawn.out.display()))
}
