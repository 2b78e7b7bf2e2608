//! Durations, steps, intervals and curves.

use super::{Validator, scene, show, with_unit};
use crate::scene::schema::{Curve, EnergyGuard, Guard, Guards, Scene, When, WhenUnstable};
use crate::scene::syntax::Path;
use std::collections::BTreeMap;

/// More states than are of use after a breakdown.
const MOST_STATES: u64 = 100;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    validator.above_zero(&scene("duration"), scene_.duration, "s");
    let path = scene("integration");
    if let Some(step) = scene_.integration.step {
        every(validator, &path.name("step"), step, scene_.duration);
    }
    let safety = scene_.integration.safety;
    if safety <= 0.0 || safety > 1.0 {
        validator
            .must(&path.name("safety"), "above 0 and at most 1", show(safety))
            .note("it is the share of the stable step that is taken; 0.9 when left out");
    }
    if let Some(WhenUnstable::ScaleMass { most }) = scene_.integration.when_unstable
        && (most <= 0.0 || most > 1.0)
    {
        validator
            .must(&path.name("when_unstable").name("most"), "above 0 and at most 1", show(most))
            .note("it is the share of all mass that may be added; 0.05 when left out");
    }
    let path = scene("output");
    for (field, value) in [
        ("fields_every", scene_.output.fields_every),
        ("energies_every", scene_.output.energies_every),
        ("snapshots_every", scene_.output.snapshots_every),
    ] {
        if let Some(value) = value {
            every(validator, &path.name(field), value, scene_.duration);
        }
    }
    guards(scene_, validator);
    for (name, probe) in &scene_.probes {
        if let Some(value) = probe.every {
            every(validator, &scene("probes").name(name).name("every"), value, scene_.duration);
        }
    }
    actions(scene_, validator);
}

fn guards(scene_: &Scene, validator: &mut Validator) {
    let (guards, path) = (&scene_.guards, scene("guards"));
    if guards.every == 0 {
        validator.must(&path.name("every"), "at least 1", 0).note("it is the number of steps between two checks");
    }
    let Guards { energy: EnergyGuard { warn, stop }, hourglass, .. } = *guards;
    validator.above_zero(&path.name("energy").name("warn"), warn, "");
    validator.above_zero(&path.name("energy").name("stop"), stop, "");
    validator.above_zero(&path.name("hourglass"), hourglass, "");
    if guards.window > MOST_STATES {
        validator
            .must(&path.name("window"), &format!("at most {MOST_STATES}"), guards.window)
            .note("each state takes as much memory as the columns that steps carry on");
    }
    if scene_.integration.beyond_stable_step && guards.off.contains(&Guard::Energy) {
        validator
            .out
            .error_at(path.name("off"), "a step beyond the stable one needs the balance of energy")
            .note("it is what shows that the step was too large; leave `Energy` out of `off`");
    }
    let without_energy = scene_.materials.iter().find(|(_, material)| material.by_frame().is_some());
    if let (Some((name, _)), true) = (without_energy, scene_.integration.beyond_stable_step) {
        let message = "a step beyond the stable one needs the balance of energy, and a law in frames has no energy";
        validator
            .out
            .error_at(scene("integration").name("beyond_stable_step"), message)
            .note(format!("the material `{name}` has `rotation: Frame`; `Polar` has an energy"));
    }
}

/// A time between two things that happen.
fn every(validator: &mut Validator, path: &Path, value: f64, duration: f64) {
    validator.above_zero(path, value, "s");
    if value > duration && duration > 0.0 {
        let message = format!("{} is longer than the scene: {}", super::called(path), with_unit(value, "s"));
        validator.out.warn_at(path, message).note(format!("`duration` is {}", with_unit(duration, "s")));
    }
}

fn actions(scene_: &Scene, validator: &mut Validator) {
    for (path, curve) in scene_.curves() {
        validate_curve(validator, &path, curve, scene_.duration);
    }
    inputs(scene_, validator);
    for (i, removal) in scene_.removal.iter().enumerate() {
        let path = scene("removal").index(i).name("when");
        match removal.when {
            When::At(time) => {
                if time < 0.0 {
                    validator
                        .out
                        .error_at(path.index(0), format!("`At` must be 0 or above, found {}", with_unit(time, "s")));
                }
                too_late(validator, &path.index(0), time, scene_.duration);
            }
            When::During { start, end } => {
                validator.not_negative(&path.name("start"), start, "s");
                interval(validator, &path, start, end);
                too_late(validator, &path.name("start"), start, scene_.duration);
            }
            _ => {}
        }
    }
}

fn validate_curve(validator: &mut Validator, path: &Path, curve: &Curve, duration: f64) {
    match curve {
        Curve::Step { start, end } => {
            if let Some(end) = end {
                interval(validator, path, *start, *end);
            }
            too_late(validator, &path.name("start"), *start, duration);
        }
        Curve::Ramp { start, end } | Curve::Smooth { start, end } => {
            interval(validator, path, *start, *end);
            too_late(validator, &path.name("start"), *start, duration);
        }
        Curve::Table(points) => table(validator, path, points),
        Curve::Input { name, rate, .. } => {
            if name.is_empty() {
                validator.out.error_at(path.name("name"), "an input needs a name, by which a program sets it");
            }
            if let Some(rate) = rate {
                validator.above_zero(&path.name("rate"), *rate, "a second");
            }
        }
    }
}

/// What has the same name is one input, and must be the same everywhere.
fn inputs(scene_: &Scene, validator: &mut Validator) {
    let curves = scene_.curves();
    let mut first: BTreeMap<&str, &Curve> = BTreeMap::new();
    for (path, curve) in &curves {
        let Curve::Input { name, initial, rate } = curve else { continue };
        let Curve::Input { initial: there, rate: bound, .. } = first.entry(name).or_insert(curve) else { continue };
        let note = format!("the same name is the same input; `{name}` stands somewhere before");
        if initial != there {
            validator.must(&path.name("initial"), &format!("{}, as before", show(*there)), show(*initial)).note(&note);
        }
        let said = |rate: &Option<f64>| rate.map_or("none".into(), show);
        if rate != bound {
            let found = if rate.is_some() { path.name("rate") } else { path.clone() };
            let message = format!("`rate` must be {}, as before, found {}", said(bound), said(rate));
            validator.out.error_at(found, message).note(&note);
        }
    }
}

fn interval(validator: &mut Validator, path: &Path, start: f64, end: f64) {
    if end <= start {
        validator
            .must(&path.name("end"), "after `start`", with_unit(end, "s"))
            .note(format!("`start` is {}", with_unit(start, "s")));
    }
}

fn too_late(validator: &mut Validator, path: &Path, start: f64, duration: f64) {
    if start >= duration && duration > 0.0 {
        validator
            .out
            .warn_at(path, format!("this begins at {}, when the scene is over", with_unit(start, "s")))
            .note(format!("`duration` is {}", with_unit(duration, "s")));
    }
}

fn table(validator: &mut Validator, path: &Path, points: &[(f64, f64)]) {
    if points.is_empty() {
        validator
            .out
            .error_at(path, "the table has no points")
            .note("a point is (time, factor): Table([(0, 0), (0.1, 1)])");
    }
    for (i, pair) in points.windows(2).enumerate() {
        if pair[1].0 <= pair[0].0 {
            validator
                .out
                .error_at(
                    path.index(i + 1).index(0),
                    format!("the times of a table must grow, found {}", with_unit(pair[1].0, "s")),
                )
                .note(format!("the point before is at {}", with_unit(pair[0].0, "s")));
            // one unsorted column would be told point by point
            break;
        }
    }
}
