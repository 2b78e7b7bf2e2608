//! `suture_tension`: how hard sutures pull, and which of them tear.

mod kernels;
mod solved;

use super::node_slices::elements_stay;
use super::system::{Phase, System};
use crate::components::*;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use glam::DVec3;
pub(crate) use solved::find as find_thread_springs;

/// A suture is a spring between two points that pulls and does not push: f = k max(0, l − l₀) along the line between
/// them, as they are at the beginning of the step, l₀ what knots have left of its length. Where the tension is its
/// strength it tears, and where the tissue of one of its points goes it comes out; then it is gone. The system `suture`
/// adds its force to the loads of both bodies.
pub fn system() -> System {
    let system = System::built_in(
        "suture_tension",
        Phase::Boundary,
        "finds how hard sutures pull, and which tear",
        "`Suture(...)` under `attachments`",
        |world| {
            let count = world.get_resource::<Sutures>()?.all.len();
            Some(if count == 1 { "1 suture".to_string() } else { format!("{count} sutures") })
        },
        suture_tension,
    );
    // threads whose tissue may go are looked after on the host
    System { device_when: nothing_goes, ..system.on_device(kernels::kernels) }
}

/// Whether no tissue of what is sutured can go.
fn nothing_goes(world: &World) -> bool {
    let Some(sutures) = world.get_resource::<Sutures>() else { return false };
    elements_stay(sutures.all.iter().flat_map(|suture| &suture.ends).map(|end| end.body), world)
}

/// What a suture is, in [`SutureState`].
const HOLDS: f64 = 0.0;
const TORE: f64 = 1.0;
const CAME_OUT: f64 = 2.0;

/// What is known of a body.
#[derive(QueryData)]
#[query_data(mutable)]
struct SuturedColumns {
    rest: &'static RestPosition,
    mass: &'static Mass,
    u: &'static Displacement,
    sutured: &'static mut Sutured,
    force: &'static mut SutureForce,
    state: Option<&'static mut SutureState>,
}

fn suture_tension(
    clock: Res<Clock>,
    signals: Res<Signals>,
    sutures: Res<Sutures>,
    mut bodies: Query<SuturedColumns>,
    blocks: Query<&Alive>,
) {
    for mut columns in &mut bodies {
        columns.sutured.forces.fill(DVec3::ZERO);
    }
    // of those that are only tried the solver knows, and everything stays as it is
    let noted = clock.springs.is_none_or(|springs| springs.forces.are_noted());
    for suture in sutures.all.iter().filter(|_| noted) {
        let [first, second] = &suture.ends;
        let at = SUTURE_NUMBERS * suture.place;
        let state = bodies.get(first.body).ok().and_then(|columns| columns.state.map(|state| state.get(at)));
        if state != Some(HOLDS) {
            continue;
        }
        let Drawn { way, length, tension, energy, left } =
            draw(suture, (&sutures, &signals), &bodies.as_readonly(), &blocks);
        // in a static analysis nothing tears: pseudo-steps are no way that a thread takes
        let becomes = match clock.relaxation {
            None if left <= 0.0 => CAME_OUT,
            None if tension >= suture.strength => TORE,
            _ => HOLDS,
        };
        // an implicit step is found with the force of a thread that tears at its end
        let pulls = becomes == HOLDS || clock.springs.is_some();
        if pulls && tension > 0.0 {
            let force = way * (tension / length);
            pull(first, force, &mut bodies);
            pull(second, -force, &mut bodies);
        }
        let Some(mut state) = bodies.get_mut(first.body).ok().and_then(|columns| columns.state) else { continue };
        state.set(at + 2, if becomes == HOLDS { tension } else { 0.0 });
        // of what comes out length and energy are those of when it was last drawn
        if becomes != CAME_OUT {
            state.set(at + 3, length);
            state.set(at + 4, energy);
        }
        if becomes != HOLDS {
            state.set(at, becomes);
            state.set(at + 1, let_go_at(becomes, &clock));
        }
    }
    for mut columns in &mut bodies {
        for (place, force) in columns.sutured.forces.iter().enumerate() {
            columns.force.set_vector(place, *force);
        }
    }
}

/// When a thread that now tears or comes out has let go (s): tissue goes between steps, and implicit ones look at their
/// ends.
fn let_go_at(becomes: f64, clock: &Clock) -> f64 {
    let looks_at_end = clock.springs.is_some();
    if becomes == CAME_OUT && looks_at_end { clock.time_at(clock.step.saturating_sub(1)) } else { clock.time() }
}

/// How a thread is drawn.
struct Drawn {
    /// From its first end to the second (m), and how long that is.
    way: DVec3,
    length: f64,
    /// Its tension (N), and what it stores (J).
    tension: f64,
    energy: f64,
    /// The share of its stiffness that the tissue that is left bears.
    left: f64,
}

fn draw(
    suture: &Suture,
    (sutures, signals): (&Sutures, &Signals),
    bodies: &Query<SuturedColumnsReadOnly>,
    blocks: &Query<&Alive>,
) -> Drawn {
    let [first, second] = &suture.ends;
    let [from, to] = [first, second].map(|end| place(end, sutures.reference, bodies));
    let (way, length) = (to - from, from.distance(to));
    let is_there = |end: &Anchor| {
        let alive = blocks.get(end.element.0).ok();
        alive.is_none_or(|alive| alive[end.element.1 as usize] == 1)
    };
    let left = match is_there(first) && is_there(second) {
        true => mass_left(first, bodies).min(mass_left(second, bodies)),
        false => 0.0,
    };
    let whole = suture.tension(length, signals.values()[suture.signal][0]);
    let tension = left * whole;
    Drawn { way, length, tension, energy: 0.5 * tension * whole / suture.stiffness, left }
}

/// Where an end is (m, from the reference).
fn place(end: &Anchor, reference: DVec3, bodies: &Query<SuturedColumnsReadOnly>) -> DVec3 {
    let Ok(columns) = bodies.get(end.body) else { return DVec3::ZERO };
    let of = |&(row, weight): &(u32, f64)| {
        weight * (columns.rest.0[row as usize] - reference + columns.u.vector(row as usize))
    };
    end.nodes.iter().map(of).sum()
}

/// The least share of its mass at the start that one of the nodes of an end has left.
fn mass_left(end: &Anchor, bodies: &Query<SuturedColumnsReadOnly>) -> f64 {
    let Ok(columns) = bodies.get(end.body) else { return 0.0 };
    let of = |&(row, _): &(u32, f64)| {
        let start = columns.sutured.place(row).map_or(0.0, |place| columns.sutured.masses[place]);
        if start > 0.0 { (columns.mass.get(row as usize) / start).min(1.0) } else { 0.0 }
    };
    end.nodes.iter().map(of).fold(1.0, f64::min)
}

/// Pulls at an end.
fn pull(end: &Anchor, force: DVec3, bodies: &mut Query<SuturedColumns>) {
    let Ok(mut columns) = bodies.get_mut(end.body) else { return };
    for &(row, weight) in &end.nodes {
        if let Some(place) = columns.sutured.place(row) {
            columns.sutured.forces[place] += force * weight;
        }
    }
}
