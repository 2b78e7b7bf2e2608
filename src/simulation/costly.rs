//! Elements and loads that make the step much smaller than usual elements need are told of, with what would help.

use super::load_rates::LoadRates;
use super::mass_scaling;
use super::stable_step::Stability;
use crate::assembly::CriticalElement;
use crate::components::{Sutured, Sutures};
use crate::scene::Diagnostics;
use bevy_ecs::prelude::*;

/// What makes the step so many times smaller than a usual element needs is told of.
const COSTLY: f64 = 10.0;
/// What helps makes the step so many times larger.
const HELPS: f64 = 1.5;
/// The share of mass that is proposed to be added.
const PROPOSED: f64 = 0.05;

/// Warns of them, where the step that is taken is so small: what the highest frequency of all shows to be harmless is
/// not told of.
pub(super) fn warn_of_costly(stability: &Stability, world: &mut World, diagnostics: &mut Diagnostics) {
    let (bound, stable, limit) = (&stability.bound, stability.stable_of_bodies, stability.limit_of_bodies);
    if stable >= COSTLY * stability.stable_step
        && let Some(told) = stability.loads.told(stable)
    {
        let (place, way_out) = source(&stability.loads, world);
        diagnostics.warn_at(place, told).note(way_out);
    }
    let cost = bound.usual / stable;
    if cost.is_nan() || cost < COSTLY {
        return;
    }
    let (body, element) = bound.critical();
    let with_mass = mass_scaling::step_for(world, PROPOSED, bound.time_step, bound.usual);
    let warning = diagnostics.warn_at(
        "bodies",
        format!(
            "element {element} of {body} makes the step {cost:.0} times smaller than half of the tissue needs: {stable:.2e} s \
             instead of {:.2e} s",
            bound.usual
        ),
    );
    for worst in &bound.worst {
        warning.note(critical(worst));
    }
    if limit >= HELPS * stable {
        warning.note(format!(
            "by the highest frequency of all elements together {limit:.2e} s are stable: `bound: Iterated` takes that"
        ));
    } else if stability.found_from == "iterated" {
        warning.note("that is by the highest frequency of all elements together; by these alone it would be smaller");
    }
    let best = limit.max(stable);
    if with_mass >= HELPS * best {
        warning.note(format!(
            "{} % of added mass would allow {with_mass:.2e} s: integration: (when_unstable: ScaleMass())",
            100.0 * PROPOSED
        ));
    }
    warning.note("look at the mesh and the material there");
}

/// Where in a scene the forces stand that grow so fast, and what to do about it: the stiffest thread, where threads
/// make the most of it.
fn source(loads: &LoadRates, world: &mut World) -> (String, &'static str) {
    let of_nodes = |sutured: &Sutured| {
        let each = sutured.stiffness.iter().zip(&sutured.masses).filter(|(_, mass)| **mass > 0.0);
        each.map(|(stiffness, mass)| stiffness / mass).fold(0.0, f64::max)
    };
    let of_threads = world.query::<&Sutured>().iter(world).map(of_nodes).fold(0.0, f64::max);
    let threads = world.get_resource::<Sutures>().into_iter().flat_map(|sutures| &sutures.all);
    match threads.max_by(|a, b| a.stiffness.total_cmp(&b.stiffness)) {
        // of what counts for the step: some twice of what they are
        Some(thread) if 4.0 * of_threads > loads.stiffness() => (
            format!("attachments[{}].stiffness", thread.number),
            "give the thread less `stiffness`, or the mesh larger elements",
        ),
        _ => ("systems".to_string(), "make their forces change less from place to place, or the mesh coarser"),
    }
}

/// An element that sets the step, in a line.
fn critical(worst: &CriticalElement) -> String {
    let CriticalElement { body, element, bound, cost, gain } = worst;
    format!(
        "element {element} of {body}: stable up to {bound:.3e} s, {cost:.4} times below the usual; without it and those \
         before it the step could be {gain:.4} times longer"
    )
}
