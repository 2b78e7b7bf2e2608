//! All axes of all nodes as vectors, bodies one after the other: how they lie in columns.

use super::super::tangent::heights_at_nodes;
use super::vectors::{copy_to, none, resize};
use crate::components::*;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// Where each body's axes are.
pub(super) struct Axes {
    pub bodies: Vec<Entity>,
    ranges: Vec<Range<usize>>,
    /// About the height of the flattest element at each node (m).
    pub heights: Reals,
}

/// What the motion of axes depends on, at the beginning of a step: as columns have it.
pub(super) struct Motion {
    /// Displacement and that of the last step (m), what rounding has lost of them not counted. Accelerations are in
    /// their columns, where they are carried on: nothing writes over them while a step is sought.
    pub u: Reals,
    pub step: Reals,
    /// What makes a velocity of a step (1/s); 0 at rest.
    pub rate: f64,
    /// Mass (kg) of nodes, and damping coefficient (kg/s) where there is one.
    pub mass: Reals,
    pub damping: Reals,
    /// Whether the axis moves freely.
    pub free: Vec<bool>,
}

/// The accelerations of a body's axes before a step (m/s²), as its column has them; 0 where none are carried on.
pub(super) fn acceleration_before(world: &World, body: Entity) -> impl Fn(usize) -> f64 + '_ {
    let column = world.get::<Acceleration>(body);
    move |at| column.map_or(0.0, |acceleration| acceleration.get(at))
}

impl Axes {
    /// Of all bodies of a world, in the order of [`frequency::bodies`](super::super::frequency::bodies).
    pub fn of(world: &mut World) -> Self {
        let bodies = super::super::frequency::bodies(world);
        let (mut ranges, mut heights, mut end) = (Vec::new(), Vec::new(), 0);
        let u = bodies.first().and_then(|&body| world.get::<Displacement>(body));
        let precision = u.map_or(Precision::F64, |u| u.precision());
        for &body in &bodies {
            let length = world.get::<Displacement>(body).map_or(0, |u| u.len());
            ranges.push(end..end + length);
            end += length;
            heights.extend(heights_at_nodes(world, body).unwrap_or_default());
        }
        Self { bodies, ranges, heights: Reals::from_f64(precision, heights.into_iter()) }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ranges.last().map_or(0, |range| range.end)
    }

    /// The numbers of the run.
    pub fn precision(&self) -> Precision {
        self.heights.precision()
    }

    /// A vector of zeros.
    pub fn zeros(&self) -> Reals {
        Reals::zeros(self.precision(), self.len())
    }

    /// Bytes of what is known of each.
    pub fn bytes(&self) -> usize {
        self.heights.bytes().len()
    }

    /// Each body and its range.
    pub fn each(&self) -> impl Iterator<Item = (Entity, Range<usize>)> + '_ {
        self.bodies.iter().copied().zip(self.ranges.iter().cloned())
    }

    /// Accelerations before a step (m/s²), of all axes.
    pub fn accelerations<'w>(&'w self, world: &'w World) -> impl Iterator<Item = f64> + 'w {
        self.each().flat_map(|(body, range)| (0..range.len()).map(acceleration_before(world, body)))
    }

    /// A motion that is not known yet.
    pub fn motion(&self) -> Motion {
        let [u, step, mass, damping] = [(); 4].map(|()| none(self.precision()));
        Motion { u, step, rate: 0.0, mass, damping, free: Vec::new() }
    }

    /// Reads all that a step begins with; the velocity of a step of the clock's length.
    pub fn read(&self, world: &World, motion: &mut Motion) {
        let Motion { u, step, rate, mass, damping, free } = motion;
        *rate = world.resource::<Clock>().rate();
        resize(u, self.len());
        resize(step, self.len());
        resize(mass, self.len() / 3);
        free.resize(self.len(), false);
        for (body, range) in self.each() {
            let entity = world.entity(body);
            let (Some(place), Some(increment), Some(masses), Some(axes)) = (
                entity.get::<Displacement>(),
                entity.get::<DisplacementIncrement>(),
                entity.get::<Mass>(),
                entity.get::<ConstrainedAxes>(),
            ) else {
                continue;
            };
            copy_to(u, range.start, place);
            copy_to(step, range.start, increment);
            copy_to(mass, range.start / 3, masses);
            if let Some(damped) = entity.get::<DampingCoefficient>() {
                resize(damping, self.len() / 3);
                copy_to(damping, range.start / 3, damped);
            }
            for (i, axis) in range.enumerate() {
                free[axis] = axes[i / 3] >> (i % 3) & 1 == 0 && masses.get(i / 3) > 0.0;
            }
        }
    }

    /// Puts displacements and steps back as they were at the beginning of a step.
    pub fn put_back(&self, world: &mut World, motion: &Motion) {
        for (body, range) in self.each() {
            if let Some(mut column) = world.get_mut::<Displacement>(body) {
                (0..range.len()).for_each(|i| column.set(i, motion.u.get(range.start + i)));
            }
            if let Some(mut column) = world.get_mut::<DisplacementIncrement>(body) {
                (0..range.len()).for_each(|i| column.set(i, motion.step.get(range.start + i)));
            }
        }
    }
}
