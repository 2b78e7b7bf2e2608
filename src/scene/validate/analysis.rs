//! Static analyses and motions that begin at equilibrium: their numbers, and what of a scene has no meaning at rest.

use super::{Validator, scene, show};
use crate::scene::limits::{PATH_POINTS, PSEUDO_STEPS};
use crate::scene::schema::{
    Analysis, ArcLength, Constraint, Contact, EquilibriumSearch, InitialState, Inversion, Load, OutputField, Quantity,
    Scene, SearchMethod, laws_that_recover,
};
use crate::scene::syntax::Path;
use glam::DVec3;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    start(scene_, validator);
    let Analysis::Static(search) = scene_.analysis else { return };
    let path = scene("analysis");
    numbers(&path, &search, validator);
    if let Some(at) = search.at {
        validator.not_negative(&path.name("at"), at, "s");
    }
    if !scene_.removal.is_empty() {
        validator
            .out
            .error_at(scene("removal"), "a static analysis cannot remove elements")
            .note("which ones go depends on the way to rest, and pseudo-steps are no way that a body takes")
            .note("leave `removal` out, or use `analysis: Transient`");
    }
    for (name, material) in &scene_.materials {
        if material.inversion == Some(Inversion::Remove) {
            validator
                .out
                .error_at(scene("materials").name(name).name("inversion"), "a static analysis cannot remove elements")
                .note(format!("allowed: Stop, and Recover for {}", laws_that_recover().join(", ")));
        }
    }
    if search.arc.is_some() {
        let touch = [("contacts", scene_.contacts.len()), ("attachments", scene_.attachments.len())];
        for (list, _) in touch.into_iter().filter(|(_, count)| *count > 0) {
            validator
                .out
                .error_at(scene(list).index(0), "a path by arc length takes no part in contact and attachments")
                .note("leave `arc` out: what touches changes all at once along a path");
        }
    }
    slips(scene_, validator);
    meaningless(scene_, validator);
    held(scene_, &path, validator);
}

/// How a path is followed.
fn arc(path: &Path, search: &EquilibriumSearch, validator: &mut Validator) {
    let Some(ArcLength { first, longest, points }) = search.arc else { return };
    let path = path.name("arc");
    if search.method != SearchMethod::Newton {
        validator
            .out
            .error_at(&path, "a path by arc length is one of Newton's iterations")
            .note("write `method: Newton`, or leave `arc` out");
    }
    // what is no number is not within
    if !(first > 0.0 && first <= 1.0) {
        validator
            .must(&path.name("first"), "above 0 and at most 1", show(first))
            .note("it is the share of all loads that the first step is to reach; 0.1 when left out");
    }
    if let Some(longest) = longest {
        validator.above_zero(&path.name("longest"), longest, "m");
    }
    if !(1..=PATH_POINTS).contains(&points) {
        validator.must(&path.name("points"), &format!("from 1 to {PATH_POINTS}"), points);
    }
}

/// How well equilibrium is sought, and how long.
fn numbers(path: &Path, search: &EquilibriumSearch, validator: &mut Validator) {
    let EquilibriumSearch { tolerance, max_steps, load_steps, .. } = *search;
    arc(path, search, validator);
    if let Some(tolerance) = tolerance
        && (tolerance <= 0.0 || tolerance >= 1.0)
    {
        validator
            .must(&path.name("tolerance"), "above 0 and below 1", show(tolerance))
            .note("it is a share of loads and reactions; 1e-6 in f64 and 1e-5 in f32 when left out");
    }
    if max_steps == 0 {
        validator.must(&path.name("max_steps"), "at least 1", max_steps);
    }
    if max_steps > PSEUDO_STEPS {
        validator.must(&path.name("max_steps"), &format!("at most {PSEUDO_STEPS}"), max_steps);
    }
    match load_steps {
        Some(0) => {
            validator.must(&path.name("load_steps"), "at least 1", 0).note("left out, it is found from the mesh");
        }
        Some(steps) if steps > max_steps => {
            validator
                .must(&path.name("load_steps"), "at most `max_steps`", steps)
                .note(format!("`max_steps` is {max_steps}: loads would never act in full"));
        }
        _ => {}
    }
}

/// A motion that begins at equilibrium.
fn start(scene_: &Scene, validator: &mut Validator) {
    let InitialState::Equilibrium(search) = scene_.start else { return };
    let path = scene("start");
    if scene_.is_static() {
        validator.out.warn_at(&path, "a static analysis ignores `start`: it seeks an equilibrium anyway");
        return;
    }
    numbers(&path, &search, validator);
    if search.at.is_some_and(|at| at != 0.0) {
        validator
            .out
            .error_at(path.name("at"), "a motion begins at t = 0")
            .note("`at` is for `analysis: Static(...)`; leave it out");
    }
    if search.arc.is_some() {
        validator
            .out
            .error_at(path.name("arc"), "a motion begins at its loads as they stand, and at no point of a path")
            .note("`arc` is for `analysis: Static(...)`; leave it out");
    }
    for (name, body) in &scene_.bodies {
        let body_path = scene("bodies").name(name);
        let own = [
            ("start", body.start.is_some()),
            ("velocity", body.velocity != DVec3::ZERO),
            ("spin", body.spin != DVec3::ZERO),
        ];
        for (field, _) in own.iter().filter(|(_, there)| *there) {
            validator
                .out
                .error_at(body_path.name(*field), format!("`{field}` has no meaning beside `start: Equilibrium()`"))
                .note("bodies begin at rest where loads and constraints hold them; leave one of the two out");
        }
    }
    let curves = scene_.loads.iter().map(Load::curve).chain(scene_.constraints.iter().filter_map(Constraint::curve));
    let curves = curves.chain(scene_.systems.values().map(|system| &system.curve));
    // tools that press and sutures that draw do so where they are at t = 0
    let meets = !scene_.contacts.is_empty() || !scene_.attachments.is_empty();
    if !meets && curves.map(|curve| curve.value(0.0)).all(|factor| factor == 0.0) {
        validator.out.warn_at(&path, "nothing acts at t = 0: bodies start undeformed").note(
            "curves count as they stand at 0: a ramp that begins there is 0; a load without `curve` acts in full",
        );
    }
    held(scene_, &path, validator);
}

/// Who is held by nothing is at rest only by chance.
fn held(scene_: &Scene, path: &Path, validator: &mut Validator) {
    for name in scene_.bodies.keys() {
        let holds = |constraint: &Constraint| {
            let (Constraint::Fixed { body, .. } | Constraint::Prescribed { body, .. }) = constraint;
            body.as_ref().is_none_or(|body| body == name)
        };
        let touched = scene_.contacts.iter().any(|contact| match contact {
            Contact::Tool { body, .. } => body.as_ref().is_none_or(|body| body == name),
            Contact::Between { bodies: (a, b), .. } => a == name || b == name,
            Contact::Itself { .. } => false,
        });
        let grasped = scene_.attachments.iter().any(|attachment| attachment.holds(name));
        if !touched && !grasped && !scene_.constraints.iter().any(holds) {
            validator
                .out
                .warn_at(path, format!("nothing holds the body {name:?}: it is at rest only where its loads balance"))
                .note("add `Fixed(...)` or `Prescribed(...)` under `constraints`");
        }
    }
}

/// How far nodes have slid is the length of a way.
fn slips(scene_: &Scene, validator: &mut Validator) {
    let fields = scene_.output.fields.iter().flatten().enumerate();
    let fields = fields.filter(|(_, field)| **field == OutputField::ContactSlip);
    let fields = fields.map(|(number, _)| scene("output").name("fields").index(number));
    let probes = scene_.probes.iter().filter(|(_, probe)| probe.what == Quantity::ContactSlip);
    for path in fields.chain(probes.map(|(name, _)| scene("probes").name(name).name("what"))) {
        validator
            .out
            .error_at(path, "a static analysis has no `ContactSlip`")
            .note("it is the length that nodes slide, and pseudo-steps are no way that a body takes")
            .note("leave it out, or use `analysis: Transient`");
    }
}

/// What may stand in a scene that is also run over time, and does nothing at rest.
fn meaningless(scene_: &Scene, validator: &mut Validator) {
    let mut ignore = |path, what: &str| {
        validator.out.warn_at(&path, format!("a static analysis ignores {what}"));
    };
    if scene_.output.snapshots_every.is_some() {
        ignore(
            scene("output").name("snapshots_every"),
            "`snapshots_every`: its pseudo-steps are nothing to go on from",
        );
    }
    for (name, body) in &scene_.bodies {
        if body.velocity != DVec3::ZERO || body.spin != DVec3::ZERO {
            let field = if body.velocity != DVec3::ZERO { "velocity" } else { "spin" };
            ignore(scene("bodies").name(name).name(field), "how a body moves at the start");
        }
        if body.start.is_some() {
            ignore(scene("bodies").name(name).name("start"), "how a body is deformed at the start");
        }
    }
    if scene_.integration.step.is_some() {
        ignore(scene("integration").name("step"), "the time step");
    }
    for (name, probe) in &scene_.probes {
        if probe.what == Quantity::Velocity {
            ignore(scene("probes").name(name).name("what"), "velocities: they are 0");
        }
    }
}
