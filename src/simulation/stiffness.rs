//! How much quicker elements can have become: a cheap bound, from how far they are deformed now.

mod bounds;
mod strain;

use super::damped_step::{is_damped, ratio_with_damping};
use super::stiffness_ratio::StiffnessRatio;
use crate::assembly::SquaresAtRest;
use crate::backend::cpu::{BlockLaw, Cpu, Strain};
use crate::components::*;
use crate::math::LANES;
use crate::observation::shortest_edge;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// Elements checked in one task: what is found of them stays in the core's cache.
const ROWS_A_TASK: usize = 512;
/// Elements that are checked together, before one by one: neighbours, which are deformed alike.
const ROWS_A_PART: usize = 64;
const PARTS_A_TASK: usize = ROWS_A_TASK / ROWS_A_PART;
const GROUPS_A_TASK: usize = ROWS_A_TASK / LANES;
/// Parts whose elements are checked one by one before it is asked which others still need it; then twice as many.
const PARTS_AT_FIRST: usize = 4;
/// What elements come to is known to this: their ω², and how much stiffer they have become.
const NEARLY: f64 = 1.1;

/// The elements of a block, and what is known of their frequencies.
pub(super) struct StiffnessTracker {
    pub entity: Entity,
    stiffness: StiffnessRatio,
    /// Of each element the bound of ω² at rest (1/s²); 0 where all its nodes are held: it does not move by itself.
    pub squares: Vec<f64>,
    /// The same of a plane wave along its shortest way (1/s²).
    waves: Vec<f64>,
    /// The shortest distance between two nodes of an element at rest (m).
    pub shortest_edge: f64,
    /// The ratio of ω² of all, by each element, when that was found last.
    known_ratio: Vec<f32>,
    /// What the elements of each part come to at rest.
    parts: Vec<Part>,
    /// How many elements were there when that was summed up.
    counted: usize,
    /// Whether anything is damped in proportion to its stiffness.
    pub is_damped: bool,
    /// What the last check showed, task by task.
    deformed: Vec<Deformed>,
}

/// What the elements of a part come to at rest: those that are there, and can move.
#[derive(Clone, Copy)]
struct Part {
    /// The largest bound of ω² (1/s²).
    at_rest: f64,
    /// The largest ω² of a plane wave (1/s²).
    wave: f64,
    /// The least ratio of ω² of all when that was found.
    least_known: f64,
}

impl Part {
    /// The bound of ω² of elements whose own has grown `own` times at most, that of waves `of_all` times (1/s²).
    fn of_elements(&self, own: f64, of_all: f64) -> f64 {
        (self.at_rest * own).max(self.wave * of_all).min(f64::MAX)
    }
}

/// How far the elements of a task are deformed, and its parts as if one element were the largest in everything.
#[derive(Default)]
struct Deformed {
    parts: Vec<(Strain, usize)>,
    /// [`Strain::size`] of each element, 0 of what is not there.
    size: Vec<f64>,
    /// [`Strain::squeeze`] of each.
    squeeze: Vec<f64>,
    /// [`Strain::more`] of each, 0 where nothing more is asked for.
    more: Vec<f64>,
}

/// What strains of a block are taken from.
struct Columns<'w> {
    cpu: &'w Cpu,
    block: &'w Block,
    u: &'w Displacement,
    d: &'w DisplacementIncrement,
    connectivity: &'w Connectivity,
    shape: &'w RestShape,
    fibres: Option<&'w FibreDirection>,
}

/// Groups of a part's elements.
fn part_groups(part: usize) -> Range<usize> {
    part * ROWS_A_PART / LANES..(part + 1) * ROWS_A_PART / LANES
}

/// What a check of all elements shows.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct StabilitySample {
    /// ω² of all at most (1/s²): by the elements alone, or by what was known of all.
    pub square: f64,
    /// The largest bound of ω² of an element at rest, times its ratio; or of a wave along its shortest way, times that
    /// of waves (1/s²).
    pub of_elements: f64,
    /// The largest bound of ω² of an element at rest (1/s²).
    pub at_rest: f64,
    /// The most that the stiffness of an element has grown since the frequency of all was found.
    pub ratio: f64,
    /// The fastest deformation in a step: the largest change of strain, relative to the present lengths; and relative
    /// to their mean over the axes.
    pub speed: f64,
    pub mean_speed: f64,
    /// Elements that are there.
    pub alive: usize,
}

impl StabilitySample {
    pub const NOTHING: Self = Self {
        square: f64::INFINITY,
        of_elements: 0.0,
        at_rest: 0.0,
        ratio: 1.0,
        speed: 0.0,
        mean_speed: 0.0,
        alive: 0,
    };

    /// Of both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            square: f64::INFINITY,
            of_elements: self.of_elements.max(other.of_elements),
            at_rest: self.at_rest.max(other.at_rest),
            ratio: self.ratio.max(other.ratio),
            speed: fastest(self.speed, other.speed),
            mean_speed: fastest(self.mean_speed, other.mean_speed),
            alive: self.alive + other.alive,
        }
    }
}

/// The larger one: `max` would forget what is no number.
fn fastest(one: f64, other: f64) -> f64 {
    if other.is_nan() { f64::INFINITY } else { one.max(other) }
}

impl StiffnessTracker {
    /// All elements of a world.
    pub fn all(world: &mut World) -> Vec<Self> {
        let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
        blocks.sort();
        let is_damped = is_damped(world);
        let tracked = |&entity: &Entity| {
            let stiffness = StiffnessRatio::of(world.get::<BlockLaw<f64>>(entity)?);
            let block = world.get::<Block>(entity)?;
            let rest = world.get::<RestPosition>(block.body)?;
            let shortest_edge = shortest_edge(block, world.get::<Connectivity>(entity)?, rest);
            let (squares, waves, parts) = (Vec::new(), Vec::new(), Vec::new());
            let known_ratio = vec![1.0; block.count];
            let mut tracked = Self {
                entity,
                stiffness,
                squares,
                waves,
                shortest_edge,
                known_ratio,
                parts,
                counted: 0,
                is_damped,
                deformed: vec![],
            };
            tracked.update_bounds(world);
            Some(tracked)
        };
        let all = blocks.iter().filter_map(tracked).collect();
        // from here on bodies may change
        world.remove_resource::<SquaresAtRest>();
        all
    }

    /// The ratio of ω² of each element when the frequency of all was found last.
    pub fn known_ratio(&self) -> &[f32] {
        &self.known_ratio
    }

    /// Takes it from a snapshot; false where it is none of these elements.
    pub fn take_known_ratio(&mut self, ratio: Vec<f32>, world: &World) -> bool {
        let fits = ratio.len() == self.squares.len();
        if fits {
            self.known_ratio = ratio;
            self.sum_up(world);
        }
        fits
    }

    /// Samples all elements: first what those of a part come to were one of them the largest in everything, then
    /// one after the other where that comes to most.
    pub fn sample(&mut self, world: &World) -> StabilitySample {
        let (cpu, count) = (world.resource::<Cpu>(), self.squares.len());
        let of_task = |task: usize| -> Deformed {
            let parts = task * PARTS_A_TASK..count.div_ceil(ROWS_A_PART).min((task + 1) * PARTS_A_TASK);
            let mut found = Deformed::default();
            let Some(columns) = self.columns(world) else { return found };
            for part in parts {
                let widest = self.strains(&columns, part_groups(part), None, Some(&mut found));
                found.parts.push(widest);
            }
            found
        };
        self.deformed = cpu.map(count.div_ceil(ROWS_A_TASK), of_task);
        let widest = || self.deformed.iter().flat_map(|task| &task.parts);
        let most = |of: fn(&Strain) -> f64| widest().map(|(most, _)| of(most)).fold(1.0, f64::max);
        let (size, squeeze) = (most(|part| part.size), most(|part| part.squeeze));
        let alive = widest().map(|(_, alive)| alive).sum::<usize>();
        self.stiffness.reach(size, squeeze);
        if alive != self.counted {
            self.sum_up(world);
        }
        let widest = self.deformed.iter().flat_map(|task| &task.parts);
        let parts = widest.zip(&self.parts).enumerate().filter(|(_, ((_, alive), _))| *alive > 0);
        let (places, parts): (Vec<usize>, Vec<StabilitySample>) = parts
            .map(|(part, (&(widest, alive), known))| {
                let [own, of_all] = self.ratio_of(widest.size, widest.squeeze, widest.more);
                let (of_elements, ratio) = (known.of_elements(own, of_all), (of_all / known.least_known).max(1.0));
                (
                    part,
                    StabilitySample {
                        square: f64::INFINITY,
                        of_elements,
                        at_rest: known.at_rest,
                        ratio,
                        speed: widest.speed,
                        mean_speed: widest.mean_speed,
                        alive,
                    },
                )
            })
            .unzip();
        let parts = self.refined(world, &places, parts);
        parts.into_iter().fold(StabilitySample::NOTHING, StabilitySample::and)
    }

    /// Samples elements one by one in those of some parts, at `places`, that may come to most.
    fn refined(&self, world: &World, places: &[usize], mut parts: Vec<StabilitySample>) -> Vec<StabilitySample> {
        let at_rest = parts.iter().fold(0.0_f64, |most, part| most.max(part.at_rest));
        let most = |part: &StabilitySample| (part.of_elements / at_rest).max(part.ratio);
        // what is known to come to so much at least
        let mut known = StabilitySample { of_elements: at_rest, ..StabilitySample::NOTHING };
        let mut left: Vec<usize> = (0..parts.len()).collect();
        let mut at_once = PARTS_AT_FIRST;
        loop {
            left.retain(|&i| {
                parts[i].of_elements > NEARLY * known.of_elements || parts[i].ratio > NEARLY * known.ratio
            });
            if left.is_empty() {
                return parts;
            }
            if left.len() > at_once {
                left.select_nth_unstable_by(at_once, |&a, &b| most(&parts[b]).total_cmp(&most(&parts[a])));
            }
            let chosen: Vec<usize> = left.drain(..left.len().min(at_once)).collect();
            at_once *= 2;
            let one_by_one = |i: usize| self.one_by_one((places[chosen[i]], parts[chosen[i]]), &known);
            for (i, found) in chosen.iter().zip(world.resource::<Cpu>().map(chosen.len(), one_by_one)) {
                parts[*i] = found;
                known = known.and(found);
            }
        }
    }

    /// What the elements of a part come to that may all together come to `at_most`, or what others are `known` to come
    /// to, where that is more.
    fn one_by_one(&self, (part, at_most): (usize, StabilitySample), known: &StabilitySample) -> StabilitySample {
        let (mut of_elements, mut ratio) = (known.of_elements, known.ratio);
        let Some(of) = self.deformed.get(part / PARTS_A_TASK) else { return at_most };
        let Part { at_rest, wave, least_known } = self.parts[part];
        // no element that is deformed less comes to more than what is known
        let until = |of_elements: f64, ratio: f64| match self.is_damped || !self.stiffness.families.is_empty() {
            true => [0.0; 2],
            false => self.stiffness.until(of_elements / at_rest, (ratio * least_known).min(of_elements / wave)),
        };
        let [mut size, mut squeeze] = until(of_elements, ratio);
        let first = part / PARTS_A_TASK * ROWS_A_TASK;
        for row in part * ROWS_A_PART..self.squares.len().min((part + 1) * ROWS_A_PART) {
            let place = row - first;
            let may_be_more = of.size[place] > size || of.squeeze[place] > squeeze;
            if of.size[place] > 0.0 && self.squares[row] > 0.0 && may_be_more {
                let [own, of_all] = self.ratio_of(of.size[place], of.squeeze[place], of.more[place]);
                let (own, of_all) = (self.square_of(row, own, of_all), of_all / f64::from(self.known_ratio[row]));
                if own > of_elements || of_all > ratio {
                    (of_elements, ratio) = (of_elements.max(own), ratio.max(of_all));
                    [size, squeeze] = until(of_elements, ratio);
                }
            }
        }
        StabilitySample { of_elements, ratio, ..at_most }
    }

    /// Remembers the present ratio, now that the frequency of all is known.
    pub fn remember(&mut self, world: &World) {
        self.reach_all(world);
        let ratios = self.ratios(world, Vec::new(), |found, row, [_, of_all]| found.push((row, of_all as f32)));
        ratios.into_iter().flatten().for_each(|(row, ratio)| self.known_ratio[row] = ratio);
        self.sum_up(world);
    }

    /// Of each element that is there: its row, the bound of its own ω² as it is now (1/s²), and how much stiffer it has
    /// become since the frequency of all was found.
    pub fn now(&mut self, world: &World) -> Vec<(usize, f64, f64)> {
        self.reach_all(world);
        let found = self.ratios(world, Vec::new(), |found, row, [own, of_all]| {
            let ratio = (of_all / f64::from(self.known_ratio[row])).max(1.0);
            found.push((row, self.square_of(row, own, of_all), ratio));
        });
        found.into_iter().flatten().collect()
    }

    /// The bound of an element's ω² when its own has grown `own` times, that of waves `of_all` times (1/s²).
    fn square_of(&self, row: usize, own: f64, of_all: f64) -> f64 {
        (self.squares[row] * own).max(self.waves[row] * of_all)
    }

    /// Stiffness ratio of an element's own ω², and of that of all.
    fn ratio_of(&self, size: f64, squeeze: f64, more: f64) -> [f64; 2] {
        // as much as f32 can keep
        [self.stiffness.own(size), self.stiffness.of_all(size, squeeze)]
            .map(|ratio| ratio_with_damping(ratio + more, self.is_damped).min(f64::from(f32::MAX)))
    }

    /// Tries the law as far as an element is deformed now.
    fn reach_all(&mut self, world: &World) {
        let widest = self.each_task(world, [1.0_f64; 2], |[size, squeeze], strain| {
            (*size, *squeeze) = (size.max(strain.size), squeeze.max(strain.squeeze));
        });
        let most = |i: usize| widest.iter().fold(1.0, |most: f64, task| most.max(task[i]));
        self.stiffness.reach(most(0), most(1));
    }

    /// Visits all elements that are there with row and both ratios of ω².
    fn ratios<R: Clone + Send + Sync>(
        &self,
        world: &World,
        start: R,
        visit: impl Fn(&mut R, usize, [f64; 2]) + Sync + Send,
    ) -> Vec<R> {
        self.each_task(world, start, |found, strain| {
            visit(found, strain.row, self.ratio_of(strain.size, strain.squeeze, strain.more));
        })
    }

    /// Visits all elements that are there: each of several threads begins with `start`, and what they made of it comes
    /// in the order of rows.
    fn each_task<R: Clone + Send + Sync>(
        &self,
        world: &World,
        start: R,
        visit: impl Fn(&mut R, &Strain) + Sync + Send,
    ) -> Vec<R> {
        let groups = self.squares.len().div_ceil(LANES);
        let task = |task: usize| {
            let mut found = start.clone();
            if let Some(columns) = self.columns(world) {
                let own = task * GROUPS_A_TASK..groups.min((task + 1) * GROUPS_A_TASK);
                let mut visit = |strains: &[Strain]| strains.iter().for_each(|strain| visit(&mut found, strain));
                self.strains(&columns, own, Some(&mut visit), None);
            }
            found
        };
        world.resource::<Cpu>().map(groups.div_ceil(GROUPS_A_TASK), task)
    }
}
