//! Names: every body and material that is named must exist, and names must do as names of files and columns.

use super::{Validator, scene};
use crate::scene::load::SceneFile;
use crate::scene::schema::{Constraint, LoadParts, Scene};
use crate::scene::suggest::{choice, list};
use crate::scene::syntax::Path;

pub(super) fn validate(file: &SceneFile, validator: &mut Validator) {
    let scene_ = &file.scene;
    let parts = file.parts();
    if scene_.bodies.is_empty() {
        validator
            .out
            .error_at(scene("bodies"), "the scene has no body")
            .note("a body: \"cube\": (mesh: ..., material: ...)");
    }
    materials(scene_, validator);
    bodies(scene_, validator);
    for name in scene_.bodies.keys() {
        fits(validator, &scene("bodies").name(name), ("body", FILES), own(name, &parts));
    }
    for name in scene_.probes.keys() {
        fits(validator, &scene("probes").name(name), ("probe", FILES), own(name, &parts));
    }
    for name in scene_.tools.keys() {
        fits(validator, &scene("tools").name(name), ("tool", "programs and tables know it by that"), own(name, &parts));
    }
    if scene_.schedule.as_ref().is_some_and(Vec::is_empty) {
        validator
            .out
            .error_at(scene("schedule"), "the schedule is empty: nothing would happen")
            .note("leave `schedule` out to have it derived from the scene");
    }
}

/// The names of all materials that a body uses, each with the place that names it.
fn used(scene_: &Scene) -> Vec<(Path, &String)> {
    let mut used = Vec::new();
    for (name, body) in &scene_.bodies {
        let path = scene("bodies").name(name);
        used.push((path.name("material"), &body.material));
        for (i, region) in body.regions.iter().enumerate() {
            used.push((path.name("regions").index(i).name("material"), &region.material));
        }
    }
    used
}

fn materials(scene_: &Scene, validator: &mut Validator) {
    let used = used(scene_);
    for (path, name) in &used {
        if !scene_.materials.contains_key(*name) {
            let materials = scene_.materials.keys().map(String::as_str);
            validator.out.error_at(path, format!("there is no material `{name}`")).notes(choice(name, materials));
        }
    }
    for name in scene_.materials.keys() {
        if !used.iter().any(|(_, used)| *used == name) {
            validator.out.warn_at(scene("materials").name(name), format!("no body uses the material `{name}`"));
        }
    }
}

fn bodies(scene_: &Scene, validator: &mut Validator) {
    for (i, constraint) in scene_.constraints.iter().enumerate() {
        let (Constraint::Fixed { body, .. } | Constraint::Prescribed { body, .. }) = constraint;
        body_named(scene_, validator, &scene("constraints").index(i), body.as_ref());
    }
    for (i, load) in scene_.loads.iter().enumerate() {
        let LoadParts { body, on, .. } = load.parts();
        // what acts on whole bodies is for all of them, where it names none
        if on.select().is_some() || body.is_some() {
            body_named(scene_, validator, &scene("loads").index(i), body);
        }
    }
    for (name, system) in &scene_.systems {
        if system.body.is_some() {
            body_named(scene_, validator, &scene("systems").name(name), system.body.as_ref());
        }
    }
    for (i, removal) in scene_.removal.iter().enumerate() {
        let path = scene("removal").index(i);
        match removal.when.tool() {
            Some(tool) => touched(scene_, validator, &path, removal.body.as_ref(), |body| {
                format!("(body: \"{body}\", when: InTool(tool: \"{tool}\", ...))")
            }),
            None => body_named(scene_, validator, &path, removal.body.as_ref()),
        }
    }
    for (name, probe) in scene_.probes.iter().filter(|(_, probe)| !probe.what.is_of_no_body() || probe.body.is_some()) {
        body_named(scene_, validator, &scene("probes").name(name), probe.body.as_ref());
    }
}

pub(super) fn body_named(scene_: &Scene, validator: &mut Validator, owner: &Path, body: Option<&String>) {
    let path = owner.name("body");
    let bodies: Vec<&str> = scene_.bodies.keys().map(String::as_str).collect();
    match body {
        Some(name) if !scene_.bodies.contains_key(name) => {
            validator.out.error_at(path, format!("there is no body `{name}`")).notes(choice(name, bodies));
        }
        None if bodies.len() > 1 => {
            validator
                .out
                .error_at(path, format!("which body? The scene has {}", bodies.len()))
                .label("needs `body`")
                .note(format!("bodies: {}", list(&bodies)));
        }
        _ => {}
    }
}

/// A body at which a tool does something. An instrument that is a part cannot name a body outside of it: it is told
/// where `entry` can, which is what stands there of a body of that name.
pub(super) fn touched(
    scene_: &Scene,
    validator: &mut Validator,
    owner: &Path,
    body: Option<&String>,
    entry: impl Fn(&str) -> String,
) {
    let meant = match body {
        None if scene_.bodies.len() > 1 => scene_.bodies.keys().next().cloned(),
        Some(name) if !scene_.bodies.contains_key(name) => outside(scene_, name),
        _ => None,
    };
    let Some(meant) = meant.filter(|_| validator.out.is_of_part(owner)) else {
        return body_named(scene_, validator, owner, body);
    };
    let bodies: Vec<&str> = scene_.bodies.keys().map(String::as_str).collect();
    let message = match body {
        Some(name) => format!("there is no body `{name}`"),
        None => format!("which body? The scene has {}", bodies.len()),
    };
    validator
        .out
        .error_at(owner.name("body"), message)
        .note("no part names a body outside of it: leave this entry out of the part, and write it in the scene around")
        .note(format!("there: {}; bodies: {}", entry(&meant), list(&bodies)));
}

/// The body outside of a part whose name stands in it, and so has got the names of the part and of those around it in
/// front: `head.c`, or `c`, of `head.probe.c`.
fn outside(scene_: &Scene, name: &str) -> Option<String> {
    let words: Vec<&str> = name.split('.').collect();
    let without = |from: usize, to: usize| [&words[..from], &words[to..]].concat().join(".");
    let all = (0..words.len()).rev().flat_map(|from| (from + 1..words.len()).map(move |to| (from, to)));
    all.map(|(from, to)| without(from, to)).find(|name| scene_.bodies.contains_key(name))
}

/// The name that something has in its part.
fn own<'a>(name: &'a str, parts: &[(&str, &str)]) -> &'a str {
    let of_a_part = name.split_once('.').is_some_and(|(first, _)| parts.iter().any(|(part, _)| *part == first));
    if of_a_part { name.rsplit('.').next().unwrap_or(name) } else { name }
}

/// Why names of bodies and probes must fit.
const FILES: &str = "files are named after it";

/// Names become names of files and of columns of tables, and words of commands: of what, and why.
fn fits(validator: &mut Validator, path: &Path, (what, why): (&str, &str), name: &str) {
    let notes = "letters, digits, _ and - do everywhere";
    // what is refused here, an output folder refuses too
    let is_usual = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-' | '.' | ' ');
    if name.is_empty() || name.starts_with('.') || !name.chars().all(is_usual) {
        validator.out.error_at(path, format!("the {what} `{name}` needs another name: {why}")).note(notes);
    } else if !name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
        validator
            .out
            .warn_at(path, format!("the name of the {what} `{name}` is awkward in files and tables"))
            .note(notes);
    }
}
