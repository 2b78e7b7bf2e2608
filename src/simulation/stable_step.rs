//! The step of a scene: what is stable at the start, and what of it is taken.

use super::frequency::largest_eigenvalue;
use super::tangent::Tangent;
use super::{Simulation, mass_scaling};
use crate::assembly::{StableStep, StepSetter, square_frequencies, stable_step};
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::{Scene, StepBound, WhenUnstable};
use crate::scene::{Diagnostics, SceneFile};
use bevy_ecs::prelude::*;
use serde::Serialize;

/// The true limit is known to the share of half of this.
pub(super) const ACCURACY: f64 = 0.04;
/// The same where a scene's own step lies within the margin.
const SHARP: f64 = 0.005;
/// Elements that make the step so many times smaller than a usual one needs are told of.
const COSTLY: f64 = 10.0;
/// More added mass than this share is always told of.
const WORTH_TELLING: f64 = 0.05;

/// What is known of the stable step at the start.
#[derive(Clone, Debug, Serialize)]
pub struct Stability {
    /// The bound, and the elements that set it.
    pub bound: StableStep,
    /// The largest stable step by the highest frequency of all bodies as they are held (s): never above the true limit,
    /// and at least 0.97 of it. `None` in a static analysis, whose steps are no motion.
    pub limit: Option<f64>,
    /// What the step was found from: `elements` or `iterated`.
    pub found_from: &'static str,
    /// The stable step by that (s).
    pub stable_step: f64,
    /// The first step that is taken (s).
    pub step: f64,
}

impl Stability {
    /// Of a static analysis.
    pub fn of_rest(bound: StableStep) -> Self {
        Self { stable_step: bound.time_step, step: 0.0, bound, limit: None, found_from: "elements" }
    }
}

/// The largest step that is stable at the present state (s), from below, and what cannot be far above it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Never above the true limit.
    pub safe: f64,
    /// Never below it.
    pub certainly_unstable: f64,
}

/// The true limit of the present state; the bound of the elements is taken where it is better.
pub(super) fn limits(world: &mut World, accuracy: f64) -> Option<Limits> {
    let found = largest_eigenvalue(world, accuracy)?;
    Some(Limits { safe: 2.0 / found.at_most.sqrt(), certainly_unstable: 2.0 / found.at_least.sqrt() })
}

impl Simulation {
    /// The largest step that is stable at the present state (s), by the highest frequency of all bodies as they are held:
    /// never above the true limit, and at least 0.97 of it. `None` where nothing can move. Costs some hundred steps.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn stable_limit(&mut self) -> Result<Option<f64>, Error> {
        bring_to_host(&mut self.world, |_, name| Tangent::COLUMNS.contains(&name))?;
        Ok(limits(&mut self.world, ACCURACY).map(|found| found.safe))
    }
}

/// The stable step of a scene whose world has its laws, its step and the number of its steps.
pub(super) fn choose(
    scene: &SceneFile,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<(Stability, f64, u64)> {
    let bound = found_bound(world, diagnostics)?;
    warn_of_costly(&bound, diagnostics);
    let integration = &scene.scene.integration;
    // what the elements are stable up to, once they are made heavier where the scene wants that
    let heavier = match scene.scene.when_unstable() {
        WhenUnstable::ScaleMass { most } => scale_mass(scene, &bound, most, world, diagnostics),
        _ => bound.time_step,
    };
    let mut limits = limits(world, ACCURACY);
    // a step of the scene's own may lie within the margin
    if let (Some(step), Some(known)) = (integration.step, &limits)
        && step > known.safe.max(heavier)
        && step < known.certainly_unstable
    {
        limits = self::limits(world, SHARP);
    }
    // the bound is certain as well: at rest the better of both counts
    let limit = limits.map_or(heavier, |found| found.safe.max(heavier));
    let (found_from, stable_step) = match integration.bound {
        StepBound::Elements => ("elements", heavier),
        StepBound::Iterated => ("iterated", limit),
    };
    let mut stability = Stability { bound, limit: Some(limit), found_from, stable_step, step: 0.0 };
    let (time_step, steps) = taken(&scene.scene, &stability, diagnostics);
    stability.step = time_step;
    if steps > 1e15 {
        let duration = scene.scene.duration;
        diagnostics.error_at(
            "duration",
            format!("{duration} s are {steps:.1e} steps of {time_step:.3e} s; at most 1e15 are allowed"),
        );
        return None;
    }
    Some((stability, time_step, steps as u64))
}

/// Makes elements heavier for the step that the scene wants, or for the largest that so much added mass allows. What all
/// elements are stable up to then (s).
fn scale_mass(
    scene: &SceneFile,
    bound: &StableStep,
    most: f64,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> f64 {
    let integration = &scene.scene.integration;
    let wanted = match integration.step {
        Some(step) => (step / integration.safety).max(bound.time_step),
        None => mass_scaling::step_for(world, most, bound.time_step, bound.usual),
    };
    let precision = match world.query::<&Mass>().iter(world).next() {
        Some(Mass(Reals::F32(_))) => Precision::F32,
        _ => Precision::F64,
    };
    mass_scaling::insert_columns(precision, world);
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    for block in blocks {
        let squares = square_frequencies(world, block).into_iter().enumerate();
        let bounds: Vec<(usize, f64)> = squares.map(|(row, (square, _))| (row, 2.0 / square.sqrt())).collect();
        mass_scaling::make_heavier(world, block, &bounds, wanted);
    }
    let added = mass_scaling::weigh(world).mass;
    let all: f64 =
        world.query::<&Mass>().iter(world).map(|mass| (0..mass.len()).map(|i| mass.get(i)).sum::<f64>()).sum();
    let share = added / all;
    // rounding of what just fits is no reason to warn
    if share > most * (1.0 + 1e-6) || share > WORTH_TELLING {
        diagnostics
            .warn_at(
                "integration.when_unstable",
                format!("{added:.3e} kg are added for a stable step of {wanted:.3e} s: {:.1} % of all mass", 100.0 * share),
            )
            .note(format!(
                "motion is slowed where mass is added; a smaller `step` needs less, and without `step` no more than `most` \
                 ({most}) is added"
            ));
    }
    wanted
}

/// The bound of all elements, if it is one.
pub(super) fn found_bound(world: &mut World, diagnostics: &mut Diagnostics) -> Option<StableStep> {
    let Some(bound) = stable_step(world) else {
        diagnostics.error_at("bodies", "there are no elements to simulate");
        return None;
    };
    if !(bound.time_step.is_finite() && bound.time_step > 0.0) {
        let (body, element) = bound.culprit();
        let message = format!(
            "no stable time step can be found: element {element} of {body} has a bound of {} s",
            bound.time_step
        );
        diagnostics.error_at("materials", message);
        return None;
    }
    Some(bound)
}

/// The step and how many of them the scene lasts.
fn taken(scene: &Scene, stability: &Stability, diagnostics: &mut Diagnostics) -> (f64, f64) {
    let (integration, duration) = (&scene.integration, scene.duration);
    let Some(step) = integration.step else {
        // the scene ends with a whole step
        let steps = (duration / (integration.safety * stability.stable_step)).ceil().max(1.0);
        return (duration / steps, steps);
    };
    let limit = stability.limit.unwrap_or(stability.stable_step);
    // what needs a smaller step goes before it does harm
    if step > limit && scene.when_unstable() != WhenUnstable::Remove {
        let (body, element) = stability.bound.culprit();
        let message = format!(
            "a step of {step} s is beyond the stable one of {limit:.4e} s (the stiffest is element {element} of {body})"
        );
        if integration.beyond_stable_step {
            diagnostics.warn_at("integration.step", message);
        } else {
            diagnostics
                .error_at("integration.step", message)
                .note("leave `step` out to have it found, or insist with beyond_stable_step: true");
        }
    }
    (step, (duration / step).round().max(1.0))
}

/// Warns of elements that cost much more than usual ones.
fn warn_of_costly(bound: &StableStep, diagnostics: &mut Diagnostics) {
    if bound.cost() < COSTLY {
        return;
    }
    let (body, element) = bound.culprit();
    let warning = diagnostics.warn_at(
        "bodies",
        format!(
            "element {element} of {body} makes the step {:.0} times smaller than half of the tissue needs: {:.2e} s instead \
             of {:.2e} s",
            bound.cost(),
            bound.time_step,
            bound.usual
        ),
    );
    for worst in &bound.worst {
        warning.note(setter(worst));
    }
    warning.note(
        "look at the mesh and the material there, or have such elements made heavier: integration: (when_unstable: ScaleMass())",
    );
}

/// An element that sets the step, in a line.
fn setter(worst: &StepSetter) -> String {
    let StepSetter { body, element, bound, cost, gain } = worst;
    format!(
        "element {element} of {body}: stable up to {bound:.3e} s, {cost:.4} times below the usual; without it and those \
         before it the step could be {gain:.4} times longer"
    )
}
