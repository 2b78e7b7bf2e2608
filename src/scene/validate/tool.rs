//! Tools and contacts: whether they are somewhere, go somewhere, and touch something.

use super::geometry::{TOOLS, named_file};
use super::names::{body_named, touched};
use super::{Validator, friction, scene, select, show};
use crate::math::turned;
use crate::scene::limits::{MOST_BURST, MOST_SWEEPS, MOST_TURNS, TOOLS_OF_A_BODY};
use crate::scene::load::SceneFile;
use crate::scene::schema::{Contact, ContactLaw, Follow, Port, Removal, Scene, Threshold, Tool, When};
use crate::scene::suggest::choice;
use crate::scene::syntax::Path;
use crate::tools::closest_approach;
use glam::DVec3;
use std::collections::BTreeMap;

/// How near a tool's origin may come to its pivot (m).
const NEAREST: f64 = 1e-9;

/// By how much a tool may be turned for its axis to go through its pivot (degrees).
const MOST_TURNED: f64 = 120.0;

pub(super) fn validate(file: &SceneFile, validator: &mut Validator) {
    let scene_ = &file.scene;
    for (name, found) in &scene_.tools {
        let path = scene("tools").name(name);
        geometry(file, validator, &path, found);
        tool(file, validator, &path, found);
        if let Some(found) = &found.port {
            port(scene_, validator, name, &path.name("port"), found);
        }
        if !scene_.uses(name) {
            validator
                .out
                .warn_at(&path, format!("nothing touches the tool `{name}`"))
                .note(format!("under `contacts`: Tool(tool: \"{name}\")"));
        }
    }
    contacts(scene_, validator);
    takers(scene_, validator);
    super::suction::suction(scene_, validator);
}

fn geometry(file: &SceneFile, validator: &mut Validator, path: &Path, tool: &Tool) {
    let one_of = "a tool has either a `shape` or a `mesh`";
    match (&tool.shape, &tool.mesh) {
        (Some(shape), None) => {
            if let Some(problem) = shape.problem(tool.rounding) {
                let rounding = problem.field == "rounding";
                let path = if rounding { path.name("rounding") } else { path.name("shape").name(problem.field) };
                validator.out.error_at(path, problem.message);
            }
        }
        (None, Some(mesh)) => {
            let path_of = path.name("mesh");
            named_file(file, validator, &path_of.name("path"), &mesh.path, &TOOLS);
            validator.above_zero(&path_of.name("scale"), mesh.scale, "");
            if let Some(spacing) = mesh.spacing {
                validator.above_zero(&path_of.name("spacing"), spacing, "m");
            }
            if tool.rounding != 0.0 {
                validator.out.error_at(path.name("rounding"), "a mesh is not rounded").note("leave `rounding` out");
            }
        }
        (Some(_), Some(_)) => {
            validator.out.error_at(path.name("mesh"), "a `mesh` beside a `shape`").note(one_of);
        }
        (None, None) => {
            validator.out.error_at(path, "the tool has no `shape`").note(one_of);
        }
    }
}

fn tool(file: &SceneFile, validator: &mut Validator, path: &Path, tool: &Tool) {
    let way = path.name("path");
    if tool.path.is_empty() && way.find(&file.tree().root).is_ok() {
        validator.out.error_at(way, "the path has no places").note("leave `path` out: `at` says where the tool is");
    }
    for (field, there) in [("at", tool.at.is_some()), ("rotation", tool.rotation.is_some())] {
        if there && !tool.path.is_empty() {
            let message = format!("`{field}` beside a `path`, which says where the tool is at all times");
            validator
                .out
                .error_at(path.name(field), message)
                .note("leave one of both out; `moves` may be added to a path");
        }
    }
    for (number, pair) in tool.path.windows(2).enumerate() {
        if pair[1].t <= pair[0].t {
            let path = path.name("path").index(number + 1).name("t");
            let message =
                format!("places are in the order of time: after {} s this is {} s", show(pair[0].t), show(pair[1].t));
            let far = (pair[1].at - pair[0].at).length();
            let jumps = pair[1].t == pair[0].t && far > 0.0;
            let note = format!("the tool would jump by {} m; give it time to go there", show(far));
            validator.out.error_at(path, message).notes(jumps.then_some(note));
        }
    }
    let turns = tool.path.windows(2).map(|pair| pair[0].rotation.distance(pair[1].rotation)).sum::<f64>() / 360.0;
    if turns > MOST_TURNS {
        let message = format!("the tool turns {turns:.0} times on its way: {MOST_TURNS} are allowed");
        validator
            .out
            .error_at(path.name("path"), message)
            .note("`moves` with a `curve` may turn it as often as it is to");
    } else if let Some(pivot_) = tool.pivot {
        pivot(validator, &path.name("pivot"), tool, pivot_);
    }
    for (number, part) in tool.moves.iter().enumerate() {
        if (part.displacement, part.rotation) == (DVec3::ZERO, DVec3::ZERO) {
            validator
                .out
                .warn_at(path.name("moves").index(number), "this moves nothing")
                .note("give `displacement` or `rotation`");
        }
    }
}

/// Whether a shaft can go through a point all the time.
fn pivot(validator: &mut Validator, path: &Path, tool: &Tool, point: DVec3) {
    if tool.port.is_some() {
        validator
            .out
            .error_at(path, "a `pivot` beside a `port`: a hand turns the tool")
            .note("leave one of both out; `path` and `moves` go with a `pivot`");
    }
    let places: Vec<DVec3> = tool.places().iter().map(|place| place.at).collect();
    let moves: Vec<(DVec3, [f64; 2])> = tool.moves.iter().map(|part| (part.displacement, part.curve.range())).collect();
    if closest_approach(&places, &moves, point) < NEAREST {
        validator
            .out
            .error_at(path, "the tool's origin may come to its pivot: which way would its axis point there?")
            .note("the axis z goes from the origin, the tip of what is long, through the pivot");
        return;
    }
    for place in tool.places() {
        let axis = turned(place.rotation) * DVec3::Z;
        let turns = turns_across(tool, axis);
        let angle = axis.angle_between(point - place.at).to_degrees() + turns;
        if angle > MOST_TURNED {
            let most = if turns > 0.0 { "up to " } else { "" };
            let what = format!("the tool would be turned by {most}{angle:.0} degrees for its axis to go through this");
            validator
                .out
                .error_at(path, what)
                .note(format!("{MOST_TURNED} degrees are allowed: there are two ways to turn it half round"))
                .note("let `rotation` point its axis z, from the tip along the shaft, about that way");
            return;
        }
    }
}

/// By how many degrees moves may turn an axis at most: about what it goes along they do not.
fn turns_across(tool: &Tool, axis: DVec3) -> f64 {
    let mut sum = 0.0_f64;
    for part in tool.moves.iter().filter(|part| part.rotation != DVec3::ZERO) {
        let [low, high] = part.curve.range();
        let about = part.rotation.length() * low.abs().max(high.abs());
        let between = part.rotation.angle_between(axis).to_degrees();
        // how far off the axis may be from what it is turned about, as others have turned it
        let off = (between.min(180.0 - between) + sum).min(90.0);
        sum += (about * off.to_radians().sin()).min(2.0 * off);
    }
    sum
}

fn port(scene_: &Scene, validator: &mut Validator, tool: &str, path: &Path, port: &Port) {
    if port.name.is_empty() {
        validator.out.error_at(path.name("name"), "a port needs a name, by which a program opens it");
    }
    validator.above_zero(&path.name("speed"), port.speed, "m/s");
    validator.above_zero(&path.name("spin"), port.spin, "degrees a second");
    validator.above_zero(&path.name("every"), port.every, "s");
    if let Follow::Proxy { stiffness, damping } = port.follow {
        validator.above_zero(&path.name("follow").name("stiffness"), stiffness, "N/m");
        validator.not_negative(&path.name("follow").name("damping"), damping, "N s/m");
    }
    let named = |other: &Tool| other.port.as_ref().is_some_and(|other| other.name == port.name);
    let before = scene_.tools.iter().take_while(|(name, _)| *name != tool);
    if let Some((other, _)) = before.into_iter().find(|(_, other)| named(other)) {
        validator
            .out
            .error_at(path.name("name"), format!("`{other}` has the port `{}` already", port.name))
            .note("a device moves one tool: give each port a name of its own");
    }
    let has = |what: fn(&Tool) -> bool| scene_.tools.get(tool).is_some_and(what);
    for (field, there) in [("path", has(|tool| !tool.path.is_empty())), ("moves", has(|tool| !tool.moves.is_empty()))] {
        if there {
            let message = format!("a `port` beside `{field}`: a hand moves the tool, and nobody else");
            validator.out.error_at(path, message).note("leave one of both out; `at` says where the tool is at first");
        }
    }
    if scene_.is_static() {
        validator
            .out
            .warn_at(path, "the tool stays where it is: in a static analysis no time passes in which a hand moves")
            .note("leave `port` out, or `analysis`");
    }
}

fn contacts(scene_: &Scene, validator: &mut Validator) {
    let mut of_body: BTreeMap<Option<&String>, usize> = BTreeMap::new();
    for (number, contact) in scene_.contacts.iter().enumerate() {
        let path = scene("contacts").index(number);
        friction::validate(scene_, validator, &path, contact);
        law(scene_, validator, &path.name("law"), contact);
        let Contact::Tool { tool, body, on, .. } = contact else {
            surfaces(scene_, validator, &path, contact);
            twice(scene_, validator, number);
            continue;
        };
        named(scene_, validator, &path, tool);
        touched(scene_, validator, &path, body.as_ref(), |body| format!("Tool(tool: \"{tool}\", body: \"{body}\")"));
        select::validate(validator, &path.name("on"), on);
        let count = of_body.entry(scene_.body_meant(body)).or_default();
        *count += 1;
        if *count == TOOLS_OF_A_BODY + 1 {
            let message = format!("a body may meet at most {} tools", TOOLS_OF_A_BODY);
            validator.out.error_at(&path, message);
        }
    }
}

/// Whether the same surfaces meet by an earlier contact: which of both would count?
fn twice(scene_: &Scene, validator: &mut Validator, number: usize) {
    let pair = |contact: &Contact| match contact {
        Contact::Tool { .. } => None,
        Contact::Between { bodies: (a, b), .. } => Some([a.min(b).clone(), a.max(b).clone()]),
        Contact::Itself { body, .. } => scene_.body_meant(body).map(|body| [body.clone(), body.clone()]),
    };
    let Some(here) = pair(&scene_.contacts[number]) else { return };
    let earlier = scene_.contacts[..number].iter().position(|contact| pair(contact).as_ref() == Some(&here));
    if let Some(earlier) = earlier {
        let [a, b] = here;
        let who = if a == b { format!("`{a}` meets itself") } else { format!("`{a}` and `{b}` meet") };
        validator
            .out
            .error_at(scene("contacts").index(number), format!("{who} by contacts[{earlier}] already"))
            .note("leave one of both out");
    }
}

/// Whether there is a tool of a name.
pub(super) fn named(scene_: &Scene, validator: &mut Validator, owner: &Path, tool: &str) {
    if !scene_.tools.contains_key(tool) {
        let tools = scene_.tools.keys().map(String::as_str);
        validator.out.error_at(owner.name("tool"), format!("there is no tool `{tool}`")).notes(choice(tool, tools));
    }
}

/// What is wrong with a tool that takes elements.
pub(super) fn takes(scene_: &Scene, validator: &mut Validator, path: &Path, removal: &Removal) {
    let When::InTool { tool, reach, rate, threshold, bore, burst, crumb, .. } = &removal.when else { return };
    named(scene_, validator, path, tool);
    validator.above_zero(&path.name("reach"), *reach, "m");
    taken_by(validator, path, tool, (*rate, *threshold));
    let body = scene_.body_meant(&removal.body);
    let is_this = |other: &&Removal| {
        other.when.tool() == Some(tool) && (scene_.body_meant(&other.body), &other.on) == (body, &removal.on)
    };
    if scene_.removal.iter().filter(is_this).count() > 1 {
        let message = format!("`{tool}` takes the same elements by two entries: they would go twice as fast");
        validator.out.error_at(path, message).note("leave one of both out, or give one of them more");
    }
    if rate.is_some() {
        super::suction::of_copies(scene_, validator, path, &removal.body, "what the tool takes from");
    }
    if let Some(crumb) = crumb {
        validator.not_negative(&path.name("crumb"), *crumb, "m³");
    }
    if let Some(bore) = bore {
        validator.above_zero(&path.name("bore"), *bore, "m");
    } else if scene_.tools.get(tool).is_some_and(|tool| tool.shape.is_none()) {
        validator
            .out
            .error_at(path, format!("the tool `{tool}` is a mesh: where is its mouth?"))
            .note("give `bore`, the radius of a disc about the tool's origin, across its axis z");
    }
    if !(1..=MOST_BURST).contains(burst) {
        validator.must(&path.name("burst"), &format!("between 1 and {MOST_BURST}"), burst);
    }
}

/// By what a tool takes elements: a rate or a threshold.
fn taken_by(validator: &mut Validator, path: &Path, tool: &str, by: (Option<f64>, Option<Threshold>)) {
    let either =
        "either `rate`, the volume in a second (m³/s), or `threshold`: StretchAbove(...), EnergyDensityAbove(...)";
    match by {
        (Some(rate), None) => validator.above_zero(&path.name("rate"), rate, "m³/s"),
        (None, Some(threshold)) => {
            let path = path.name("threshold");
            let (word, value, least) = match threshold {
                Threshold::StretchAbove(value) => ("StretchAbove", value, 1.0),
                Threshold::EnergyDensityAbove(value) => ("EnergyDensityAbove", value, 0.0),
            };
            super::action::limit(validator, &path, word, value, value < least);
        }
        (Some(_), Some(_)) => {
            validator.out.error_at(path.name("threshold"), "a `threshold` beside a `rate`").note(either);
        }
        (None, None) => {
            validator.out.error_at(path, format!("the tool `{tool}` takes elements by nothing")).note(either);
        }
    }
}

/// How many tools take elements of a body.
fn takers(scene_: &Scene, validator: &mut Validator) {
    let mut of_body: BTreeMap<Option<&String>, usize> = BTreeMap::new();
    for (number, removal) in scene_.removal.iter().enumerate().filter(|(_, removal)| removal.when.tool().is_some()) {
        let count = of_body.entry(scene_.body_meant(&removal.body)).or_default();
        *count += 1;
        if *count == TOOLS_OF_A_BODY + 1 {
            let message = format!("at most {TOOLS_OF_A_BODY} tools may take elements of a body");
            validator.out.error_at(scene("removal").index(number), message);
        }
    }
}

/// What keeps points out of each other.
fn law(scene_: &Scene, validator: &mut Validator, path: &Path, contact: &Contact) {
    let ContactLaw::Penalty { share, damping } = contact.law() else { return };
    validator.above_zero(&path.name("share"), share, "");
    validator.not_negative(&path.name("damping"), damping, "");
    if let Contact::Between { sweeps, .. } | Contact::Itself { sweeps, .. } = contact
        && *sweeps > 1
    {
        let message = format!("a spring has one force, and not one of {sweeps} sweeps");
        validator.out.error_at(path, message).note("leave `sweeps` out");
    }
    // implicit steps do not move it at all, which is told with the tool
    if let Contact::Tool { tool, .. } = contact
        && scene_.tools.get(tool).is_some_and(|tool| tool.free.is_some())
        && !scene_.is_implicit()
    {
        validator
            .out
            .error_at(path, format!("`{tool}` is a free body, which gives way: there is no spring for that"))
            .note("leave `law` out");
    }
}

/// Surfaces that meet: whose, and how.
fn surfaces(scene_: &Scene, validator: &mut Validator, path: &Path, contact: &Contact) {
    let (sweeps, thickness) = match contact {
        Contact::Tool { .. } => return,
        Contact::Between { bodies: (a, b), sweeps, thickness, .. } => {
            for name in [a, b].into_iter().filter(|name| !scene_.bodies.contains_key(*name)) {
                let bodies = scene_.bodies.keys().map(String::as_str);
                let message = format!("there is no body `{name}`");
                validator.out.error_at(path.name("bodies"), message).notes(choice(name, bodies));
            }
            if a == b {
                let note = format!("a body that meets itself: Itself(body: \"{a}\")");
                validator.out.error_at(path.name("bodies"), format!("`{a}` twice")).note(note);
            }
            (*sweeps, *thickness)
        }
        Contact::Itself { body, sweeps, thickness, .. } => {
            body_named(scene_, validator, path, body.as_ref());
            (*sweeps, *thickness)
        }
    };
    validator.not_negative(&path.name("thickness"), thickness, "m");
    if !(1..=MOST_SWEEPS).contains(&sweeps) {
        validator.must(&path.name("sweeps"), &format!("from 1 to {MOST_SWEEPS}"), sweeps);
    }
}
