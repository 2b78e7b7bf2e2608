//! What a static analysis sees of all bodies when it checks: displacements, forces, and what has changed.

use super::rounding::digit_of_places;
use crate::components::*;
use crate::elements::rounding;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::ops::Range;

/// Displacements and forces of all bodies, one after the other in a fixed order.
pub(super) struct State {
    /// Steps taken.
    pub step: u64,
    bodies: Vec<Body>,
}

struct Body {
    entity: Entity,
    displacement: Reals,
    compensation: Option<Reals>,
    /// u at the beginning of the last step (m), where the forces are.
    place: Vec<f64>,
    /// F there (N).
    internal: Vec<f64>,
    /// R there (N).
    load: Vec<f64>,
}

/// The sums that tell how far a state is from equilibrium.
pub(super) struct Residual {
    /// ‖R − F‖² over free axes (N²).
    pub square: f64,
    /// ‖R‖² over free axes and ‖F − R‖² over held ones (N²).
    pub scale_square: f64,
    /// What rounding of the displacements may be of `square` (N²): a node's stiffness, which its inertial mass
    /// bounds, times the last digit of its largest displacement.
    pub rounding_square: f64,
    /// What rounding of places beside may be of it where something touches or is tied (N²).
    pub places_square: f64,
    /// The norm of the last digits of these places over free axes (m): a motion within them is none that is known.
    pub of_places: f64,
    /// Rounding of a number, as a share of it.
    pub digit: f64,
    worst: Option<(Entity, usize, f64)>,
}

impl State {
    /// Whether a column must be on the host to see a state and to go back to one.
    pub fn has(column: &ColumnAccess) -> bool {
        let subjects = [Subject::Motion, Subject::Force, Subject::Inversion, Subject::Guard];
        column.role == Role::State && subjects.contains(&column.subject)
    }

    /// The present state.
    pub fn of(world: &mut World) -> Self {
        let step = world.resource::<Clock>().step;
        type Columns<'a> = (
            Entity,
            &'a Displacement,
            &'a DisplacementIncrement,
            Option<&'a DisplacementCompensation>,
            &'a InternalForce,
            Option<&'a ExternalForce>,
        );
        let mut bodies: Vec<Body> = world
            .query::<Columns>()
            .iter(world)
            .map(|(entity, u, step, lost, internal, external)| {
                let all = 0..u.len();
                let load = |i: usize| external.map_or(0.0, |external| external.get(i));
                let compensation_of = |i: usize| lost.map_or(0.0, |lost| lost.get(i));
                let exact = |i: usize| u.get(i) - compensation_of(i);
                Body {
                    entity,
                    displacement: u.0.clone(),
                    compensation: lost.map(|lost| lost.0.clone()),
                    place: all.clone().map(|i| exact(i) - step.get(i)).collect(),
                    internal: all.clone().map(|i| internal.get(i)).collect(),
                    load: all.map(load).collect(),
                }
            })
            .collect();
        bodies.sort_by_key(|body| body.entity);
        Self { step, bodies }
    }

    /// Turns it into the state at rest before any load.
    pub fn forget(&mut self) {
        for body in &mut self.bodies {
            body.displacement.bytes_mut().fill(0);
            if let Some(lost) = &mut body.compensation {
                lost.bytes_mut().fill(0);
            }
            for column in [&mut body.place, &mut body.internal, &mut body.load] {
                column.fill(0.0);
            }
        }
    }

    /// Puts all bodies where they were, at rest, and forgets what went wrong since.
    pub fn restore(&self, world: &mut World) {
        for body in &self.bodies {
            let mut entity = world.entity_mut(body.entity);
            if let Some(mut u) = entity.get_mut::<Displacement>() {
                u.0.clone_from(&body.displacement);
            }
            if let (Some(mut lost), Some(before)) = (entity.get_mut::<DisplacementCompensation>(), &body.compensation) {
                lost.0.clone_from(before);
                // at rest the step is exact
                (lost.len() / 2..lost.len()).for_each(|i| lost.set(i, 0.0));
            }
            if let Some(mut step) = entity.get_mut::<DisplacementIncrement>() {
                step.bytes_mut().fill(0);
            }
            if let Some(mut found) = entity.get_mut::<FirstNonFinite>() {
                found[..2].fill(u32::MAX);
            }
        }
        for mut found in world.query::<&mut FirstInverted>().iter_mut(world) {
            found[..2].fill(u32::MAX);
        }
    }

    /// The body of the node that is farthest from where it began, and its way from there (m).
    pub fn farthest(&self) -> Option<(Entity, DVec3)> {
        let of_body = |body: &Body| {
            let ways = body.place.as_chunks::<3>().0.iter().map(|&way| DVec3::from_array(way));
            let farthest = ways.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
            Some((body.entity, farthest))
        };
        let each = self.bodies.iter().filter_map(of_body);
        each.max_by(|(_, a), (_, b)| a.length_squared().total_cmp(&b.length_squared()))
    }

    /// How far axes that are held have gone at most (m).
    pub fn told(&self, world: &World) -> f64 {
        let of_body = |body: &Body| {
            let Some(held) = world.get::<ConstrainedAxes>(body.entity) else { return 0.0 };
            let is_held = |axis: usize| held[axis / 3] >> (axis % 3) & 1 == 1;
            let ways = body.place.iter().enumerate().filter(|(axis, _)| is_held(*axis));
            ways.fold(0.0, |most: f64, (_, way)| most.max(way.abs()))
        };
        self.bodies.iter().map(of_body).fold(0.0, f64::max)
    }

    /// What has changed since another state.
    pub fn motion_since(&self, before: &State, world: &World) -> Motion {
        let mut sum = Motion::default();
        let (mut work, mut weight) = (0.0, 0.0);
        for (now, before) in self.bodies.iter().zip(&before.bodies) {
            let Some(mass) = world.get::<InertialMass>(now.entity) else { continue };
            for i in free(now.entity, 0..now.place.len(), world) {
                let moved = now.place[i] - before.place[i];
                work += moved * (now.internal[i] - before.internal[i]);
                weight += moved * moved * mass.get(i / 3);
                sum.moved += moved * moved;
                sum.displaced += now.place[i] * now.place[i];
            }
        }
        let square = work / weight;
        sum.work = work;
        sum.frequency = (square.is_finite() && square > 0.0).then(|| square.sqrt());
        sum.moved = sum.moved.sqrt();
        sum.displaced = sum.displaced.sqrt();
        sum
    }
}

/// What has changed from one state to another, along free axes.
#[derive(Default)]
pub(super) struct Motion {
    /// The Rayleigh quotient of the change, as an angular frequency (1/s); `None` when nothing moved, or against no
    /// force.
    pub frequency: Option<f64>,
    /// Work against the change of internal forces (J); below 0 where bodies give way, as a column that buckles.
    pub work: f64,
    /// Norm of the change of the displacements (m).
    pub moved: f64,
    /// Norm of the displacements (m).
    pub displaced: f64,
}

/// The axes among some along which a body's nodes move freely: not held, and not inactive.
fn free(body: Entity, axes: Range<usize>, world: &World) -> impl Iterator<Item = usize> + '_ {
    let held = world.get::<ConstrainedAxes>(body);
    let mass = world.get::<InertialMass>(body);
    axes.filter(move |&i| {
        let held = held.is_some_and(|held| held[i / 3] >> (i % 3) & 1 == 1);
        !held && mass.is_some_and(|mass| mass.get(i / 3) > 0.0)
    })
}

/// The largest [`Element::ROUNDING`](crate::elements::Element::ROUNDING) of a body's elements.
fn rounding_of_elements(body: Entity, world: &World) -> f64 {
    let blocks = world.get::<Authoring>(body).into_iter().flat_map(|authoring| &authoring.blocks);
    let kinds = blocks.filter_map(|&block| world.get::<Block>(block)).map(|block| block.kind);
    kinds.map(rounding).fold(1.0, f64::max)
}

impl Residual {
    /// Of a state.
    pub fn of(state: &State, world: &World) -> Self {
        let mut sum = Self {
            square: 0.0,
            scale_square: 0.0,
            rounding_square: 0.0,
            places_square: 0.0,
            of_places: 0.0,
            digit: 0.0,
            worst: None,
        };
        let time_step = world.resource::<Clock>().time_step;
        for body in &state.bodies {
            let net = |i: usize| body.internal[i] - body.load[i];
            let all: f64 = (0..body.load.len()).map(|i| net(i) * net(i)).sum();
            let mut square = 0.0;
            sum.digit = match body.displacement {
                Reals::F32(_) => f64::from(f32::EPSILON),
                Reals::F64(_) => f64::EPSILON,
            };
            let of_elements = rounding_of_elements(body.entity, world);
            let of_place = digit_of_places(body.entity, world);
            let mass = world.get::<InertialMass>(body.entity);
            let stiffness = |node: usize| mass.map_or(0.0, |mass| mass.get(node)) / (time_step * time_step);
            let mut node = (usize::MAX, 0.0);
            for i in free(body.entity, 0..body.load.len(), world) {
                let part = net(i) * net(i);
                square += part;
                sum.scale_square += body.load[i] * body.load[i];
                sum.rounding_square += (of_elements * stiffness(i / 3) * sum.digit * body.place[i]).powi(2);
                sum.places_square += (stiffness(i / 3) * of_place).powi(2);
                sum.of_places += of_place * of_place;
                node = (i / 3, if node.0 == i / 3 { node.1 + part } else { part });
                if sum.worst.is_none_or(|(.., most)| node.1 > most) {
                    sum.worst = Some((body.entity, node.0, node.1));
                }
            }
            sum.square += square;
            // what is not free is held
            sum.scale_square += (all - square).max(0.0);
        }
        sum.of_places = sum.of_places.sqrt();
        sum
    }

    /// The body, the author's number of the node, and the force that nothing balances (N).
    pub fn worst_in_words(&self, world: &World) -> (String, u64, f64) {
        let Some((body, row, square)) = self.worst else { return (String::new(), 0, 0.0) };
        let name = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
        let node = world.get::<Authoring>(body).map_or(row as u64, |authoring| authoring.node_id(row));
        (name, node, square.sqrt())
    }
}
