//! How much quicker elements can have become: a cheap bound, from how far they are deformed now.

use super::damped_step::{growth_with_damping, is_damped};
use super::growth::Growth;
use super::mass_scaling::heavy_mass;
use crate::assembly::square_frequencies;
use crate::backend::cpu::{BlockLaw, Cpu, Strain, StrainColumns, strains};
use crate::components::*;
use crate::evaluation::{lane_place, with_element_of};
use crate::math::LANES;
use crate::observation::shortest_edge;
use bevy_ecs::prelude::*;

/// Elements looked at in one task: what is found of them stays in the core's cache.
const ROWS_A_TASK: usize = 512;

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
    /// Whether anything is damped in proportion to its stiffness.
    is_damped: bool,
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
        let is_damped = is_damped(world);
        let watched = |&entity: &Entity| {
            let growth = Growth::of(world.get::<BlockLaw<f64>>(entity)?);
            let block = world.get::<Block>(entity)?;
            let rest = world.get::<RestPosition>(block.body)?;
            let shortest_edge = shortest_edge(block, world.get::<Connectivity>(entity)?, rest);
            let (squares, known_growth) = (Vec::new(), Vec::new());
            let mut watched = Self { entity, growth, squares, shortest_edge, known_growth, is_damped };
            watched.weigh(world);
            watched.known_growth = vec![1.0; watched.squares.len()];
            Some(watched)
        };
        blocks.iter().filter_map(watched).collect()
    }

    /// Takes the bounds at rest anew, with the mass that was added by now.
    pub fn weigh(&mut self, world: &World) {
        let squares = square_frequencies(world, self.entity).into_iter().enumerate();
        let heavier = |row: usize| heavy_mass(world, self.entity, row).map_or(1.0, |(_, heavier)| heavier);
        self.squares = squares.map(|(row, (square, _))| square / heavier(row)).collect();
    }

    /// The growth of ω² of each element when the frequency of all was found last.
    pub fn known_growth(&self) -> &[f32] {
        &self.known_growth
    }

    /// Takes it from a snapshot; false where it is none of these elements.
    pub fn take_known_growth(&mut self, growth: Vec<f32>) -> bool {
        // what is squeezed flat has grown without end
        let fits = growth.len() == self.squares.len();
        if fits {
            self.known_growth = growth;
        }
        fits
    }

    /// Looks at all elements; ω² of all was `known` (1/s²) when it was found last.
    pub fn look(&self, world: &World, known: f64) -> Seen {
        let of_growths = self.growths(world, Seen::NOTHING, |seen, row, growth, speed| {
            let own = self.squares[row] * growth;
            let ratio = (growth / f64::from(self.known_growth[row])).max(1.0);
            // numbers that snapshots can hold
            let (square, at_rest) = (own.min(known * ratio).min(f64::MAX), self.squares[row]);
            *seen = seen.and(Seen { square, of_elements: own.min(f64::MAX), at_rest, speed, alive: 1 });
        });
        of_growths.into_iter().fold(Seen::NOTHING, Seen::and)
    }

    /// Remembers the present growth, now that the frequency of all is known.
    pub fn remember(&mut self, world: &World) {
        let growths = self.growths(world, Vec::new(), |found, row, growth, _| found.push((row, growth as f32)));
        growths.into_iter().flatten().for_each(|(row, growth)| self.known_growth[row] = growth);
    }

    /// What ω² of each element that is there counts for as it is now (1/s²), with its row: its own bound, or what was `known` of all
    /// (1/s²) times its growth since.
    pub fn counts_for(&self, world: &World, known: f64) -> Vec<(usize, f64)> {
        let found = self.growths(world, Vec::new(), |found, row, growth, _| {
            let ratio = (growth / f64::from(self.known_growth[row])).max(1.0);
            found.push((row, (self.squares[row] * growth).min(known * ratio)));
        });
        found.into_iter().flatten().collect()
    }

    /// The bound of ω² of each element that is there, as it is now (1/s²), with its row.
    pub fn now(&self, world: &World) -> Vec<(usize, f64)> {
        let found =
            self.growths(world, Vec::new(), |found, row, growth, _| found.push((row, self.squares[row] * growth)));
        found.into_iter().flatten().collect()
    }

    /// Visits all elements that are there with row, growth of ω² and speed of deformation: each of several threads begins with
    /// `start`, and what they made of it comes in the order of rows.
    fn growths<R: Clone + Send + Sync>(
        &self,
        world: &World,
        start: R,
        visit: impl Fn(&mut R, usize, f64, f64) + Sync + Send,
    ) -> Vec<R> {
        let (cpu, count) = (world.resource::<Cpu>(), self.squares.len());
        let task = |task: usize| {
            let mut found = start.clone();
            for strain in self.strains(world, task).unwrap_or_default() {
                // beyond all that was tried: as much as f32 can keep
                let growth = growth_with_damping(self.growth.at(strain.size) + strain.more, self.is_damped);
                let growth = growth.min(f64::from(f32::MAX));
                visit(&mut found, strain.row, growth, strain.speed);
            }
            found
        };
        cpu.map(count.div_ceil(ROWS_A_TASK), task)
    }

    /// Of the elements of a task; `None` where the world has them no longer.
    fn strains(&self, world: &World, task: usize) -> Option<Vec<Strain>> {
        let block = world.get::<Block>(self.entity)?;
        let (u, d) = (world.get::<Displacement>(block.body)?, world.get::<DisplacementStep>(block.body)?);
        let (connectivity, shape) = (world.get::<Connectivity>(self.entity)?, world.get::<RestShape>(self.entity)?);
        let fibres = world.get::<FibreDirection>(self.entity).map(|fibres| &fibres.0);
        let families = |row: usize, c: [f64; 6]| -> f64 {
            let families = self.growth.families.iter();
            families.map(|(family, from)| self.growth.of_family(family, c, self.direction(row, from, fibres))).sum()
        };
        let more = (!self.growth.families.is_empty()).then_some(&families as &(dyn Fn(usize, [f64; 6]) -> f64 + Sync));
        let groups = ROWS_A_TASK / LANES;
        let groups = task * groups..block.count.div_ceil(LANES).min((task + 1) * groups);
        let cpu = world.resource::<Cpu>();
        macro_rules! run {
            ($T:ty) => {{
                let (displacement, step, rest_shape) = (u.slice(), d.slice(), shape.slice());
                let columns = StrainColumns::<$T> { displacement, step, connectivity, rest_shape };
                with_element_of!(block, E => strains::<E, $T>(cpu, &columns, groups, more))
            }};
        }
        Some(match u.0 {
            Reals::F32(_) => run!(f32),
            Reals::F64(_) => run!(f64),
        })
    }

    fn direction(&self, row: usize, from: &FamilyDirection<f64>, fibres: Option<&Reals>) -> [f64; 3] {
        match (from, fibres) {
            (FamilyDirection::Uniform(a), _) => *a,
            (FamilyDirection::Varying(place), Some(all)) => {
                let numbers = 3 * self.growth.varying;
                [0, 1, 2].map(|i| all.get(lane_place(row, numbers, 3 * place + i)))
            }
            (FamilyDirection::Varying(_), None) => [0.0; 3],
        }
    }
}
