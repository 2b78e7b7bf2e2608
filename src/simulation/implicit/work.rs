//! Work in implicit steps, and what their formula takes.

use super::axes::Axes;
use super::forces_before::ForcesBefore;
use super::place::Place;
use crate::components::*;
use bevy_ecs::prelude::*;

/// Adds up the work against internal forces alone, for the guard of energy, and gives what the step did at free axes.
pub(super) fn add_internal_work(world: &mut World, axes: &Axes, before: &ForcesBefore, place: &Place<'_>) -> Spent {
    let mut all = Spent::default();
    for (body, range) in axes.each() {
        // where nobody guards it, it is not there
        if world.get::<InternalWork>(body).is_none() {
            continue;
        }
        let (internal, external) = (world.get::<InternalForce>(body), world.get::<ExternalForce>(body));
        let accelerations = world.get::<Acceleration>(body);
        let mut work = 0.0;
        for axis in range.clone() {
            let at = axis - range.start;
            let acceleration = accelerations.map_or(0.0, |column| column.get(at));
            let forces = [internal.map_or(0.0, |column| column.get(at)), external.map_or(0.0, |column| column.get(at))];
            let spent = Spent::at(place, before, axis, (acceleration, forces));
            work += spent.on_elements;
            if place.motion.free[axis] {
                all.add(&spent);
            }
        }
        if let Some(mut sum) = world.get_mut::<InternalWork>(body) {
            sum.add(work);
        }
    }
    all
}

/// What a step did at an axis, or at all of them (J).
#[derive(Default)]
pub(super) struct Spent {
    by_loads: f64,
    on_elements: f64,
    damped: f64,
    kinetic: f64,
}

impl Spent {
    /// At an axis that had an acceleration before (m/s²), and has internal and external forces now (N).
    fn at(place: &Place<'_>, before: &ForcesBefore, axis: usize, (acceleration, forces): (f64, [f64; 2])) -> Self {
        let (motion, [internal, external]) = (place.motion, forces);
        let (moved, first) = (place.moved(axis), motion.velocity(axis));
        let velocity = place.arrival(axis, acceleration).0;
        Self {
            by_loads: 0.5 * (before.external.get(axis) + external) * moved,
            on_elements: 0.5 * (before.internal.get(axis) + internal) * moved,
            damped: motion.damping(axis) * 0.5 * (velocity + first) * moved,
            kinetic: 0.5 * motion.mass.get(axis / 3) * (velocity * velocity - first * first),
        }
    }

    /// What of a free axis went into the formula.
    fn by_formula(&self) -> f64 {
        self.by_loads - self.on_elements - self.damped - self.kinetic
    }

    /// What went somewhere else, whichever way.
    fn turned_over(&self) -> f64 {
        self.by_loads.abs() + self.on_elements.abs() + self.damped.abs()
    }

    /// Adds another axis.
    fn add(&mut self, other: &Self) {
        self.by_loads += other.by_loads;
        self.on_elements += other.on_elements;
        self.damped += other.damped;
        self.kinetic += other.kinetic;
    }
}

/// Adds up for the guards what a step's formula took of free axes, and what was turned over there.
pub(super) fn note_formula(world: &mut World, spent: &Spent) {
    if let Some(mut memory) = world.get_resource_mut::<GuardMemory>() {
        memory.scheme_loss += spent.by_formula();
        memory.least_scheme_loss = memory.least_scheme_loss.min(memory.scheme_loss);
        memory.turned_over += spent.turned_over();
    }
}

/// Adds up what a step did. Forces work with the mean of those at both ends: of linear bodies that is what they
/// store. What is missing then to the change of kinetic energy of a free axis went into the formula: implicit Euler
/// takes ½ M Δv² + ½ Δu·ΔF, less what a change of loads gives. Gives what all of it did at free axes.
pub(super) fn add_work(world: &mut World, axes: &Axes, before: &ForcesBefore, place: &Place<'_>) -> Spent {
    let motion = place.motion;
    let mut all = Spent::default();
    let mut columns = world.query::<(
        &mut Work,
        Option<&mut SchemeLoss>,
        Option<&InternalForce>,
        Option<&ExternalForce>,
        Option<&Acceleration>,
    )>();
    for (body, range) in axes.each() {
        let mut lost = vec![0.0; range.len() / 3];
        let Ok((mut work, loss, internal, external, accelerations)) = columns.get_mut(world, body) else { continue };
        let of = |column: Option<&Reals>, at: usize| column.map_or(0.0, |column| column.get(at));
        let (internal, external) = (internal.map(|force| &force.0), external.map(|force| &force.0));
        let accelerations = accelerations.map(|column| &column.0);
        for axis in range.clone() {
            let (at, node) = (axis - range.start, (axis - range.start) / 3);
            let forces = [of(internal, at), of(external, at)];
            let spent = Spent::at(place, before, axis, (of(accelerations, at), forces));
            let Spent { by_loads: of_loads, on_elements: of_elements, damped, .. } = spent;
            let mut add = |number: usize, part: f64| {
                let place = WORK_NUMBERS * node + number;
                let sum = work.get(place) + part;
                work.set(place, sum);
            };
            let is_held = motion.is_held(axis);
            if motion.free[axis] || is_held {
                add(0, of_loads);
                add(1, damped);
                add(3, of_elements);
            }
            if is_held {
                add(2, of_elements - of_loads + damped);
            }
            if motion.free[axis] {
                lost[at / 3] += spent.by_formula();
                all.add(&spent);
            }
        }
        if let Some(mut loss) = loss {
            lost.iter().enumerate().for_each(|(node, part)| {
                let sum = loss.get(node) + part;
                loss.set(node, sum);
            });
        }
    }
    all
}
