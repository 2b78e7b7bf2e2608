//! What a scene's `parameters` say, for the systems they are for.

use super::known::Known;
use super::schedule::Scheduled;
use crate::scene::schema::Scene;
use crate::scene::{Diagnostics, choice};
use bevy_ecs::prelude::*;
use ron::Value;
use ron::value::Map;

/// The parameter that the engine takes itself: the time between two runs (s).
const EVERY: &str = "every";

/// Hands its parameters to each system of one's own that the scene's schedule names, or, where there is none, that it
/// gives some. Complaints go to `diagnostics`.
pub(super) fn hand_out(scene: &Scene, known: &Known<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let named = |name: &String| scene.schedule.as_ref().map(|names| names.contains(name));
    for name in scene.parameters.keys() {
        let path = path_of(name);
        match known.get(name) {
            None => {
                let custom: Vec<&str> = known.systems().filter(|s| s.custom).map(|s| s.name.as_str()).collect();
                let notes = match custom.is_empty() {
                    true => vec!["a program adds systems of its own; this one has none".to_string()],
                    false => choice(name, custom),
                };
                diagnostics
                    .error_at(path.as_str(), format!("there is no system named `{name}` to give parameters to"))
                    .notes(notes);
            }
            Some(_) if known.is_own(name) => {
                diagnostics
                    .error_at(
                        path.as_str(),
                        format!("`{name}` is a system of the scene's own: it has no parameters here"),
                    )
                    .note(format!("what its file takes stands in systems.\"{name}\".parameters"));
            }
            Some(system) if !system.custom => {
                diagnostics
                    .error_at(path.as_str(), format!("the built-in system `{name}` has no parameters"))
                    .note(format!("what it does comes from {}", system.called_for_by));
            }
            Some(_) if named(name) == Some(false) => {
                diagnostics
                    .warn_at(path.as_str(), format!("`{name}` is not in the schedule and does nothing"))
                    .note(format!("add \"{name}\" to `schedule`"));
            }
            Some(_) => {}
        }
    }
    for system in known.systems().filter(|system| system.custom) {
        let name = &system.name;
        let given = scene.parameters.get(name);
        if !named(name).unwrap_or(given.is_some()) {
            continue;
        }
        let place = scene.schedule.iter().flatten().position(|other| other == name).unwrap_or_default();
        let path = if given.is_some() { path_of(name) } else { format!("schedule[{place}]") };
        let mut complain = |message: String| {
            diagnostics.error_at(path.as_str(), message).note(ALLOWED);
        };
        let mut fields = match given.cloned() {
            None | Some(Value::Unit) => Map::new(),
            Some(Value::Map(fields)) => fields,
            Some(_) => {
                complain(format!("the parameters of `{name}` have names: (strength: 3, ...)"));
                continue;
            }
        };
        match fields.remove(&Value::String(EVERY.into())) {
            None => {}
            Some(every) if interval_of(&every).is_some() => {}
            Some(_) => {
                complain(format!("`every` of `{name}` is the time between two runs (s), above 0"));
            }
        }
        let result = match system.parameters {
            Some(read) => read(Value::Map(fields), world),
            None => match fields.iter().next() {
                Some((Value::String(field), _)) => Err(format!("it has no `{field}`; allowed: {EVERY}")),
                Some(_) | None => Ok(()),
            },
        };
        if let Err(reason) = result.and_then(|()| system.check.as_ref().map_or(Ok(()), |check| check(world))) {
            complain(format!("the parameters of `{name}` do not fit: {reason}"));
        }
    }
}

/// Sets how often systems of one's own run, where their parameters say so, in steps of so long (s).
pub(super) fn set_intervals(scene: &Scene, time_step: f64, schedule: &mut [Scheduled<'_>]) {
    let every = Value::String(EVERY.into());
    for entry in schedule.iter_mut().filter(|entry| entry.system.custom) {
        let Some(Value::Map(fields)) = scene.parameters.get(&entry.system.name) else { continue };
        if let Some(interval) = fields.iter().find(|(name, _)| **name == every).and_then(|(_, time)| interval_of(time))
        {
            entry.every = crate::assembly::steps_of(interval, time_step);
            entry.interval = Some(interval);
        }
    }
}

/// The time between two runs (s), if a value is one.
fn interval_of(value: &Value) -> Option<f64> {
    match value {
        Value::Number(time) => Some(time.into_f64()).filter(|time| *time > 0.0),
        _ => None,
    }
}

const ALLOWED: &str = "what a custom system takes is said where it is registered; `every` (s) goes with all of them";

fn path_of(name: &str) -> String {
    format!("parameters.\"{name}\"")
}
