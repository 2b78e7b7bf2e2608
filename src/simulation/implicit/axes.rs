//! All axes of all nodes as vectors, bodies one after the other: how they lie in columns.

use super::super::tangent::heights_at_nodes;
use crate::components::*;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// Where each body's axes are.
pub(super) struct Axes {
    pub bodies: Vec<Entity>,
    ranges: Vec<Range<usize>>,
    /// About the height of the flattest element at the node of each axis (m).
    pub heights: Reals,
}

/// What the motion of axes depends on, at the beginning of a step.
#[derive(Default)]
pub(super) struct Motion {
    /// Displacement (m), velocity (m/s), and acceleration (m/s²) where that is carried on.
    pub u: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    /// Mass (kg) of nodes, and damping coefficient (kg/s) where there is one.
    pub mass: Vec<f64>,
    pub damping: Vec<f64>,
    /// Whether the axis moves freely, and whether it is held; inactive nodes are neither.
    pub free: Vec<bool>,
    pub held: Vec<bool>,
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
            let of_nodes = heights_at_nodes(world, body).unwrap_or_default();
            heights.extend(of_nodes.iter().flat_map(|&height| [height; 3]));
        }
        Self { bodies, ranges, heights: Reals::from_f64(precision, heights.into_iter()) }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ranges.last().map_or(0, |range| range.end)
    }

    /// Bytes of what is known of each.
    pub fn bytes(&self) -> usize {
        self.heights.bytes().len()
    }

    /// Each body and its range.
    pub fn each(&self) -> impl Iterator<Item = (Entity, Range<usize>)> + '_ {
        self.bodies.iter().copied().zip(self.ranges.iter().cloned())
    }

    /// Reads all that a step begins with; the velocity of a step of the clock's length.
    pub fn read(&self, world: &World, motion: &mut Motion) {
        let rate = world.resource::<Clock>().rate();
        let Motion { u, v, a, mass, damping, free, held } = motion;
        for vector in [&mut *u, v] {
            vector.resize(self.len(), 0.0);
        }
        mass.resize(self.len() / 3, 0.0);
        free.resize(self.len(), false);
        held.resize(self.len(), false);
        for (body, range) in self.each() {
            let entity = world.entity(body);
            let (Some(place), Some(step), Some(masses), Some(axes)) = (
                entity.get::<Displacement>(),
                entity.get::<DisplacementIncrement>(),
                entity.get::<Mass>(),
                entity.get::<ConstrainedAxes>(),
            ) else {
                continue;
            };
            place.read(&mut u[range.clone()]);
            step.read(&mut v[range.clone()]);
            if let Some(lost) = entity.get::<DisplacementCompensation>() {
                let count = range.len();
                (0..count).for_each(|i| u[range.start + i] -= lost.get(i));
                (0..count).for_each(|i| v[range.start + i] -= lost.get(count + i));
            }
            v[range.clone()].iter_mut().for_each(|v| *v *= rate);
            if let Some(acceleration) = entity.get::<Acceleration>() {
                a.resize(self.len(), 0.0);
                acceleration.read(&mut a[range.clone()]);
            }
            let damped = entity.get::<DampingCoefficient>();
            if damped.is_some() {
                damping.resize(self.len() / 3, 0.0);
            }
            for (i, node) in (range.start / 3..range.end / 3).enumerate() {
                mass[node] = masses.get(i);
                if let Some(damped) = damped {
                    damping[node] = damped.get(i);
                }
                for axis in 0..3 {
                    let constrained = axes[i] >> axis & 1 == 1;
                    free[3 * node + axis] = !constrained && mass[node] > 0.0;
                    held[3 * node + axis] = constrained && mass[node] > 0.0;
                }
            }
        }
    }

    /// Takes displacements (m) over, rounded.
    pub fn displace(&self, world: &mut World, u: &[f64]) {
        self.write::<Displacement>(world, u, |column| &mut column.0);
    }

    /// Takes the numbers of a column over, rounded.
    pub fn write<C: Component<Mutability = bevy_ecs::component::Mutable>>(
        &self,
        world: &mut World,
        values: &[f64],
        numbers: fn(&mut C) -> &mut Reals,
    ) {
        for (body, range) in self.each() {
            if let Some(mut column) = world.get_mut::<C>(body) {
                numbers(&mut column).write(&values[range]);
            }
        }
    }

    /// Takes the state at the end of a step over, with what rounding leaves out of it: displacements and steps (m).
    pub fn arrive(&self, world: &mut World, u: &[f64], step: &[f64], acceleration: &[f64]) {
        self.displace(world, u);
        self.write::<DisplacementIncrement>(world, step, |column| &mut column.0);
        self.write::<Acceleration>(world, acceleration, |column| &mut column.0);
        for (body, range) in self.each() {
            let Some(mut lost) = world.get_mut::<DisplacementCompensation>(body) else { continue };
            let count = range.len();
            // f32, as only its sums are compensated
            let of = |exact: f64| f64::from(exact as f32) - exact;
            (0..count).for_each(|i| lost.set(i, of(u[range.start + i])));
            (0..count).for_each(|i| lost.set(count + i, of(step[range.start + i])));
        }
    }
}
