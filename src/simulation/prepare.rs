//! What a scene comes to before a backend is chosen: its world, its step and its schedule.

use super::Options;
use super::known::Known;
use super::parameters::{hand_out, set_intervals};
use super::run::WHOLE;
use super::schedule::{Scheduled, check_names, resolve, takes_part};
use super::stable_step::{self, Stability};
use super::{contact_springs, outputs, plausible};
use crate::assembly::{Assembly, assemble, assemble_in_time, insert_laws};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::scene::schema::{Analysis, EquilibriumSearch, Solver};
use crate::scene::{Diagnostics, SceneFile};
use crate::systems::Registry;
use bevy_ecs::prelude::*;

/// What a scene comes to before a backend is chosen.
pub(super) struct Prepared<'a> {
    pub assembly: Assembly<'a>,
    pub clock: Clock,
    pub stability: Stability,
    pub steps: u64,
    pub schedule: Vec<Scheduled<'a>>,
}

/// Makes a scene's world and its schedule. All mistakes that can be found go to `diagnostics`. `springs`: those on
/// which bodies come to rest for a motion, where they are its own.
pub(super) fn prepare<'a>(
    scene: &'a SceneFile,
    (options, springs): (&Options, Option<SolvedSprings>),
    known: &'a Known<'_>,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<Prepared<'a>> {
    // what is shared among threads before elements are counted: distances of tools that are files
    let many = if scene.scene.tools.values().any(|tool| tool.mesh.is_some()) { usize::MAX } else { 0 };
    world.insert_resource(Cpu::new(options.threads, many, options.instructions));
    let assembly =
        assemble(scene, options.precision, options.scheme.unwrap_or_default(), known.laws(), world, diagnostics);
    known.check(diagnostics);
    check_names(scene.scene.schedule.as_deref().unwrap_or_default(), known, diagnostics);
    let assembly = assembly?;
    if options.grabs && !scene.scene.is_static() {
        let bodies: Vec<Entity> = assembly.bodies.values().map(|body| body.entity).collect();
        for &body in &bodies {
            world.spawn((Grabs::default(), OfBody(body)));
        }
        add_loads(&bodies, options.precision, world);
    }
    world.insert_resource(Cpu::new(options.threads, counts(&assembly).1, options.instructions));
    // what is stable depends on the laws, whose history waits for the step
    world.insert_resource(Clock::with_step(1.0));
    insert_laws(options.precision, world);
    // and on how stiff systems are, of which one's own know by their parameters
    hand_out(&scene.scene, known, world, diagnostics);
    let (clock, stability, steps) = clock((scene, springs), known, world, diagnostics)?;
    outputs::check(scene, &clock, steps, diagnostics);
    outputs::check_curves(scene, &clock, diagnostics);
    let names = scene.scene.schedule.as_deref();
    // a program's own systems may hold what they like
    let may_hold = names.is_some() || known.systems().any(|s| s.custom && takes_part(s, names, world));
    plausible::check(&assembly, may_hold, world, diagnostics);
    if !clock.velocities_at_ends && clock.relaxation.is_none() {
        contact_springs::check(&scene.scene, &stability, diagnostics);
    }
    world.insert_resource(clock);
    world.insert_resource(Observed(true));
    if clock.velocities_at_ends {
        world.insert_resource(TrialForces::default());
    }
    assemble_in_time(&assembly, world, diagnostics);
    let mut schedule = resolve(names, known, world, diagnostics);
    set_intervals(&scene.scene, clock.time_step, &mut schedule);
    if clock.velocities_at_ends || scene.scene.is_static_by_newton() {
        super::implicit::check(&schedule, diagnostics);
    }
    if clock.velocities_at_ends {
        super::implicit::check_moves(&schedule, diagnostics);
    }
    Some(Prepared { assembly, clock, stability, steps, schedule })
}

/// Checks a scene as far as making its world goes: everything except choosing a backend. All that was found.
pub(super) fn check(scene: &SceneFile, registry: &Registry) -> Diagnostics {
    let mut diagnostics = scene.diagnostics();
    let known = Known::of(registry, &scene.scene);
    prepare(scene, (&Options::default(), None), &known, &mut World::new(), &mut diagnostics);
    diagnostics
}

/// The clock with its step, what is known of the stable step, and how many steps the scene lasts.
fn clock(
    (scene, springs): (&SceneFile, Option<SolvedSprings>),
    known: &Known<'_>,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<(Clock, Stability, u64)> {
    if let Analysis::Static(EquilibriumSearch { max_steps, load_steps, at, .. }) = scene.scene.analysis {
        let bound = stable_step::found_bound(world, diagnostics)?;
        let load_steps = load_steps.unwrap_or_else(|| crate::assembly::load_steps(world));
        let ramp_rate = 1.0 / load_steps as f64;
        let relaxation = Relaxation {
            end: at.unwrap_or(scene.scene.duration),
            since: (0, 0.0),
            ramp_rate,
            damping: 0.0,
            force_scale: 1.0,
        };
        let own = SolvedSprings { step: bound.time_step, shared: false, forces: SpringForces::Stepped };
        let springs = scene.scene.rests_on_springs().then(|| springs.unwrap_or(own));
        let clock =
            Clock { relaxation: Some(relaxation), springs, ..Clock::with_step(scene.scene.duration * ramp_rate) };
        return Some((clock, Stability::of_rest(bound), max_steps));
    }
    if let Solver::Implicit { scheme, step, adaptive, .. } = scene.scene.solver {
        let bound = stable_step::found_bound(world, diagnostics)?;
        let steps = scene.scene.duration / step;
        // chosen steps end where the scene does
        let steps = if adaptive.is_some() { (steps - WHOLE).ceil() } else { steps.round() }.max(1.0) as u64;
        let touches = !scene.scene.contacts.is_empty() || !scene.scene.attachments.is_empty();
        let springs =
            touches.then_some(SolvedSprings { step: bound.time_step, shared: false, forces: SpringForces::Tried });
        let clock = Clock { velocities_at_ends: true, springs, ..Clock::with_step(step) };
        return Some((clock, Stability::of_implicit(bound, step, scheme), steps));
    }
    let (stability, time_step, steps) = stable_step::choose(scene, known, world, diagnostics)?;
    Some((Clock::with_step(time_step), stability, steps))
}

/// Nodes and elements of all bodies.
pub(super) fn counts(assembly: &Assembly<'_>) -> (usize, usize) {
    let sum = |of: &dyn Fn(&crate::mesh::Mesh) -> usize| assembly.bodies.values().map(|b| of(&b.placed.mesh)).sum();
    (sum(&|mesh| mesh.points.len()), sum(&|mesh| mesh.element_count()))
}

/// Columns of external forces of bodies that have none.
pub(super) fn add_loads(bodies: &[Entity], precision: Precision, world: &mut World) {
    for &body in bodies {
        let length = world.get::<Displacement>(body).map_or(0, |u| u.len());
        if world.get::<ExternalForce>(body).is_none() {
            world.entity_mut(body).insert(ExternalForce(Reals::zeros(precision, length)));
        }
    }
}
