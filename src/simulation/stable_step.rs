//! The step of a scene: what is stable at the start, and what of it is taken.

use super::costly::warn_of_costly;
use super::damped_step::with_damping;
use super::follow::Follower;
use super::follow::step_of;
use super::frequency::{Largest, PRODUCT, largest_eigenvalue, largest_worth};
use super::known::Known;
use super::load_rates::LoadRates;
use super::nodal::bound_at_rest;
use super::schedule::takes_part;
use super::tangent::Tangent;
use super::{Simulation, added_mass};
use crate::assembly::{StableStep, stable_step};
use crate::backend::device::bring_to_host;
use crate::components::column_is;
use crate::error::Error;
use crate::scene::schema::{
    Constraint, Curve, ImplicitScheme, InitialState, Inversion, Scene, StepBound, WhenUnstable,
};
use crate::scene::{Diagnostics, SceneFile};
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::Serialize;
use std::f64::consts::TAU;

/// The true limit is known to the share of half of this.
pub(super) const ACCURACY: f64 = 0.04;
/// The same where a scene's own step lies within the margin.
const SHARP: f64 = 0.005;

/// What is known of the stable step at the start.
#[derive(Clone, Debug, Serialize)]
pub struct Stability {
    /// The bound, and the elements that set it.
    pub bound: StableStep,
    /// The bound by nodes (s): elements weighed by their mass where they meet, never below that of the stiffest
    /// element. `None` in a static analysis.
    pub by_nodes: Option<f64>,
    /// The largest stable step that is known of all bodies as they are held (s): never above the true limit. `None` in
    /// a static analysis, whose steps are no motion.
    pub limit: Option<f64>,
    /// A step that is beyond the true limit for certain, or at it (s), where the highest frequency was sought: with 48
    /// products `limit` is at least 0.97 of it.
    pub beyond: Option<f64>,
    /// Products with the stiffness by which the highest frequency was sought; 0: it was not.
    pub products: usize,
    /// What the step was found from: `elements`, `nodes`, `iterated`, or `scene` where it is the scene's own.
    pub found_from: &'static str,
    /// Why from that.
    pub because: String,
    /// The stable step by that (s).
    pub stable_step: f64,
    /// The first step that is taken (s).
    pub step: f64,
    /// Whether the step stays with what the elements alone allow.
    #[serde(skip)]
    pub(super) stays_with_elements: bool,
    /// What forces on nodes make of the step; `limit`, `stable_step` and `step` are with them.
    #[serde(skip)]
    pub(super) loads: LoadRates,
    /// `limit` without them (s).
    #[serde(skip)]
    pub(super) limit_of_bodies: f64,
    /// `stable_step` without them (s).
    #[serde(skip)]
    pub(super) stable_of_bodies: f64,
}

impl Stability {
    /// What the step was found from.
    pub fn in_words(&self) -> &'static str {
        match self.found_from {
            "iterated" => "the highest frequency of all elements",
            "nodes" => "the bound by nodes",
            "scene" => "the scene",
            _ => "the stiffest element",
        }
    }

    /// Of implicit steps, which are stable at any length.
    pub(super) fn of_implicit(bound: StableStep, step: f64, scheme: ImplicitScheme) -> Self {
        let leaves = match scheme {
            ImplicitScheme::Euler => "at most 0.7 of it a step".to_string(),
            ImplicitScheme::GeneralizedAlpha { high_frequencies } => {
                format!("{high_frequencies} of the highest frequencies a step")
            }
        };
        let because = format!(
            "implicit ones are stable at any length; this is {:.0} times what explicit steps of the stiffest element may \
             be; what swings faster than {:.3} Hz it does not resolve, and leaves {leaves}",
            step / bound.time_step,
            1.0 / (TAU * step)
        );
        Self { step, found_from: "scene", because, ..Self::of_rest(bound) }
    }

    /// Of a static analysis.
    pub(super) fn of_rest(bound: StableStep) -> Self {
        Self {
            stable_step: bound.time_step,
            step: 0.0,
            bound,
            by_nodes: None,
            limit: None,
            beyond: None,
            products: 0,
            found_from: "elements",
            because: "steps to rest are no motion".into(),
            stays_with_elements: true,
            loads: LoadRates::default(),
            limit_of_bodies: 0.0,
            stable_of_bodies: 0.0,
        }
    }
}

/// The true limit of the present state, from below (s).
pub(super) fn limit_now(world: &mut World, accuracy: f64) -> Option<f64> {
    largest_eigenvalue(world, accuracy).map(|found| step_of(with_damping(found, world).at_most))
}

impl Simulation {
    /// The largest step that is stable at the present state (s), by the highest frequency of all bodies as they are
    /// held: never above the true limit, and at least 0.97 of it. `None` where nothing can move. Costs some hundred
    /// steps.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn stable_limit(&mut self) -> Result<Option<f64>, Error> {
        bring_to_host(&mut self.world, |_, name| column_is(name, Tangent::reads))?;
        let loads = self.solver.follower().map_or(self.facts.stability.loads, Follower::loads);
        Ok(limit_now(&mut self.world, ACCURACY).map(|limit| loads.with(limit)))
    }
}

/// The stable step of a scene whose world has its laws and the parameters of its systems, its step and the number of
/// its steps.
pub(super) fn choose(
    scene: &SceneFile,
    known: &Known<'_>,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<(Stability, f64, u64)> {
    let bound = found_bound(world, diagnostics)?;
    let integration = &scene.scene.integration;
    // what the elements are stable up to, once they are made heavier where the scene wants that
    let scaled = match scene.scene.when_unstable() {
        WhenUnstable::ScaleMass { most } => added_mass::at_the_start(scene, &bound, most, world, diagnostics)?,
        _ => bound.time_step,
    };
    // rounding of means must not take what the elements alone allow
    let by_nodes = step_of(bound_at_rest(world));
    // where nothing moves by itself, anything is stable: the elements' step is as good as any
    let certain = if by_nodes.is_finite() { by_nodes.max(scaled) } else { scaled };
    let stays = reason_to_stay(&scene.scene);
    if integration.bound == StepBound::Iterated
        && scene.scene.when_unstable() == WhenUnstable::Adapt
        && let Some(reason) = stays
    {
        diagnostics
            .warn_at("integration.bound", reason)
            .note("`bound: Auto` stays with the stiffest element, which is safe");
    }
    let names = scene.scene.schedule.as_deref();
    let running: Vec<_> = known.systems().filter(|system| !system.custom || takes_part(system, names, world)).collect();
    let loads = LoadRates::of(running.into_iter(), scene.scene.duration, world);
    // what cannot be found is an error of the scene, which may have more
    let loads = loads.inspect_err(|error| _ = diagnostics.error(error.to_string())).unwrap_or_default();
    let found = seek(&scene.scene, certain, stays.is_none(), &loads, world);
    // the bounds are certain as well: at rest the best of all
    let limit = step_of(found.at_most).max(certain);
    let (found_from, stable_step) = match integration.bound {
        StepBound::Elements => ("elements", scaled),
        StepBound::Auto if stays.is_some() => ("elements", scaled),
        _ if limit > certain => ("iterated", limit),
        _ if certain > scaled => ("nodes", certain),
        _ => ("elements", scaled),
    };
    let found_from = if integration.step.is_some() { "scene" } else { found_from };
    let mut because = because(&scene.scene, certain, stable_step, &found, stays);
    because.extend(loads.told(stable_step).map(|told| format!("; {told}")));
    let stability = Stability {
        bound,
        by_nodes: Some(certain),
        limit: Some(loads.with(limit)),
        beyond: (found.at_least > 0.0).then(|| loads.with(step_of(found.at_least))),
        products: found.products,
        found_from,
        because,
        stable_step: loads.with(stable_step),
        step: 0.0,
        stays_with_elements: match integration.bound {
            StepBound::Elements => true,
            StepBound::Auto => stays.is_some(),
            StepBound::Iterated => false,
        },
        loads,
        limit_of_bodies: limit,
        stable_of_bodies: stable_step,
    };
    let (time_step, steps) = taken(&scene.scene, &stability, diagnostics);
    let stability = Stability { step: time_step, ..stability };
    if integration.step.is_none() {
        warn_of_costly(&stability, world, diagnostics);
    }
    if steps.is_nan() || steps > 1e15 {
        let duration = scene.scene.duration;
        diagnostics.error_at(
            "duration",
            format!("{duration} s are {steps:.1e} steps of {time_step:.3e} s; at most 1e15 are allowed"),
        );
        return None;
    }
    Some((stability, time_step, steps as u64))
}

/// Why `bound: Auto` stays with what the elements allow: what needs the room between that and the true limit.
fn reason_to_stay(scene: &Scene) -> Option<&'static str> {
    let removes = scene.materials.values().any(|material| material.inversion() == Inversion::Remove);
    let at_rest = scene.start != InitialState::default();
    let jump = |curve: &Curve| match curve {
        Curve::Step { .. } | Curve::Input { rate: None, .. } => true,
        // from rest to there in the first step
        Curve::Input { initial, .. } => *initial != 0.0 && !at_rest,
        _ => false,
    };
    let jumps = |constraint: &Constraint| match constraint {
        Constraint::Prescribed { curve, displacement, gradient, rotation, .. } if jump(curve) => {
            gradient.iter().chain([displacement, rotation]).any(|moved| *moved != DVec3::ZERO)
        }
        _ => false,
    };
    match scene.when_unstable() {
        WhenUnstable::Adapt if scene.constraints.iter().any(jumps) => {
            Some("nodes are moved by a jump, which wakes the highest frequencies there are")
        }
        WhenUnstable::Adapt if removes || !scene.removal.is_empty() => {
            Some("elements that are removed take their mass with them, which raises the highest frequency at once")
        }
        WhenUnstable::Adapt => None,
        WhenUnstable::Watch => Some("the step does not follow where frequencies rise (when_unstable: Watch)"),
        WhenUnstable::ScaleMass { .. } => Some("elements are made heavier one by one (when_unstable: ScaleMass)"),
        WhenUnstable::Remove => Some("elements go that need a smaller step (when_unstable: Remove)"),
    }
}

/// The highest frequency of all bodies as they are held, as well as the scene needs it; `certain` (s) is stable anyway.
fn seek(scene: &Scene, certain: f64, adapts: bool, loads: &LoadRates, world: &mut World) -> Largest {
    let integration = &scene.integration;
    let nothing = Largest { at_least: 0.0, at_most: f64::INFINITY, products: 0 };
    let found = match (integration.step, integration.bound) {
        // certainly stable: nothing depends on more
        (Some(step), StepBound::Auto) if step <= loads.with(certain) && adapts => return nothing,
        (None, StepBound::Auto) if adapts => {
            let steps = |at_most: f64| scene.duration / (integration.safety * step_of(at_most).max(certain));
            largest_worth(world, ACCURACY, Some(&steps))
        }
        _ => largest_eigenvalue(world, ACCURACY),
    };
    let found = with_damping(found.unwrap_or(nothing), world);
    // a step of the scene's own may lie within the margin
    match integration.step {
        Some(step)
            if step > loads.with(step_of(found.at_most).max(certain)) && step < loads.with(step_of(found.at_least)) =>
        {
            largest_eigenvalue(world, SHARP).map_or(found, |sharp| with_damping(sharp, world))
        }
        _ => found,
    }
}

/// Why the step is found from what it is found from.
fn because(scene: &Scene, certain: f64, stable_step: f64, found: &Largest, stays: Option<&str>) -> String {
    let integration = &scene.integration;
    if integration.step.is_some() {
        return "its own step".into();
    }
    match (integration.bound, stays) {
        (StepBound::Elements, _) => "bound: Elements".into(),
        (StepBound::Iterated, _) => "bound: Iterated".into(),
        (StepBound::Auto, Some(reason)) => reason.into(),
        (StepBound::Auto, None) => {
            let steps = |stable: f64| (scene.duration / (integration.safety * stable)).ceil();
            let costs = PRODUCT * found.products as f64;
            match stable_step > certain {
                true => format!(
                    "{:.0} steps in place of {:.0}, for {} products with the stiffness, which cost about {costs:.0}",
                    steps(stable_step),
                    steps(certain),
                    found.products
                ),
                false => format!(
                    "{:.0} steps are too few for the highest frequency to be worth seeking further ({} products)",
                    steps(certain),
                    found.products
                ),
            }
        }
    }
}

/// The bound of all elements, if it is one.
pub(super) fn found_bound(world: &mut World, diagnostics: &mut Diagnostics) -> Option<StableStep> {
    let Some(bound) = stable_step(world) else {
        diagnostics.error_at("bodies", "there are no elements to simulate");
        return None;
    };
    if !(bound.time_step.is_finite() && bound.time_step > 0.0) {
        let (body, element) = bound.critical();
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
        let (body, element) = stability.bound.critical();
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
