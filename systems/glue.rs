//! `glue`: points of bodies stay where they are tied to faces, until that breaks.

mod kernels;
mod solved;
mod work;

use super::node_slices::{MetColumns, SlicedColumns, elements_stay};
use super::repeat::Repeat;
use super::system::{Phase, System};
use crate::backend::cpu::IntegrationCoefficients;
use crate::components::*;
use crate::error::{Error, missing};
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use glam::DVec3;
pub(crate) use solved::find as find_ties;
use work::Work;

/// Like `surface_contact`, with vectors and both signs: each node's next step is predicted, of what closed tools hold
/// as they take it, and the forces are found that let points end where they are on their faces (see
/// [`TieSet::solve`](crate::contact::TieSet::solve)), and are added to the loads. There is no stiffness to choose, and
/// the stable step stays as it is. A tie whose force is too large for it breaks in that step, and bears nothing any
/// more.
pub fn system() -> System {
    let system = System::built_in(
        "glue",
        Phase::Contact,
        "holds points where they are tied to faces",
        "`Glue(...)` or `Tie(...)` under `attachments`",
        |world| {
            let count = world.get_resource::<Glue>()?.ties.len();
            Some(if count == 1 { "1 point that is tied".to_string() } else { format!("{count} points that are tied") })
        },
        glue,
    );
    // ties whose tissue may go are looked after on the host
    System {
        device_when: nothing_goes,
        shared_only: on_surfaces,
        repeats: sweeps,
        ..system.on_device(kernels::kernels)
    }
}

/// What corrects the forces.
fn sweeps(world: &World) -> Option<Repeat> {
    Repeat::several(world.get_resource::<Glue>()?.sweeps, &["forces of ties", "what they do to nodes"])
}

/// Whether no tissue of what is tied can go.
fn nothing_goes(world: &World) -> bool {
    let bodies = |glue: &Glue| -> Vec<Entity> {
        glue.ties.iter().flat_map(|tie| tie.bodies).map(|body| glue.bodies[body]).collect()
    };
    world.get_resource::<Glue>().is_some_and(|glue| elements_stay(bodies(glue), world))
}

/// Whether all nodes of what is tied are those of surfaces that no patch moves by itself.
fn on_surfaces(world: &World) -> bool {
    let is_apart = |glue: &Glue, (body, row): (usize, u32)| {
        let rows = world.get::<SurfaceRows>(glue.bodies[body]);
        rows.is_some_and(|rows| rows.0.binary_search(&row).is_ok())
    };
    world.get_resource::<Glue>().is_some_and(|glue| work::nodes_of(glue).into_iter().all(|node| is_apart(glue, node)))
}

/// What a tie is, in [`TieState`].
const HOLDS: f64 = 0.0;
const BROKE: f64 = 1.0;
const WENT: f64 = 2.0;

/// What is known of a body.
#[derive(QueryData)]
#[query_data(mutable)]
struct TiedColumns {
    nodes: SlicedColumns,
    /// Where tools may hold its nodes.
    grip: Option<(&'static Grasps, &'static ToolHold)>,
    met: MetColumns,
    state: Option<&'static mut TieState>,
}

fn glue(
    (clock, signals): (Res<Clock>, Res<Signals>),
    glue: Res<Glue>,
    mut work: Local<Work>,
    mut bodies: Query<TiedColumns>,
    blocks: Query<&Alive>,
) -> Result<(), Error> {
    if glue.is_changed() {
        *work = Work::of(&glue);
    }
    match bodies.iter().next().map(|columns| columns.nodes.u.precision()) {
        Some(Precision::F32) => step::<f32>((&clock, &signals), &glue, &mut work, (&mut bodies, &blocks)),
        Some(Precision::F64) => step::<f64>((&clock, &signals), &glue, &mut work, (&mut bodies, &blocks)),
        None => Ok(()),
    }
}

fn step<T: Scalar>(
    (clock, signals): (&Clock, &Signals),
    glue: &Glue,
    work: &mut Work,
    (bodies, blocks): (&mut Query<TiedColumns>, &Query<&Alive>),
) -> Result<(), Error> {
    let coefficients = IntegrationCoefficients::<f64>::of(clock);
    if !work.place::<T>(glue, (&coefficients, signals), bodies) {
        return Err(missing("a column of a body"));
    }
    for (number, tie) in glue.ties.iter().enumerate() {
        work.set.ties[number].holds = false;
        let Some(mut state) = state_of(tie, glue, bodies) else { continue };
        if state.get(TIE_NUMBERS * tie.place) != HOLDS {
            continue;
        }
        let alive = blocks.get(tie.element.0).ok();
        if alive.is_none_or(|alive| alive[tie.element.1 as usize] == 1) && work.has_mass(number, tie) {
            work.begin(number, tie);
        } else {
            breaks(&mut state, TIE_NUMBERS * tie.place, WENT, clock);
        }
    }
    // pseudo-steps to rest hold what is tied as explicit steps do
    match clock.springs.filter(|springs| springs.forces != SpringForces::Stepped) {
        Some(springs) => work.press(&springs),
        None => work.set.solve(glue.sweeps),
    }
    // forces that are only tried leave everything as it is
    let noted = clock.springs.is_none_or(|springs| springs.forces.are_noted());
    let counts_work = clock.relaxation.is_none().then_some(coefficients.work_factor);
    let counts_before = work_factor_before(clock, coefficients.work_factor);
    work.forces.fill(DVec3::ZERO);
    for (number, tie) in glue.ties.iter().enumerate().filter(|(number, _)| work.set.ties[*number].holds) {
        let solved = &work.set.ties[number];
        let Some(mut state) = state_of(tie, glue, bodies) else { continue };
        let at = TIE_NUMBERS * tie.place;
        let counted_before = state.vector_at(at + 2) * counts_before;
        // in a static analysis nothing breaks: pseudo-steps are no way that bodies take
        let breaks_now = noted && counts_work.is_some() && tie.strength.is_exceeded(solved.force, work.outs[number]);
        if breaks_now && clock.springs.is_none() {
            takes(&mut state, at, counted_before, solved.relative(&work.before));
            breaks(&mut state, at, BROKE, clock);
            continue;
        }
        solved.parts.iter().for_each(|&(node, weight)| work.forces[node as usize] += solved.force * weight);
        if !noted {
            continue;
        }
        state.set_vector_at(at + 2, solved.force);
        if breaks_now {
            // the step was found with its force
            breaks(&mut state, at, BROKE, clock);
        }
        // what an explicit step comes to is only known after it: of the last one, both ends have their forces now
        let (before, after) = (solved.relative(&work.before), solved.relative(&work.set.steps));
        let relative = if clock.springs.is_some() { 0.5 * (before + after) } else { before };
        if let Some(work_factor) = counts_work {
            takes(&mut state, at, counted_before + solved.force * work_factor, relative);
        }
    }
    // in implicit steps contact counts what it takes by where nodes have gone
    work.push(glue, counts_work.filter(|_| clock.springs.is_none()), bodies);
    Ok(())
}

fn state_of<'a>(tie: &TiedPoint, glue: &Glue, bodies: &'a mut Query<TiedColumns>) -> Option<Mut<'a, TieState>> {
    bodies.get_mut(glue.bodies[tie.bodies[0]]).ok()?.state
}

/// What is counted of the work of the last step's forces, by the factor of this step: they acted from the middle of a
/// step to the middle of the next, in the first step for half as long, and Δt may have changed since. Of an implicit
/// step forces at both ends count alike.
fn work_factor_before(clock: &Clock, work_factor: f64) -> f64 {
    if clock.springs.is_some() {
        return work_factor;
    }
    let share = if clock.step == 1 { 0.5 } else { 1.0 };
    share * (2.0 * work_factor - 1.0)
}

/// Counts what a tie takes in a step of its point against the face (m), by the sum of its forces at both ends (N), each
/// as far as its work is counted.
fn takes(state: &mut TieState, at: usize, forces: DVec3, step: DVec3) {
    let sum = state.get(at + 5) - 0.5 * forces.dot(step);
    state.set(at + 5, sum);
}

fn breaks(state: &mut TieState, at: usize, how: f64, clock: &Clock) {
    state.set(at, how);
    state.set(at + 1, clock.time());
    state.set_vector_at(at + 2, DVec3::ZERO);
}
