//! The stable step, from the element bound, and the elements that set it.

use super::body_columns::{copies_of_elements, stiffnesses};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::elements::with_element_of;
use crate::elements::{Element, MOST_ROWS, Stiffness};
use crate::evaluation::rest_volume;
use crate::math::lane_place;
use bevy_ecs::prelude::*;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// How many of the elements that set the step are named.
pub const NAMED: usize = 10;

/// The largest step that the element bound shows to be stable at rest, and the elements that set it.
#[derive(Clone, Debug, Serialize)]
pub struct StableStep {
    /// 2/ω of the stiffest element (s).
    pub time_step: f64,
    /// The same of a usual element (s): half of the volume is in elements that need no smaller step.
    pub usual: f64,
    /// The elements with the smallest bounds, the smallest first: at most `NAMED`.
    pub worst: Vec<CriticalElement>,
}

/// An element that sets the step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CriticalElement {
    /// The body.
    pub body: String,
    /// The element, in the author's numbering.
    pub element: u64,
    /// 2/ω of its bound (s).
    pub bound: f64,
    /// What it costs: how many times longer the step could be if it were a usual element, and all others as well.
    pub cost: f64,
    /// How many times longer the step could be without it and those before it in the list.
    pub gain: f64,
}

impl StableStep {
    /// The element that sets the step: its body and the author's number.
    pub fn critical(&self) -> (String, u64) {
        self.worst.first().map_or_else(Default::default, |worst| (worst.body.clone(), worst.element))
    }

    /// What the worst element costs: see [`CriticalElement::cost`].
    pub fn cost(&self) -> f64 {
        self.worst.first().map_or(1.0, |worst| worst.cost)
    }
}

/// The bound of the largest squared angular frequency (1/s²) of each element of a block, by its row.
pub(super) fn square_frequency<'a>(
    world: &'a World,
    entity: Entity,
    block: &'a Block,
) -> Option<impl Fn(usize) -> f64 + Sync + 'a> {
    square_frequency_of(world, entity, block, |number| number, |moduli| moduli)
}

/// β of a block's damping (s), of each copy where it differs, else one; 0 where there is none, and in a static
/// analysis.
pub fn damping_times(world: &World, entity: Entity) -> Vec<f64> {
    let moves = world.get_resource::<Clock>().is_none_or(|clock| clock.relaxation.is_none());
    let time = |damping: Option<StiffnessDamping>| damping.filter(|_| moves).map_or(0.0, |damping| damping.0);
    if let Some(PerCopyMemory(of_copies)) = world.get(entity) {
        return of_copies.iter().map(|memory| time(memory.damping)).collect();
    }
    let material = world.get::<Block>(entity).map(|block| block.material);
    vec![time(material.and_then(|material| world.get(material)).copied())]
}

/// The same of an element by its row.
fn damping_time_of(world: &World, entity: Entity) -> impl Fn(usize) -> f64 + Sync + '_ {
    let times = damping_times(world, entity);
    let copies = copies_of_elements(world, entity);
    move |row| match (times.as_slice(), copies) {
        (&[of_all], _) => of_all,
        (of_copies, Some(copies)) => of_copies[copies[row] as usize],
        _ => 0.0,
    }
}

/// ω² (1/s²) that without damping would allow the same step 2/ω as an ω² with damping β (s): 4/Δt² of Δt =
/// (2/ω)(√(1 + ξ²) − ξ), ξ = βω/2. It grows faster than ω².
pub fn damped(square: f64, beta: f64) -> f64 {
    if beta <= 0.0 {
        return square;
    }
    // written so that nothing cancels: Δt = 4/ω² / (β + √(β² + 4/ω²))
    let half = 0.5 * beta * square.sqrt();
    square * (half + (1.0 + half * half).sqrt()).powi(2)
}

/// The same, of rest shapes whose numbers are made so, and of moduli that are.
fn square_frequency_of<'a>(
    world: &'a World,
    entity: Entity,
    block: &'a Block,
    made: impl Fn(f64) -> f64 + Sync + 'a,
    moduli: fn(Stiffness) -> Stiffness,
) -> Option<impl Fn(usize) -> f64 + Sync + 'a> {
    let stiffnesses = stiffnesses(world, entity);
    let copies = copies_of_elements(world, entity);
    let shape = world.get::<RestShape>(entity)?;
    let first = *stiffnesses.first()?;
    Some(move |row: usize| {
        let stiffness = moduli(copies.map_or(first, |copies| stiffnesses[copies[row] as usize]));
        let mut rest = [0.0; MOST_ROWS];
        with_element_of!(block, E => {
            for k in 0..E::ROWS {
                rest[k] = made(shape.get(lane_place(row, E::ROWS, k)));
            }
            E::frequency_bound(&rest, &stiffness)
        })
    })
}

/// Squared frequency bound (1/s²) and volume (m³) of all elements of a block; both 0 of removed ones. With damping
/// proportional to stiffness it is that of the same step, see [`damped`].
pub fn square_frequencies(world: &World, entity: Entity) -> Vec<(f64, f64)> {
    let beta = damping_time_of(world, entity);
    let undamped = undamped_square_frequencies(world, entity).into_iter().enumerate();
    undamped.map(|(row, (square, volume))| (damped(square, beta(row)), volume)).collect()
}

/// What [`undamped_square_frequencies`] found of each block when the step was chosen, until the run checks elements
/// for the first time.
#[derive(Resource, Default)]
pub struct SquaresAtRest(BTreeMap<Entity, Vec<(f64, f64)>>);

/// The same as if nothing were damped.
pub fn undamped_square_frequencies(world: &World, entity: Entity) -> Vec<(f64, f64)> {
    if let Some(known) = world.get_resource::<SquaresAtRest>().and_then(|known| known.0.get(&entity)) {
        return known.clone();
    }
    let Some(block) = world.get::<Block>(entity) else { return Vec::new() };
    let (Some(frequency), Some(shape)) = (square_frequency(world, entity, block), world.get::<RestShape>(entity))
    else {
        return Vec::new();
    };
    let of_row = |row: usize| {
        let volume = rest_volume(block, row, shape);
        if volume > 0.0 { (frequency(row), volume) } else { (0.0, 0.0) }
    };
    world.resource::<Cpu>().confine(|| (0..block.count).into_par_iter().map(of_row).collect())
}

/// ω² (1/s²) of a plane wave along the shortest way through each element of a block, as [`square_frequencies`] has its
/// bound: (n/ρ)(λ + 2μ') λ_max(G), which is the bound of a law whose λ is in 2μ'. 0 of removed ones.
pub(crate) fn square_wave_frequencies(world: &World, entity: Entity) -> Vec<f64> {
    let Some(block) = world.get::<Block>(entity) else { return Vec::new() };
    let along = |moduli: Stiffness| Stiffness { lambda: 0.0, shear: moduli.shear + 0.5 * moduli.lambda, ..moduli };
    let wave = square_frequency_of(world, entity, block, |number| number, along);
    let (Some(wave), Some(shape)) = (wave, world.get::<RestShape>(entity)) else { return Vec::new() };
    let beta = damping_time_of(world, entity);
    let of_row = |row: usize| match rest_volume(block, row, shape) > 0.0 {
        true => damped(wave(row), beta(row)),
        false => 0.0,
    };
    world.resource::<Cpu>().confine(|| (0..block.count).into_par_iter().map(of_row).collect())
}

/// The stable step of an element of a block, by its row: 2/ω of its bound (s), with its damping; none of a removed one.
pub fn element_step(world: &World, entity: Entity, row: usize) -> Option<f64> {
    let block = world.get::<Block>(entity)?;
    let (frequency, shape) = (square_frequency(world, entity, block)?, world.get::<RestShape>(entity)?);
    if rest_volume(block, row, shape) <= 0.0 {
        return None;
    }
    let square = damped(frequency(row), damping_time_of(world, entity)(row));
    (square > 0.0).then(|| 2.0 / square.sqrt())
}

/// A number with the digits that f32 has.
fn short(number: f64) -> f64 {
    f64::from(number as f32)
}

/// Squared frequency bound (1/s²) and mass (kg) of all elements of a block, both 0 of removed ones: the same whatever
/// precision the world is in, computed in f64 from shapes that f32 has, too.
pub fn alike_in_any_precision(world: &World, entity: Entity) -> Vec<(f64, f64)> {
    let Some(block) = world.get::<Block>(entity) else { return Vec::new() };
    let frequency = square_frequency_of(world, entity, block, short, |moduli| moduli);
    let (Some(frequency), Some(shape)) = (frequency, world.get::<RestShape>(entity)) else { return Vec::new() };
    let (inertia, beta) = (ElementInertia::of(world, entity), damping_time_of(world, entity));
    let of_row = |row: usize| {
        let volume = short(rest_volume(block, row, shape));
        if volume > 0.0 { (damped(frequency(row), beta(row)), inertia.of_row(row)[0] * volume) } else { (0.0, 0.0) }
    };
    world.resource::<Cpu>().confine(|| (0..block.count).into_par_iter().map(of_row).collect())
}

/// An element, by how quick it is.
struct Ranked {
    square: f64,
    volume: f64,
    block: Entity,
    row: usize,
}

/// Bound of all elements of all bodies that are there; `None` for a world without elements.
pub fn stable_step(world: &mut World) -> Option<StableStep> {
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    world.remove_resource::<SquaresAtRest>();
    let known = blocks.iter().map(|&block| (block, undamped_square_frequencies(world, block)));
    let known = SquaresAtRest(known.collect());
    world.insert_resource(known);
    let mut all: Vec<Ranked> = Vec::new();
    for block in blocks {
        let elements = square_frequencies(world, block).into_iter().enumerate();
        let there = elements.filter(|(_, (_, volume))| *volume > 0.0);
        all.extend(there.map(|(row, (square, volume))| Ranked { square, volume, block, row }));
    }
    // the highest frequency first; among equals the lowest row, whatever the order of work
    let order =
        |a: &Ranked, b: &Ranked| b.square.total_cmp(&a.square).then(a.block.cmp(&b.block)).then(a.row.cmp(&b.row));
    world.resource::<Cpu>().confine(|| all.par_sort_unstable_by(order));
    let half = 0.5 * all.iter().map(|element| element.volume).sum::<f64>();
    let mut volume = 0.0;
    let usual = all.iter().find(|element| {
        volume += element.volume;
        volume >= half
    })?;
    let bound = |element: &Ranked| 2.0 / element.square.sqrt();
    let (first, usual) = (bound(all.first()?), bound(usual));
    let named = all.iter().take(NAMED).enumerate().filter_map(|(place, element)| {
        let (body, number) = author_of(world, element.block, element.row)?;
        let next = all.get(place + 1).map_or(first, bound);
        let own = bound(element);
        Some(CriticalElement { body, element: number, bound: own, cost: usual / own, gain: next / first })
    });
    Some(StableStep { time_step: first, usual, worst: named.collect() })
}

/// The body and the author's number of an element.
pub fn author_of(world: &World, block: Entity, row: usize) -> Option<(String, u64)> {
    let body = world.get::<OfBody>(block)?.0;
    let authoring = world.get::<Authoring>(body)?;
    let place = authoring.blocks.iter().position(|&other| other == block)?;
    Some((world.get::<Label>(body)?.0.clone(), authoring.element_id(place, row)))
}
