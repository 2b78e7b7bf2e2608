//! `free_tool`: rigid tools that move freely push nodes, and nodes push them.

mod contacts;

use super::grasp::Grip;
use super::node_slices::{MetColumns, NodeSlices, SlicedColumns, last_step, note_farther};
use super::repeat::Repeat;
use super::system::{Phase, System};
use super::tool_contact::STILL;
use crate::backend::cpu::{Foreseen, IntegrationCoefficients};
use crate::components::*;
use crate::error::{Criterion, Error, Instability};
use crate::math::Scalar;
use crate::observation::Observer;
use crate::tools::RigidMotion;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use contacts::{Near, Solved};
use glam::{DMat3, DVec3};

/// Central differences as of nodes: forces of the beginning of a step change the velocity of its middle, and that moves
/// the body; likewise angular momentum, and the turn ([`RigidMotion::after`]). Like `tool_contact` it predicts where
/// nodes and tools would end, and finds the forces that keep them apart: here both sides give way, by their effective
/// masses, so that momentum is kept to rounding, and kinetic energy does not grow. On nodes these forces are loads like
/// others.
///
/// It runs on the host on both backends: on a GPU the columns that it needs come and go in every step.
pub fn system() -> System {
    let system = System::built_in(
        "free_tool",
        Phase::Contact,
        "moves free tools, and keeps nodes out of them",
        "`free` of a tool",
        |world| {
            let count = world.get_resource::<FreeTools>()?.all.len();
            Some(if count == 1 { "1 free tool".to_string() } else { format!("{count} free tools") })
        },
        free_tool,
    );
    System { repeats: |_| Some(contacts::sweeps()), ..system.with_state::<FreeMotions>() }
}

/// How far a tool may go in a step, in edges: beyond, it may be through a surface before anybody sees it.
const FARTHEST: f64 = 0.5;

/// How far it may turn in a step (rad).
const MOST_TURN: f64 = 0.5;

/// What is known of a body.
#[derive(QueryData)]
#[query_data(mutable)]
struct TouchedColumns {
    nodes: SlicedColumns,
    /// Where tools may hold its nodes.
    grip: Option<(&'static Grasps, &'static ToolHold)>,
    met: MetColumns,
}

/// A tool in a step.
struct ToolStep<'a> {
    tool: &'a FreeTool,
    /// How it has moved.
    before: RigidMotion,
    /// How it would move if nothing touched it.
    free: RigidMotion,
    /// Acceleration of gravity (m/s²).
    gravity: DVec3,
    response: Response,
    coefficients: IntegrationCoefficients<f64>,
}

/// What a force does to a tool in a step.
#[derive(Clone, Copy)]
struct Response {
    /// Δt (s).
    time_step: f64,
    /// Time over which forces act (s), damping considered.
    window: f64,
    /// Velocity by a force (s/kg).
    linear: f64,
    /// Angular velocity by a moment (s/(kg m²)), along the scene's axes.
    angular: DMat3,
}

impl<'a> ToolStep<'a> {
    fn new(tool: &'a FreeTool, before: RigidMotion, clock: &Clock, signals: &Signals) -> Self {
        let coefficients = IntegrationCoefficients::<f64>::of(clock);
        let a = tool.damping * coefficients.half_step;
        let damped = 1.0 + coefficients.after_first * a;
        let window = coefficients.force * coefficients.rate / damped;
        let left = 1.0 - (1.0 + coefficients.after_first) * a / damped;
        let gravity = tool.gravity.iter().map(|&slot| DVec3::from_slice(&signals.values()[slot][..3])).sum::<DVec3>();
        let velocity = before.velocity * left + gravity * window;
        let free = RigidMotion { velocity, momentum: before.momentum * left, ..before };
        let angular = tool.inertia.inverse_in(before.turn) * window;
        let response = Response { time_step: clock.time_step, window, linear: window / tool.inertia.mass, angular };
        Self { tool, before, free, gravity, response, coefficients }
    }
}

fn free_tool(
    clock: Res<Clock>,
    signals: Res<Signals>,
    tools: Res<FreeTools>,
    observer: Option<Res<Observer>>,
    mut motions: ResMut<FreeMotions>,
    mut bodies: Query<TouchedColumns>,
) -> Result<(), Error> {
    // static analyses have none: they are refused
    if clock.relaxation.is_some() {
        return Ok(());
    }
    for (tool, state) in tools.all.iter().zip(&mut motions.all) {
        let step = ToolStep::new(tool, state.motion, &clock, &signals);
        let worked = state.work_of_half(tool, clock.time_step, |body, row| {
            bodies.get(body).map_or(DVec3::ZERO, |columns| {
                let nodes = columns.nodes;
                let previous = nodes.previous.map(|previous| &previous.0[..]);
                last_step(nodes.step.vector(row), (nodes.axes.0[row], row), previous)
            })
        });
        let near = step.near((tools.reference, &signals), &mut bodies, &state.touches);
        let fault = step.fault(&near);
        let Solved { velocity, momentum, touches } = contacts::solve(&step, near);
        let next = RigidMotion { velocity, momentum, ..step.before };
        if let Some((body, what, criterion)) = fault.or_else(|| not_finite(tool, &next)) {
            return Err(broken(&clock, observer.as_deref(), body, what, criterion));
        }
        step.count(state, &next, (&touches, worked));
        let work_factor = step.coefficients.work_factor;
        for (touch, foreseen) in &touches {
            if let Ok(mut columns) = bodies.get_mut(tool.meets[touch.node.0 as usize].body) {
                let row = touch.node.1 as usize;
                let load = columns.nodes.external.vector(row) + touch.force;
                columns.nodes.external.set_vector(row, load);
                let farther = foreseen.free * touch.force / foreseen.to_force;
                note_farther(&mut columns.met, row, farther, work_factor);
            }
        }
        state.touches = touches.into_iter().map(|(touch, _)| touch).collect();
        state.note_slips();
        state.motion = next.after(step.response.time_step, &tool.inertia);
    }
    Ok(())
}

impl ToolStep<'_> {
    /// Nodes that may touch the tool in this step, in the order of bodies and rows.
    fn near(
        &self,
        (reference, signals): (DVec3, &Signals),
        bodies: &mut Query<TouchedColumns>,
        touched: &[FreeTouch],
    ) -> Vec<Near> {
        let mut all = Vec::new();
        for number in 0..self.tool.meets.len() {
            let Ok(columns) = bodies.get_mut(self.tool.meets[number].body) else { continue };
            let of = (number, touched);
            match columns.nodes.u.precision() {
                Precision::F32 => self.near_of::<f32>((reference, signals), columns, of, &mut all),
                Precision::F64 => self.near_of::<f64>((reference, signals), columns, of, &mut all),
            }
        }
        all
    }

    /// Those of the body at a place in [`FreeTool::meets`]: of those that closed tools hold, as these take them.
    fn near_of<T: Scalar>(
        &self,
        (reference, signals): (DVec3, &Signals),
        TouchedColumnsItem { nodes, grip, .. }: TouchedColumnsItem<'_, '_>,
        (number, touched): (usize, &[FreeTouch]),
        all: &mut Vec<Near>,
    ) {
        let (tool, time_step) = (self.tool, self.response.time_step);
        let Some((center, radius)) = tool.geometry.bounding_sphere() else { return };
        let center = tool.pose(&self.free.after(time_step, &tool.inertia)).place(center);
        // what comes to touch a tool that sticks is held as that is
        let sticks = touched.iter().any(|touch| touch.sticks);
        let spin = self.before.spin(&tool.inertia);
        let (met, first) = (&tool.meets[number], all.len());
        let reach = (radius + met.edge) * (radius + met.edge);
        let nodes = NodeSlices::<T>::of(nodes);
        for &row in &met.rows {
            let (at, node) = (row as usize, (number as u32, row));
            let place = nodes.rest[at] - reference + nodes.displacement(at);
            if center.distance_squared(place) > reach || nodes.mass[at].to_f64() <= 0.0 {
                continue;
            }
            let foreseen = nodes.foresee(at, &self.coefficients);
            // what touched is in the order of nodes
            let known = touched.binary_search_by_key(&node, |touch| touch.node);
            let known = known.ok().map(|place| &touched[place]);
            let (arm, out) = (place - self.before.place, met.settling * time_step);
            // nor does what was still let go
            let still = || {
                let slip = foreseen.before - (self.before.velocity + spin.cross(arm)) * time_step;
                slip.length() <= STILL * met.edge
            };
            let is_held = known.map_or_else(|| sticks || still(), |touch| touch.sticks);
            let friction = met.friction[usize::from(!is_held)];
            let target = known.map(|touch| touch.target);
            // what is left to ask of the step before is its work
            let foreseen = Foreseen { before: nodes.last_step(at), ..foreseen };
            all.push(Near { node, place, foreseen, arm, friction, edge: met.edge, swept: met.swept, target, out });
        }
        let Some(grip) = grip.map(Grip::<T>::of) else { return };
        let near = &mut all[first..];
        let rows: Vec<u32> = near.iter().map(|near| near.node.1).collect();
        let place_of = |row: u32| rows.binary_search(&row).ok();
        grip.each_held(&nodes, (&self.coefficients, signals), place_of, |place, step| {
            near[place].foreseen = Foreseen { step, free: DVec3::ZERO, ..near[place].foreseen };
        });
    }

    /// Counts what was done to the tool. With velocities of the middles before and after, forces do the work F · ½ (v +
    /// v') h on it, h the time between the middles, exactly. On nodes they do half of theirs in the last step, and half
    /// in the next, which glue and other tools may change: of that the forces of the last step have done in it is told.
    fn count(&self, state: &mut FreeMotion, next: &RigidMotion, (touches, worked): (&[(FreeTouch, Foreseen)], f64)) {
        let (before, inertia, coefficients) = (&self.before, &self.tool.inertia, &self.coefficients);
        let window = coefficients.force * coefficients.rate;
        let velocity = 0.5 * (before.velocity + next.velocity);
        let spin = 0.5 * (before.spin(inertia) + next.spin(inertia));
        let by_gravity = window * inertia.mass * self.gravity.dot(velocity);
        let (mut on_tool, mut on_nodes) = (0.0, worked);
        for (touch, node) in touches {
            on_tool -= window * touch.force.dot(velocity + spin.cross(touch.arm));
            // on those that are moved as told, too: who moves them does as much less
            on_nodes += 0.5 * coefficients.work_factor * touch.force.dot(node.before);
        }
        state.acted = coefficients.work_factor / coefficients.rate;
        state.gravity_work += by_gravity;
        state.contact_work += on_tool;
        state.contact_loss -= on_tool + on_nodes;
        if self.tool.damping > 0.0 {
            state.damping_loss += by_gravity + on_tool - (next.kinetic(inertia) - before.kinetic(inertia));
        }
    }

    /// What of the tool near nodes is too fast to be seen: the body, and what to say.
    fn fault(&self, near: &[Near]) -> Option<(String, String, Criterion)> {
        let (tool, dt) = (self.tool, self.response.time_step);
        let turn = dt * self.free.spin(&tool.inertia).length();
        let way = dt * self.free.velocity.length() + tool.reach() * turn;
        let nearest = near.iter().min_by(|a, b| a.edge.total_cmp(&b.edge));
        let body = |near: &Near| tool.meets[near.node.0 as usize].name.clone();
        let criterion =
            |value: f64, limit: f64| Criterion { value: Some(value), limit: Some(limit), ..Criterion::of("speed") };
        if turn > MOST_TURN {
            let what = format!("the free tool `{}` turns by {turn:.2} rad in a step", tool.name);
            return Some((nearest.map_or_else(String::new, body), what, criterion(turn, MOST_TURN)));
        }
        let nearest = nearest.filter(|near| way > FARTHEST * near.edge)?;
        let what = format!(
            "the free tool `{}` goes {way:.3e} m in a step, and edges of faces are {:.3e} m long: it could be through a \
             surface before anybody sees it",
            tool.name, nearest.edge
        );
        Some((body(nearest), what, criterion(way, FARTHEST * nearest.edge)))
    }
}

fn not_finite(tool: &FreeTool, next: &RigidMotion) -> Option<(String, String, Criterion)> {
    if next.is_sound() {
        return None;
    }
    let body = tool.meets.first().map_or_else(String::new, |met| met.name.clone());
    Some((body, format!("the motion of the free tool `{}` is not finite", tool.name), Criterion::of("not_finite")))
}

fn broken(clock: &Clock, observer: Option<&Observer>, body: String, what: String, criterion: Criterion) -> Error {
    let cause = "a free tool that is too fast for the mesh that it meets: give it a lower `velocity`, more `damping`, or take a \
                 smaller `step`; or forces on it that are too large";
    Error::Unstable(Box::new(Instability {
        time: clock.time(),
        step: clock.step,
        body,
        what,
        cause: cause.into(),
        good_until: observer.map_or(0.0, |observer| observer.good_until),
        criterion,
        last_good: None,
    }))
}
