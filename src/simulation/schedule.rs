//! The order of systems: as the scene writes it, or derived from what the scene contains.

use super::known::Known;
use crate::components::ToolLooks;
use crate::scene::{Diagnostics, choice};
use crate::systems::{Phase, System};
use bevy_ecs::prelude::*;

/// A system of the schedule, and why it is there.
pub struct Scheduled<'a> {
    /// The system.
    pub system: &'a System,
    /// Why.
    pub because: String,
    /// Steps between two runs.
    pub every: u64,
    /// Time between two runs (s), where the scene says so.
    pub interval: Option<f64>,
    /// Whether a GPU has it.
    pub on_device: bool,
}

impl<'a> Scheduled<'a> {
    fn new(system: &'a System, because: String, world: &World) -> Self {
        let on_device = system.device.is_some() && (system.device_when)(world);
        // those of the engine that do not run in every step look at what tools take
        let most = if system.custom { u64::MAX } else { world.resource::<ToolLooks>().0 };
        Self { system, because, every: system.every.clamp(1, most), interval: None, on_device }
    }
}

/// Looks for mistakes in a scene's schedule that show without its world: names and their order.
pub fn check_names(names: &[String], known: &Known<'_>, diagnostics: &mut Diagnostics) {
    let mut schedule: Vec<&System> = Vec::new();
    for (place, name) in names.iter().enumerate() {
        let path = format!("schedule[{place}]");
        let Some(system) = known.get(name) else {
            let names = known.systems().map(|system| system.name.as_str());
            diagnostics
                .error_at(path.as_str(), format!("there is no system named `{name}`"))
                .notes(choice(name, names));
            continue;
        };
        if schedule.iter().any(|earlier| earlier.name == *name) {
            diagnostics.error_at(path.as_str(), format!("`{name}` is in the schedule already; a step runs it once"));
            continue;
        }
        if let Some(earlier) = schedule.iter().find(|earlier| earlier.phase > system.phase) {
            let (a, b) = (phase_word(earlier.phase), phase_word(system.phase));
            diagnostics
                .error_at(path.as_str(), format!("`{name}` must stand before `{}`", earlier.name))
                .note(format!("`{name}` {b}, `{}` {a}; the order of phases is {}", earlier.name, phases()));
        }
        schedule.push(system);
    }
}

/// Whether a scene has a system: one that its schedule names, or, where it writes none, one that its world calls for.
pub fn takes_part(system: &System, names: Option<&[String]>, world: &mut World) -> bool {
    match names {
        Some(names) => names.contains(&system.name),
        None => (system.because)(world).is_some(),
    }
}

/// The systems of a scene in order: those it names, as far as there are such, or those that its world calls for. That
/// one of the engine's own is missing which it calls for goes to `diagnostics`; of a program's own the schedule says
/// which take part.
pub fn resolve<'a>(
    names: Option<&[String]>,
    known: &'a Known<'_>,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Vec<Scheduled<'a>> {
    let Some(names) = names else {
        return known
            .systems()
            .filter_map(|system| {
                let because = (system.because)(world)?;
                Some(Scheduled::new(system, because, world))
            })
            .collect();
    };
    let mut schedule: Vec<Scheduled<'a>> = Vec::new();
    for system in names.iter().filter_map(|name| known.get(name)) {
        let because = (system.because)(world).filter(|_| !system.custom);
        let because = because.unwrap_or_else(|| "the scene's schedule names it".into());
        schedule.push(Scheduled::new(system, because, world));
    }
    for system in known.systems().filter(|system| !system.custom) {
        if let Some(because) = (system.because)(world)
            && !names.contains(&system.name)
        {
            let message = format!("no scheduled system serves what `{}` is for: {because}", system.name);
            diagnostics
                .error_at("schedule", message)
                .note(format!("add \"{}\" ({}), or leave `schedule` out to have it derived", system.name, system.does));
        }
    }
    schedule
}

const PHASES: [Phase; 9] = [
    Phase::Boundary,
    Phase::NodalMeans,
    Phase::ElementForces,
    Phase::Gather,
    Phase::Loads,
    Phase::Contact,
    Phase::Integrate,
    Phase::Removal,
    Phase::Observe,
];

fn phase_word(phase: Phase) -> &'static str {
    match phase {
        Phase::Boundary => "says where constrained nodes go",
        Phase::NodalMeans => "takes means around nodes",
        Phase::ElementForces => "fills in element forces",
        Phase::Gather => "sums forces at the nodes",
        Phase::Loads => "adds external forces",
        Phase::Contact => "keeps what touches apart",
        Phase::Integrate => "moves the nodes",
        Phase::Removal => "takes elements away",
        Phase::Observe => "only reads",
    }
}

fn phases() -> String {
    PHASES.map(|phase| format!("{phase:?}")).join(", ")
}
