//! What implicit steps cannot do yet, of what a scene's schedule names.

use super::super::schedule::Scheduled;
use crate::scene::Diagnostics;
use crate::systems::{OnHost, Phase};

/// Refuses what moves nodes where a schedule of the scene's own names it. It shares a pass with forces, which would not
/// be taken then.
pub(in crate::simulation) fn check_moves(schedule: &[Scheduled<'_>], diagnostics: &mut Diagnostics) {
    let moves = |entry: &&Scheduled<'_>| entry.system.host.nodes().is_some_and(|rows| rows.moves_nodes);
    for entry in schedule.iter().filter(moves).filter(|entry| !entry.system.custom) {
        let name = &entry.system.name;
        diagnostics
            .error_at("schedule", format!("`{name}` takes no part in implicit steps: the solver moves the nodes"))
            .note(format!("leave \"{name}\" out, or use `solver: Explicit`"));
    }
}

/// Refuses systems of one's own that must run once a step where implicit steps take forces many times.
pub(in crate::simulation) fn check(schedule: &[Scheduled<'_>], diagnostics: &mut Diagnostics) {
    for entry in schedule.iter().filter(|entry| entry.system.custom && entry.system.phase <= Phase::Integrate) {
        let name = &entry.system.name;
        let why = match &entry.system.host {
            OnHost::Nodes(rows) if rows.moves_nodes => "it moves nodes, which the solver does",
            OnHost::Nodes(rows) if rows.own_numbers > 0 => "it keeps numbers from step to step (OWN_NUMBERS)",
            OnHost::Nodes(_) if entry.every == 1 && entry.interval.is_none() => continue,
            _ => "implicit steps take forces many times, and it may count them",
        };
        diagnostics
            .error_at("schedule", format!("`{name}` cannot take part in implicit steps: {why}"))
            .note("allowed: node systems without numbers of their own; or `solver: Explicit`");
    }
}
