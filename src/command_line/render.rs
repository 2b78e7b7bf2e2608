//! `sinew render`: pictures of an output folder, or of a scene that is run first where need be.

use super::arguments::{RenderArguments, allowed, default_folder};
use super::failure::Failure;
use super::run::{self, PICTURES, SCENE};
use super::terminal;
use super::{Outcome, progress};
use sinew::output::Lock;
use sinew::render::{Options, draw_with_progress};
use sinew::scene::schema::{Field, MeshSource, Picture};
use sinew::{Options as RunOptions, SceneFile};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Draws.
pub fn command(arguments: &RenderArguments) -> Outcome {
    let files = files(arguments)?;
    let (folder, picture, ended) = source(&arguments.what, arguments.allow_outside)?;
    let _lock = match files.iter().any(|(_, file)| file.is_none()) {
        true => Some(Lock::of_pictures(&folder, "sinew render")?),
        false => None,
    };
    for (animate, file) in files {
        let options = Options {
            field: arguments.field.clone().unwrap_or_else(|| field_name(picture.field).into()),
            from: arguments.from.unwrap_or_else(|| picture.from.as_vec3()),
            size: arguments.size.unwrap_or(picture.size),
            at: arguments.at,
            animate,
            out: file.unwrap_or_else(|| folder.join(PICTURES[usize::from(animate)])),
            range: None,
            edges: true,
        };
        draw(&folder, &options)?;
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

/// The folder to draw, how its scene wants to be drawn, and how the run ended where one was needed.
fn source(what: &Path, outside: bool) -> Result<(PathBuf, Picture, Outcome), Failure> {
    if what.is_dir() {
        if !what.join("sinew.json").exists() {
            let text = format!("{} is no output folder of sinew (it has no sinew.json)", what.display());
            return Err(Failure::Options(text));
        }
        let picture = SceneFile::load(what.join(SCENE), &[]).map(|scene| scene.scene.picture).unwrap_or_default();
        return Ok((what.to_path_buf(), picture, Ok(())));
    }
    let scene = SceneFile::load_allowing(what, &[], allowed(outside))?;
    let folder = default_folder(what);
    let picture = scene.scene.picture.clone();
    let Some(reason) = why_run(&scene, &folder) else {
        terminal::note(&format!("drawing {}, which is newer than the scene\n", folder.display()));
        return Ok((folder, picture, Ok(())));
    };
    terminal::note(&format!("running {} first: {reason}\n", what.display()));
    let (_, ended) = run::run(&scene, &RunOptions::default(), &folder, None)?;
    match ended {
        Err(Failure::Interrupted) => Err(Failure::Interrupted),
        // what was written until a breakdown can be seen, and often says why
        ended => Ok((folder, picture, ended)),
    }
}

/// Why a scene has to be run before it can be drawn.
fn why_run(scene: &SceneFile, folder: &Path) -> Option<String> {
    let changed = |path: &Path| fs::metadata(path).and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let drawn = folder.join("sinew.json");
    if !drawn.exists() || !folder.join("fields.pvd").exists() {
        return Some(format!("{} has no output of it", folder.display()));
    }
    let written = changed(&drawn);
    if changed(&scene.path) > written {
        return Some(format!("it has changed since {} was written", folder.display()));
    }
    let meshes = scene.scene.bodies.values().filter_map(|body| match &body.mesh {
        MeshSource::File { path, .. } => scene.file(path).ok(),
        _ => None,
    });
    let newer = meshes.into_iter().find(|mesh| changed(mesh) > written);
    newer.map(|mesh| format!("{} has changed since {} was written", mesh.display(), folder.display()))
}

fn draw(folder: &Path, options: &Options) -> Outcome {
    let bar = terminal::is_watched().then(|| progress::bar(0, "{bar:30} {percent:>3} %  {msg}"));
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
    let frames = match drawn.frames {
        1 => format!("t = {:.4} s", drawn.time),
        frames => format!("{frames} frames until t = {:.4} s", drawn.time),
    };
    terminal::say(&format!("{}  {}, {frames}\n", drawn.out.display(), options.field))
}

fn field_name(field: Field) -> &'static str {
    match field {
        Field::Displacement => "displacement",
        Field::Speed => "speed",
        Field::VonMises => "von_mises",
        Field::Pressure => "pressure",
        Field::VolumeRatio => "volume_ratio",
    }
}
