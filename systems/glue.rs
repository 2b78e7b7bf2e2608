//! `glue`: points of bodies stay where they are tied to faces, until that breaks.

use super::system::{Phase, System};
use crate::backend::cpu::{Foreseen, IntegrationCoefficients};
use crate::components::*;
use crate::contact::{Tie, TieSet};
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use glam::DVec3;
use std::collections::BTreeMap;

/// Like `surface_contact`, with vectors and both signs: each node's next step is predicted, and the forces are found
/// that let points end where they are on their faces (see [`TieSet::solve`]), and are added to the loads. There is no
/// stiffness to choose, and the stable step stays as it is. A tie whose force is too large for it breaks in that step,
/// and bears nothing any more.
pub fn system() -> System {
    System::built_in(
        "glue",
        Phase::Contact,
        "holds points where they are tied to faces",
        "`Glue(...)` or `Tie(...)` under `attachments`",
        |world| {
            let count = world.get_resource::<Glue>()?.ties.len();
            Some(if count == 1 { "1 point that is tied".to_string() } else { format!("{count} points that are tied") })
        },
        glue,
    )
}

/// What a tie is, in [`TieState`].
const HOLDS: f64 = 0.0;
const BROKE: f64 = 1.0;
const WENT: f64 = 2.0;

/// What is known of a body.
#[derive(QueryData)]
#[query_data(mutable)]
struct TiedColumns {
    rest: &'static RestPosition,
    mass: &'static Mass,
    fictitious: Option<&'static FictitiousMass>,
    damping: Option<&'static DampingCoefficient>,
    axes: &'static ConstrainedAxes,
    internal: &'static InternalForce,
    external: &'static mut ExternalForce,
    u: &'static Displacement,
    step: &'static DisplacementIncrement,
    state: Option<&'static mut TieState>,
}

/// The nodes of a step, each once: bodies and rows, and where each would go.
#[derive(Default)]
struct Nodes {
    places: BTreeMap<(usize, u32), u32>,
    rows: Vec<(usize, u32)>,
    foreseen: Vec<Foreseen>,
}

fn glue(clock: Res<Clock>, glue: Res<Glue>, mut bodies: Query<TiedColumns>, blocks: Query<&Alive>) {
    let coefficients = IntegrationCoefficients::<f64>::of(&clock);
    let (mut nodes, mut set) = (Nodes::default(), TieSet::default());
    // those that hold, each with the normal of its face
    let mut holding: Vec<(&TiedPoint, DVec3)> = Vec::new();
    let mut gone: Vec<&TiedPoint> = Vec::new();
    for tie in &glue.ties {
        let [of, onto] = tie.bodies.map(|body| bodies.get(glue.bodies[body]));
        let (Ok(of), Ok(onto)) = (of, onto) else { continue };
        if of.state.is_none_or(|state| state.get(TIE_NUMBERS * tie.place) != HOLDS) {
            continue;
        }
        let alive = blocks.get(tie.element.0).ok();
        let is_there = alive.is_none_or(|alive| alive[tie.element.1 as usize] == 1)
            && tie.nodes.iter().all(|&(row, _)| of.mass.get(row as usize) > 0.0);
        if !is_there {
            gone.push(tie);
            continue;
        }
        let at = |columns: &TiedColumnsReadOnlyItem<'_, '_>, row: u32| {
            columns.rest.0[row as usize] - glue.reference + columns.u.vector(row as usize)
        };
        let corners = tie.corners.map(|row| at(&onto, row));
        let point: DVec3 = tie.nodes.iter().map(|&(row, weight)| at(&of, row) * weight).sum();
        let place: DVec3 = corners.iter().zip(tie.weights).map(|(corner, weight)| *corner * weight).sum();
        let (mut out, mut belongs) = (DVec3::ZERO, place);
        if let Some([along, across, normal]) = frame_of(corners) {
            belongs += along * tie.gap.x + across * tie.gap.y + normal * tie.gap.z;
            out = normal;
        }
        let mut parts = Vec::with_capacity(tie.nodes.len() + 3);
        for &(row, weight) in &tie.nodes {
            parts.push((nodes.place((tie.bodies[0], row), &of, &coefficients), weight));
        }
        for (row, weight) in tie.corners.into_iter().zip(tie.weights).filter(|(_, weight)| *weight != 0.0) {
            parts.push((nodes.place((tie.bodies[1], row), &onto, &coefficients), -weight));
        }
        set.ties.push(Tie::new(parts, point - belongs));
        holding.push((tie, out));
    }
    set.steps = nodes.foreseen.iter().map(|foreseen| foreseen.step).collect();
    set.responses = nodes.foreseen.iter().map(|foreseen| foreseen.free / foreseen.to_force).collect();
    set.solve(glue.sweeps);
    let counts_work = clock.relaxation.is_none().then_some(coefficients.work_factor);
    let mut forces = vec![DVec3::ZERO; nodes.rows.len()];
    for (solved, (tie, out)) in set.ties.iter().zip(&holding) {
        let Some(mut state) = state_of(tie, &glue, &mut bodies) else { continue };
        let at = TIE_NUMBERS * tie.place;
        // in a static analysis nothing breaks: pseudo-steps are no way that bodies take
        if counts_work.is_some() && tie.strength.is_exceeded(solved.force, *out) {
            breaks(&mut state, at, BROKE, &clock);
            continue;
        }
        solved.parts.iter().for_each(|&(node, weight)| forces[node as usize] += solved.force * weight);
        state.set_vector_at(at + 2, solved.force);
        if let Some(work_factor) = counts_work {
            let before: DVec3 =
                solved.parts.iter().map(|&(node, weight)| nodes.foreseen[node as usize].before * weight).sum();
            let taken = -work_factor * solved.force.dot(0.5 * (before + solved.relative(&set.steps)));
            let sum = state.get(at + 5) + taken;
            state.set(at + 5, sum);
        }
    }
    for tie in gone {
        if let Some(mut state) = state_of(tie, &glue, &mut bodies) {
            breaks(&mut state, TIE_NUMBERS * tie.place, WENT, &clock);
        }
    }
    for (&(body, row), force) in nodes.rows.iter().zip(forces) {
        if let Ok(mut columns) = bodies.get_mut(glue.bodies[body]) {
            let load = columns.external.vector(row as usize) + force;
            columns.external.set_vector(row as usize, load);
        }
    }
}

fn state_of<'a>(tie: &TiedPoint, glue: &Glue, bodies: &'a mut Query<TiedColumns>) -> Option<Mut<'a, TieState>> {
    bodies.get_mut(glue.bodies[tie.bodies[0]]).ok()?.state
}

fn breaks(state: &mut TieState, at: usize, how: f64, clock: &Clock) {
    state.set(at, how);
    state.set(at + 1, clock.time());
    state.set_vector_at(at + 2, DVec3::ZERO);
}

impl Nodes {
    /// The place of a node in the set.
    fn place(
        &mut self,
        node: (usize, u32),
        columns: &TiedColumnsReadOnlyItem<'_, '_>,
        coefficients: &IntegrationCoefficients<f64>,
    ) -> u32 {
        let next = self.rows.len() as u32;
        *self.places.entry(node).or_insert_with(|| {
            self.rows.push(node);
            self.foreseen.push(foresee(columns, node.1 as usize, coefficients));
            next
        })
    }
}

/// Where a node would go, from what is known of its body.
fn foresee(
    columns: &TiedColumnsReadOnlyItem<'_, '_>,
    row: usize,
    coefficients: &IntegrationCoefficients<f64>,
) -> Foreseen {
    let mass = columns.fictitious.map_or_else(|| columns.mass.get(row), |mass| mass.get(row));
    let damping = columns.damping.map_or(0.0, |damping| damping.get(row));
    let force = columns.external.vector(row) - columns.internal.vector(row);
    coefficients.foresee(mass, damping, columns.axes[row], columns.step.vector(row), force)
}
