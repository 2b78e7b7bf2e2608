//! Tools that move freely: whether they weigh something, and what they cannot do. Tools that give way to copies.

use super::{Validator, scene, show};
use crate::scene::load_parts::{LoadParts, On};
use crate::scene::schema::{Attachment, Contact, Follow, Free, InitialState, Load, Scene, Shape, Tool};
use crate::scene::syntax::Path;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    for (name, tool) in &scene_.tools {
        let Some(free) = &tool.free else { continue };
        let path = scene("tools").name(name).name("free");
        weight(validator, &path, tool, free);
        validator.not_negative(&path.name("damping"), free.damping, "1/s");
        guided(validator, &path, tool);
        weightless(scene_, validator, &path, name);
        let guides = "a free tool touches, and does no more: let a tool with a `path` do that";
        let used = [
            ("takes elements", scene_.removal.iter().any(|removal| removal.when.tool() == Some(name))),
            ("sucks", scene_.suction.iter().any(|suction| suction.tool == *name)),
            ("grasps", scene_.attachments.iter().filter_map(Attachment::tool).any(|tool| tool == name)),
        ];
        for (does, _) in used.into_iter().filter(|(_, used)| *used) {
            validator.out.error_at(&path, format!("`{name}` is `free`, and {does}")).note(guides);
        }
        if scene_.is_static() || matches!(scene_.start, InitialState::Equilibrium(_)) {
            let what = if scene_.is_static() { "a static analysis" } else { "`start: Equilibrium()`" };
            validator
                .out
                .error_at(&path, format!("{what} has no free tools: what rests on tissue depends on the way there"))
                .note("leave `free` out, or let it come to rest in time, with `damping`");
        }
    }
    shared(scene_, validator);
}

/// Refuses tools that give way to what the copies of a body do to them, who have nothing in common.
fn shared(scene_: &Scene, validator: &mut Validator) {
    let contacts = scene_.contacts.iter().enumerate().filter_map(|(number, contact)| match contact {
        Contact::Tool { tool, body, .. } => Some((scene("contacts").index(number), tool, body)),
        _ => None,
    });
    let grasps = scene_.attachments.iter().enumerate().filter_map(|(number, attachment)| match attachment {
        Attachment::Grasp { tool, body, .. } => Some((scene("attachments").index(number), tool, body)),
        _ => None,
    });
    for (path, name, body) in contacts.chain(grasps) {
        if let Some(how) = scene_.tools.get(name).and_then(|tool| gives_way(scene_, tool)) {
            super::suction::of_copies(scene_, validator, &path, body, &format!("the tool `{name}`, which {how},"));
        }
    }
}

/// How a tool gives way to what it meets, if it does.
fn gives_way(scene_: &Scene, tool: &Tool) -> Option<&'static str> {
    if tool.free.is_some() {
        return Some("is `free`");
    }
    // at rest no hand moves it
    let follow = tool.port.as_ref().filter(|_| !scene_.is_static()).map(|port| port.follow);
    matches!(follow, Some(Follow::Proxy { .. })).then_some("follows its port as a `Proxy`")
}

/// How heavy it is.
fn weight(validator: &mut Validator, path: &Path, tool: &Tool, free: &Free) {
    let either = "a free tool has either a `mass` (kg) or a `density` (kg/m³)";
    match (free.mass, free.density) {
        (Some(mass), None) => validator.above_zero(&path.name("mass"), mass, "kg"),
        (None, Some(density)) => validator.above_zero(&path.name("density"), density, "kg/m³"),
        (Some(_), Some(_)) => {
            validator.out.error_at(path.name("density"), "a `density` beside a `mass`").note(either);
        }
        (None, None) => {
            validator.out.error_at(path, "how heavy is it?").note(either);
        }
    }
    if tool.shape == Some(Shape::Plane {}) {
        validator
            .out
            .error_at(path, "a plane has no end: it cannot move freely")
            .note("take a `Box`, which is one below");
    }
    let Some(inertia) = free.inertia else { return };
    let path = path.name("inertia");
    let [x, y, z] = inertia.to_array();
    let least = inertia.min_element();
    if least <= 0.0 {
        validator.must(&path, "above 0 kg m² along each axis", show(least));
    } else if 2.0 * inertia.max_element() > (x + y + z) * (1.0 + 1e-9) {
        validator
            .out
            .error_at(&path, "no body has such moments of inertia: one of them is more than the other two together")
            .note("left out, they are those of the shape, filled evenly");
    }
}

/// Weight of single bodies is none of tools.
fn weightless(scene_: &Scene, validator: &mut Validator, path: &Path, name: &str) {
    let all = scene_.loads.iter().map(Load::parts);
    let of_bodies: Vec<LoadParts<'_>> = all.filter(|load| matches!(load.on, On::Bodies(_))).collect();
    if let Some(LoadParts { word, .. }) = of_bodies.first().filter(|_| of_bodies.iter().all(|load| load.body.is_some()))
    {
        validator
            .out
            .warn_at(path, format!("`{name}` has no weight: `{word}` acts on bodies that are named"))
            .note(format!("`{word}` without `body` acts on all bodies, and on free tools"));
    }
}

/// What moves it otherwise.
fn guided(validator: &mut Validator, path: &Path, tool: &Tool) {
    let others = [
        ("path", !tool.path.is_empty()),
        ("moves", !tool.moves.is_empty()),
        ("pivot", tool.pivot.is_some()),
        ("port", tool.port.is_some()),
    ];
    for (field, _) in others.into_iter().filter(|(_, there)| *there) {
        validator
            .out
            .error_at(path, format!("`free` beside `{field}`: what moves freely is not guided"))
            .note("leave one of both out; `at` and `rotation` say where it is at first");
    }
}
