//! Static analyses: their numbers, and what of a scene has no meaning at rest.

use super::{Judge, scene, show};
use crate::scene::limits::PSEUDO_STEPS;
use crate::scene::schema::{Analysis, Constraint, Inversion, Quantity, Scene};
use glam::DVec3;

pub(super) fn validate(scene_: &Scene, judge: &mut Judge) {
    let Analysis::Static { tolerance, max_steps, load_steps } = scene_.analysis else { return };
    let path = scene("analysis");
    if let Some(tolerance) = tolerance
        && (tolerance <= 0.0 || tolerance >= 1.0)
    {
        judge
            .must(&path.name("tolerance"), "above 0 and below 1", show(tolerance))
            .note("it is a share of loads and reactions; 1e-6 in f64 and 1e-5 in f32 when left out");
    }
    if max_steps == 0 {
        judge.must(&path.name("max_steps"), "at least 1", max_steps);
    }
    if max_steps > PSEUDO_STEPS {
        judge.must(&path.name("max_steps"), &format!("at most {PSEUDO_STEPS}"), max_steps);
    }
    match load_steps {
        Some(0) => {
            judge.must(&path.name("load_steps"), "at least 1", 0).note("left out, it is found from the mesh");
        }
        Some(steps) if steps > max_steps => {
            judge
                .must(&path.name("load_steps"), "at most `max_steps`", steps)
                .note(format!("`max_steps` is {max_steps}: loads would never act in full"));
        }
        _ => {}
    }
    if !scene_.removal.is_empty() {
        judge
            .out
            .error_at(scene("removal"), "a static analysis cannot remove elements")
            .note("which ones go depends on the way to rest, and pseudo-steps are no way that a body takes")
            .note("leave `removal` out, or use `analysis: Transient`");
    }
    for (name, material) in &scene_.materials {
        if material.inversion == Some(Inversion::Remove) {
            judge
                .out
                .error_at(scene("materials").name(name).name("inversion"), "a static analysis cannot remove elements")
                .note("allowed: Stop, and Recover for stable_neo_hookean");
        }
    }
    meaningless(scene_, judge);
    for name in scene_.bodies.keys() {
        let holds = |constraint: &Constraint| {
            let (Constraint::Fixed { body, .. } | Constraint::Prescribed { body, .. }) = constraint;
            body.as_ref().is_none_or(|body| body == name)
        };
        if !scene_.constraints.iter().any(holds) {
            judge
                .out
                .warn_at(&path, format!("nothing holds the body {name:?}: it is at rest only where its loads balance"))
                .note("add `Fixed(...)` or `Prescribed(...)` under `constraints`");
        }
    }
}

/// What may stand in a scene that is also run over time, and does nothing at rest.
fn meaningless(scene_: &Scene, judge: &mut Judge) {
    let mut ignore = |path, what: &str| {
        judge.out.warn_at(&path, format!("a static analysis ignores {what}"));
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
