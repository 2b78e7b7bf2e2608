//! Elements and loads that make the step much smaller than usual elements need are told of, with what would help.

use super::mass_scaling;
use super::stable_step::Stability;
use crate::assembly::CriticalElement;
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
        diagnostics
            .warn_at("systems", told)
            .note("make their forces change less from place to place, or the mesh coarser");
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

/// An element that sets the step, in a line.
fn critical(worst: &CriticalElement) -> String {
    let CriticalElement { body, element, bound, cost, gain } = worst;
    format!(
        "element {element} of {body}: stable up to {bound:.3e} s, {cost:.4} times below the usual; without it and those \
         before it the step could be {gain:.4} times longer"
    )
}
