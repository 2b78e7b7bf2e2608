//! Attachments: whether what holds and what is held are there.

use super::names::body_named;
use super::tool::named;
use super::{Validator, scene, select};
use crate::scene::limits::{MOST_SWEEPS, TOOLS_OF_A_BODY};
use crate::scene::schema::{Attachment, InitialState, Point, Quantity, Scene};
use crate::scene::suggest::choice;
use crate::scene::syntax::Path;
use std::collections::{BTreeMap, BTreeSet};

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    let mut of_body: BTreeMap<Option<&String>, usize> = BTreeMap::new();
    let mut names = BTreeSet::new();
    for (number, attachment) in scene_.attachments.iter().enumerate() {
        let path = scene("attachments").index(number);
        for (word, on) in attachment.selections() {
            select::validate(validator, &path.name(word), on);
        }
        if let Some(name) = attachment.name(number)
            && !names.insert(name.clone())
        {
            let message = format!("another attachment is called `{name}`, too");
            validator.out.error_at(&path, message).note("without a `name` it is its place in the list, counted from 0");
        }
        match attachment {
            Attachment::Grasp { body, .. } => {
                grasp(scene_, validator, &path, attachment);
                if let Some(earlier) =
                    scene_.attachments[..number].iter().position(|other| is_same_grasp(scene_, other, attachment))
                {
                    let message = format!("this tool holds the same nodes by attachments[{earlier}] already");
                    validator.out.error_at(&path, message).note("leave one of both out");
                }
                let count = of_body.entry(scene_.body_meant(body)).or_default();
                *count += 1;
                if *count == TOOLS_OF_A_BODY + 1 {
                    validator.out.error_at(&path, format!("at most {TOOLS_OF_A_BODY} grasps may hold a body"));
                }
            }
            Attachment::Suture { .. } => suture(scene_, validator, &path, attachment),
            Attachment::Tie { from, to, strength, .. } => {
                points(scene_, validator, &path, [from, to], "tie");
                bound(validator, &path, "strength", *strength, "N");
                static_strength(scene_, validator, &path, "strength", strength.is_some());
            }
            Attachment::Glue { .. } => glue(scene_, validator, &path, attachment),
        }
    }
    lengths(scene_, validator);
    for (name, probe) in &scene_.probes {
        let Some(attachment) = probe.what.attachment().filter(|name| !names.contains(*name)) else { continue };
        let path = scene("probes").name(name).name("what").name("attachment");
        let message = format!("there is no suture, tie or glue `{attachment}`");
        validator.out.error_at(path, message).notes(choice(attachment, names.iter().map(String::as_str)));
    }
}

/// Threads have a length, and nothing else that holds.
fn lengths(scene_: &Scene, validator: &mut Validator) {
    let all = scene_.attachments.iter().enumerate();
    let others: BTreeSet<String> = all
        .filter(|(_, attachment)| !matches!(attachment, Attachment::Suture { .. }))
        .filter_map(|(number, attachment)| attachment.name(number))
        .collect();
    for (name, probe) in &scene_.probes {
        if let Quantity::SutureLength { attachment } = &probe.what
            && others.contains(attachment)
        {
            let path = scene("probes").name(name).name("what");
            let message = format!("`{attachment}` is no suture: it has no length");
            let note = format!("what it bears is AttachmentForce(attachment: \"{attachment}\")");
            validator.out.error_at(path, message).note(note);
        }
    }
}

fn bound(validator: &mut Validator, path: &Path, field: &str, value: Option<f64>, unit: &str) {
    if let Some(value) = value {
        validator.above_zero(&path.name(field), value, unit);
    }
}

/// Pseudo-steps are no way that something would break on.
fn static_strength(scene_: &Scene, validator: &mut Validator, path: &Path, field: &str, there: bool) {
    if there && scene_.is_static() {
        validator
            .out
            .warn_at(path.name(field), "nothing breaks in a static analysis: it holds whatever it bears")
            .note("what breaks depends on the way there, which a transient analysis goes");
    } else if there && matches!(scene_.start, InitialState::Equilibrium(_)) {
        validator
            .out
            .warn_at(path.name(field), "nothing breaks on the way to the equilibrium of the start")
            .note("what bears more there than it can breaks in the first steps");
    }
}

/// Whether two grasps are of one tool and the same nodes.
fn is_same_grasp(scene_: &Scene, one: &Attachment, other: &Attachment) -> bool {
    match (one, other) {
        (Attachment::Grasp { tool, body, on, .. }, Attachment::Grasp { tool: of, body: with, on: by, .. }) => {
            (tool, scene_.body_meant(body), on) == (of, scene_.body_meant(with), by)
        }
        _ => false,
    }
}

fn grasp(scene_: &Scene, validator: &mut Validator, path: &Path, attachment: &Attachment) {
    let Attachment::Grasp { tool, body, jaws, reach, closed, strength, .. } = attachment else { return };
    named(scene_, validator, path, tool);
    body_named(scene_, validator, path, body.as_ref());
    if let Some(problem) = jaws.as_ref().and_then(|shape| shape.problem(0.0)) {
        validator.out.error_at(path.name("jaws").name(problem.field), problem.message);
    }
    if let Some(reach) = reach {
        validator.not_negative(&path.name("reach"), *reach, "m");
    }
    bound(validator, path, "strength", *strength, "N");
    // what closes later holds nothing on the way to the start
    let there = strength.is_some() && (scene_.is_static() || closed.value(0.0) >= 0.5);
    static_strength(scene_, validator, path, "strength", there);
}

/// Points of bodies that are there, and are two.
fn points(scene_: &Scene, validator: &mut Validator, path: &Path, [from, to]: [&Point; 2], what: &str) {
    body_named(scene_, validator, &path.name("from"), from.body.as_ref());
    body_named(scene_, validator, &path.name("to"), to.body.as_ref());
    if from == to {
        validator.out.error_at(path.name("to"), format!("both points of the {what} are one place"));
    }
}

fn suture(scene_: &Scene, validator: &mut Validator, path: &Path, attachment: &Attachment) {
    let Attachment::Suture { from, to, stiffness, length, tighten, strength, .. } = attachment else { return };
    points(scene_, validator, path, [from, to], "suture");
    validator.above_zero(&path.name("stiffness"), *stiffness, "N/m");
    if let Some(length) = length {
        validator.not_negative(&path.name("length"), *length, "m");
    }
    validator.not_negative(&path.name("tighten"), *tighten, "m");
    bound(validator, path, "strength", *strength, "N");
    static_strength(scene_, validator, path, "strength", strength.is_some());
}

fn glue(scene_: &Scene, validator: &mut Validator, path: &Path, attachment: &Attachment) {
    let Attachment::Glue { bodies: (a, b), on, onto, reach, normal, shear, sweeps, .. } = attachment else { return };
    for name in [a, b].into_iter().filter(|name| !scene_.bodies.contains_key(*name)) {
        let bodies = scene_.bodies.keys().map(String::as_str);
        let message = format!("there is no body `{name}`");
        validator.out.error_at(path.name("bodies"), message).notes(choice(name, bodies));
    }
    if a == b && on == onto {
        validator
            .out
            .error_at(path.name("bodies"), format!("all of `{a}` would be glued to itself"))
            .note("say by `on` and `onto` which of its faces stick to which others");
    }
    if let Some(reach) = reach {
        validator.not_negative(&path.name("reach"), *reach, "m");
    }
    bound(validator, path, "normal", *normal, "Pa");
    bound(validator, path, "shear", *shear, "Pa");
    static_strength(scene_, validator, path, "normal", normal.is_some());
    static_strength(scene_, validator, path, "shear", shear.is_some());
    if !(1..=MOST_SWEEPS).contains(sweeps) {
        validator.must(&path.name("sweeps"), &format!("from 1 to {MOST_SWEEPS}"), sweeps);
    }
}
