//! Constraints, loads, removal and probes: what they select and what they do.

use super::{Validator, per_copy, scene, select, show};
use crate::scene::schema::{Axis, Constraint, Contact, Probe, Quantity, Scene, When};
use crate::scene::suggest::choice;
use crate::scene::syntax::Path;
use glam::DVec3;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    for (i, constraint) in scene_.constraints.iter().enumerate() {
        let path = scene("constraints").index(i);
        let (Constraint::Fixed { on, axes, .. } | Constraint::Prescribed { on, axes, .. }) = constraint;
        select::validate(validator, &path.name("on"), on);
        validate_axes(validator, &path.name("axes"), axes);
        if let Constraint::Prescribed { body, displacement, rotation, per_copy: Some(values), .. } = constraint {
            per_copy::of_body(scene_, validator, &path, body.as_ref(), Some(&**values));
            per_copy::of_directions(validator, &path, *displacement, values);
            if *rotation != DVec3::ZERO {
                validator
                    .out
                    .error_at(path.name("per_copy"), "a rotation is the same in all copies")
                    .note("leave `rotation` or `per_copy` out");
            }
        }
        if let Constraint::Prescribed { displacement, gradient, rotation, .. } = constraint
            && [displacement, rotation].into_iter().chain(gradient).all(|part| *part == DVec3::ZERO)
        {
            validator
                .out
                .warn_at(&path, "this prescribes no motion: it holds the nodes as `Fixed` does")
                .note("give `displacement`, `gradient` or `rotation`");
        }
    }
    for (i, load) in scene_.loads.iter().enumerate() {
        let path = scene("loads").index(i);
        per_copy::of_load(scene_, validator, &path, load);
        if let Some(on) = load.parts().on.select() {
            select::validate(validator, &path.name("on"), on);
        }
    }
    for (i, removal) in scene_.removal.iter().enumerate() {
        let path = scene("removal").index(i);
        select::validate(validator, &path.name("on"), &removal.on);
        criterion(validator, &path.name("when"), &removal.when);
        super::tool::takes(scene_, validator, &path.name("when"), removal);
    }
    for (name, probe) in &scene_.probes {
        let path = scene("probes").name(name);
        let what = path.name("what");
        match &probe.what {
            Quantity::Force { direction } => validator.has_direction(&what.name("direction"), *direction),
            Quantity::Torque { axis, .. } => validator.has_direction(&what.name("axis"), *axis),
            _ => {}
        }
        untouched(scene_, validator, &what, probe);
        whole(validator, &path, probe);
        match (probe.what.tool(), &probe.on) {
            // whether it is there is looked at with the attachments
            _ if probe.what.attachment().is_some() => {}
            (None, Some(on)) => select::validate(validator, &path.name("on"), on),
            (None, None) if probe.what == Quantity::RemovedVolume => {}
            (None, None) => {
                let message = format!("the probe `{name}` lacks `on`: which nodes or elements it is of");
                validator.out.error_at(&path, message).note("on: All, Set(...), Plane(...), ...");
            }
            (Some(tool), _) => {
                if !scene_.tools.contains_key(tool) {
                    let tools = scene_.tools.keys().map(String::as_str);
                    let message = format!("there is no tool `{tool}`");
                    validator.out.error_at(what.name("tool"), message).notes(choice(tool, tools));
                }
            }
        }
    }
}

/// Probes of tools and attachments that ask for less than the whole.
fn whole(validator: &mut Validator, path: &Path, probe: &Probe) {
    let of_what = match (probe.what.attachment(), probe.what.tool()) {
        (Some(_), _) => "what an attachment bears is of the whole attachment",
        (None, Some(_)) => "what a tool feels is of the whole tool",
        (None, None) => return,
    };
    if probe.on.is_some() {
        validator.out.error_at(path.name("on"), of_what).note("leave `on` out");
    }
    if probe.body.is_some() {
        validator
            .out
            .error_at(path.name("body"), of_what)
            .note("leave `body` out; `ContactForce` with a `body` is what that body feels");
    }
}

/// Probes of what a body touches that nothing touches.
fn untouched(scene_: &Scene, validator: &mut Validator, path: &Path, probe: &Probe) {
    let Some(body) = scene_.body_meant(&probe.body) else { return };
    let is = |name: &Option<String>| name.as_ref().is_none_or(|name| name == body);
    let touches = |contact: &Contact| match contact {
        Contact::Tool { body: of, .. } | Contact::Itself { body: of, .. } => is(of),
        Contact::Between { bodies: (a, b), .. } => a == body || b == body,
    };
    if probe.what.is_of_contact() && !scene_.contacts.iter().any(touches) {
        validator
            .out
            .warn_at(path, format!("nothing touches `{body}`: this will say so in every row"))
            .note("`contacts` says what meets what");
    }
}

fn validate_axes(validator: &mut Validator, path: &Path, axes: &[Axis]) {
    if axes.is_empty() {
        validator
            .out
            .error_at(path, "the list of `axes` is empty: nothing would be held")
            .note("leave `axes` out for all three, or name some of X, Y, Z");
    }
    for (i, axis) in axes.iter().enumerate() {
        if axes[..i].contains(axis) {
            validator.out.warn_at(path.index(i), format!("the axis {axis:?} stands here twice"));
        }
    }
}

/// What is wrong with a threshold; at rest every stretch and volume ratio is 1.
fn criterion(validator: &mut Validator, path: &Path, when: &When) {
    let (word, value, senseless) = match *when {
        When::At(_) | When::During { .. } | When::InTool { .. } => return,
        When::StretchAbove(value) => ("StretchAbove", value, value < 1.0),
        When::VolumeRatioBelow(value) => ("VolumeRatioBelow", value, value > 1.0),
        When::VolumeRatioAbove(value) => ("VolumeRatioAbove", value, value < 1.0),
        When::EnergyDensityAbove(value) => ("EnergyDensityAbove", value, false),
    };
    limit(validator, path, word, value, senseless);
}

/// What is wrong with the limit of a criterion.
pub(super) fn limit(validator: &mut Validator, path: &Path, word: &str, value: f64, senseless: bool) {
    if value < 0.0 || (value == 0.0 && word != "EnergyDensityAbove") {
        let allowed = if word == "EnergyDensityAbove" { "0 or above" } else { "above 0" };
        validator.out.error_at(path.index(0), format!("`{word}` must be {allowed}, found {}", show(value)));
    } else if senseless {
        validator
            .out
            .warn_at(path.index(0), format!("`{word}` of {} holds at rest: all elements go at once", show(value)))
            .note("at rest the stretch and the volume ratio are 1");
    }
}
