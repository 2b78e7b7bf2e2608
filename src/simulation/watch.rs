//! How much quicker elements can have become: a cheap bound, from how far they are deformed now.

use super::growth::{Growth, right_cauchy_green, sizes, with_identity};
use super::mass_scaling::heaviness;
use crate::assembly::square_frequencies;
use crate::backend::cpu::{BlockLaw, Cpu, ROWS_A_TASK};
use crate::components::*;
use crate::elements::{Element, MOST_NODES};
use crate::evaluation::{lane_place, node_count, with_element_of};
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// The elements of a block, and what is known of their frequencies.
pub(super) struct Watched {
    pub entity: Entity,
    growth: Growth,
    /// Of each element the bound of ω² at rest (1/s²).
    pub squares: Vec<f64>,
    /// The shortest distance between two nodes of an element at rest (m).
    pub shortest_edge: f64,
    /// The growth of ω² when the frequency of all was found last.
    known_growth: Vec<f32>,
}

/// What a look at all elements shows.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Seen {
    /// ω² of all at most (1/s²).
    pub square: f64,
    /// The largest bound of ω² of an element at rest, times its growth (1/s²).
    pub of_elements: f64,
    /// The largest bound of ω² of an element at rest (1/s²).
    pub at_rest: f64,
    /// The fastest deformation in a step: the largest change of strain, relative to the present lengths.
    pub speed: f64,
    /// Elements that are there.
    pub alive: usize,
}

impl Seen {
    pub const NOTHING: Self = Self { square: 0.0, of_elements: 0.0, at_rest: 0.0, speed: 0.0, alive: 0 };

    /// Of both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            square: self.square.max(other.square),
            of_elements: self.of_elements.max(other.of_elements),
            at_rest: self.at_rest.max(other.at_rest),
            // max forgets what is no number
            speed: if other.speed.is_nan() { f64::INFINITY } else { self.speed.max(other.speed) },
            alive: self.alive + other.alive,
        }
    }
}

impl Watched {
    /// All elements of a world.
    pub fn all(world: &mut World) -> Vec<Self> {
        let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
        blocks.sort();
        let watched = |&entity: &Entity| {
            let growth = Growth::of(world.get::<BlockLaw<f64>>(entity)?);
            let shortest_edge = shortest_edge(world, entity)?;
            let mut watched = Self { entity, growth, squares: Vec::new(), shortest_edge, known_growth: Vec::new() };
            watched.weigh(world);
            watched.known_growth = vec![1.0; watched.squares.len()];
            Some(watched)
        };
        blocks.iter().filter_map(watched).collect()
    }

    /// Takes the bounds at rest anew, with the mass that was added by now.
    pub fn weigh(&mut self, world: &World) {
        let squares = square_frequencies(world, self.entity).into_iter().enumerate();
        self.squares = squares.map(|(row, (square, _))| square / heaviness(world, self.entity, row)).collect();
    }

    /// The growth of ω² of each element when the frequency of all was found last.
    pub fn known_growth(&self) -> &[f32] {
        &self.known_growth
    }

    /// Takes it from a snapshot; false where it is none of these elements.
    pub fn take_known_growth(&mut self, growth: Vec<f32>) -> bool {
        let fits = growth.len() == self.squares.len() && growth.iter().all(|growth| growth.is_finite());
        if fits {
            self.known_growth = growth;
        }
        fits
    }

    /// Looks at all elements; ω² of all was `known` (1/s²) when it was found last.
    pub fn look(&self, world: &World, known: f64) -> Seen {
        let of_growths = self.growths(world, |row, growth, speed| {
            let own = self.squares[row] * growth;
            let ratio = (growth / f64::from(self.known_growth[row])).max(1.0);
            Seen { square: own.min(known * ratio), of_elements: own, at_rest: self.squares[row], speed, alive: 1 }
        });
        of_growths.into_iter().fold(Seen::NOTHING, Seen::and)
    }

    /// Remembers the present growth, now that the frequency of all is known.
    pub fn remember(&mut self, world: &World) {
        let growths = self.growths(world, |row, growth, _| (row, growth as f32));
        growths.into_iter().for_each(|(row, growth)| self.known_growth[row] = growth);
    }

    /// The bound of ω² of each element that is there, as it is now (1/s²), with its row.
    pub fn now(&self, world: &World) -> Vec<(usize, f64)> {
        self.growths(world, |row, growth, _| (row, self.squares[row] * growth))
    }

    fn growths<R: Send>(&self, world: &World, of: impl Fn(usize, f64, f64) -> R + Sync + Send) -> Vec<R> {
        let found = (|| {
            let block = world.get::<Block>(self.entity)?;
            let (u, d) = (world.get::<Displacement>(block.body)?, world.get::<DisplacementStep>(block.body)?);
            let (connectivity, shape) = (world.get::<Connectivity>(self.entity)?, world.get::<RestShape>(self.entity)?);
            let fibres = world.get::<FibreDirection>(self.entity).map(|fibres| &fibres.0);
            let cpu = world.resource::<Cpu>();
            macro_rules! run {
                ($T:ty) => {{
                    let elements = Elements::<$T> {
                        connectivity,
                        shape: shape.slice(),
                        u: u.slice(),
                        d: d.slice(),
                        fibres,
                        growth: &self.growth,
                    };
                    with_element_of!(block, E => elements.run::<E, R>(cpu, block.count, &of))
                }};
            }
            Some(match u.0 {
                Reals::F32(_) => run!(f32),
                Reals::F64(_) => run!(f64),
            })
        })();
        found.unwrap_or_default()
    }
}

/// The shortest distance between two nodes of an element of a block at rest (m).
fn shortest_edge(world: &World, entity: Entity) -> Option<f64> {
    let (block, connectivity) = (world.get::<Block>(entity)?, world.get::<Connectivity>(entity)?);
    let rest = &world.get::<RestPosition>(block.body)?.0;
    let nodes = node_count(block.kind);
    let place = |row: usize, a: usize| rest[connectivity[lane_place(row, nodes, a)] as usize];
    let pairs = (1..nodes).flat_map(|a| (0..a).map(move |b| (a, b)));
    let of_element = |row: usize| {
        pairs.clone().fold(f64::INFINITY, |least, (a, b)| least.min(place(row, a).distance_squared(place(row, b))))
    };
    Some((0..block.count).map(of_element).fold(f64::INFINITY, f64::min).sqrt())
}

struct Elements<'a, T> {
    connectivity: &'a [u32],
    shape: &'a [T],
    u: &'a [T],
    d: &'a [T],
    fibres: Option<&'a Reals>,
    growth: &'a Growth,
}

impl<T: Scalar> Elements<'_, T> {
    fn run<E: Element, R: Send>(
        &self,
        cpu: &Cpu,
        count: usize,
        of: &(impl Fn(usize, f64, f64) -> R + Sync + Send),
    ) -> Vec<R> {
        let task = |task: usize| {
            let rows = task * ROWS_A_TASK..count.min((task + 1) * ROWS_A_TASK);
            rows.filter_map(|row| self.element::<E>(row).map(|(growth, speed)| of(row, growth, speed))).collect()
        };
        cpu.map(count.div_ceil(ROWS_A_TASK), task).into_iter().flat_map(|part: Vec<R>| part).collect()
    }

    /// Growth and speed of deformation of an element; `None` once it is removed.
    fn element<E: Element>(&self, row: usize) -> Option<(f64, f64)> {
        let number = |k: usize| self.shape[lane_place(row, E::ROWS, k)].to_f64();
        if number(E::VOLUME_ROW) <= 0.0 {
            return None;
        }
        let corners = |column: &[T]| {
            let mut vectors = [[0.0; 3]; MOST_NODES];
            for (a, vector) in vectors[..E::NODES].iter_mut().enumerate() {
                let at = 3 * self.connectivity[lane_place(row, E::NODES, a)] as usize;
                *vector = [0, 1, 2].map(|i| column[at + i].to_f64());
            }
            E::prepare(&vectors)
        };
        let (u, d) = (corners(self.u), corners(self.d));
        let (mut growth, mut speed) = (0.0_f64, 0.0_f64);
        for point in 0..E::POINTS {
            let gradient = E::at_point(&u, point, number).gradient;
            let change = E::at_point(&d, point, number).gradient.0;
            let (f, c) = (with_identity(&gradient), right_cauchy_green(&gradient));
            let [first, inverse] = sizes(c);
            let families = self.growth.families.iter();
            let families: f64 =
                families.map(|(family, from)| self.growth.of_family(family, c, self.direction(row, from))).sum();
            growth = growth.max(self.growth.at(first.max(inverse)) + families);
            // the change of E in a step: turning is none
            let mut square = 0.0;
            for i in 0..3 {
                for j in 0..3 {
                    let e: f64 = (0..3).map(|k| 0.5 * (f[k][i] * change[k][j] + change[k][i] * f[k][j])).sum();
                    square += e * e;
                }
            }
            let relative = square.sqrt() * inverse;
            speed = if relative.is_nan() { f64::INFINITY } else { speed.max(relative) };
        }
        Some((growth, speed))
    }

    fn direction(&self, row: usize, from: &FamilyDirection<f64>) -> [f64; 3] {
        match (from, self.fibres) {
            (FamilyDirection::Uniform(a), _) => *a,
            (FamilyDirection::Varying(place), Some(all)) => {
                let numbers = 3 * self.growth.varying;
                [0, 1, 2].map(|i| all.get(lane_place(row, numbers, 3 * place + i)))
            }
            (FamilyDirection::Varying(_), None) => [0.0; 3],
        }
    }
}
