//! The stable step, from the element bound.

use super::columns::stiffness;
use crate::components::*;
use crate::elements::{Element, MOST_ROWS};
use crate::evaluation::{lane_place, row_count, with_element};
use bevy_ecs::prelude::*;
use rayon::prelude::*;

/// The largest step that the element bound shows to be stable at rest, and the element that sets it.
#[derive(Clone, Debug)]
pub struct StableStep {
    /// 2/ω of the stiffest element (s).
    pub time_step: f64,
    /// The body.
    pub body: String,
    /// The element, in the author's numbering.
    pub element: u64,
}

/// The bound of the largest squared angular frequency (1/s²) of each element of a block, by its row.
pub(super) fn square_frequency<'a>(
    world: &'a World,
    entity: Entity,
    block: &'a Block,
) -> Option<impl Fn(usize) -> f64 + Sync + 'a> {
    let stiffness = stiffness(world, block.material);
    let shape = world.get::<RestShape>(entity)?;
    let numbers = row_count(block.kind);
    Some(move |row: usize| {
        let mut rest = [0.0; MOST_ROWS];
        for k in 0..numbers {
            rest[k] = shape.get(lane_place(row, numbers, k));
        }
        with_element!(block.kind, E => E::frequency_bound(&rest, &stiffness))
    })
}

/// Bound of all elements of all bodies; `None` for a world without elements.
pub fn stable_step(world: &mut World) -> Option<StableStep> {
    let blocks: Vec<(Entity, Block)> =
        world.query::<(Entity, &Block)>().iter(world).map(|(entity, block)| (entity, block.clone())).collect();
    let mut worst: Option<(f64, Entity, usize)> = None;
    for (entity, block) in blocks {
        let Some(frequency) = square_frequency(world, entity, &block) else { continue };
        // the highest frequency; among equals the lowest row, whatever the order of work
        let higher = |a: (f64, usize), b: (f64, usize)| {
            if b.0 > a.0 || (b.0 == a.0 && b.1 < a.1) { b } else { a }
        };
        let found =
            (0..block.count).into_par_iter().map(|row| (frequency(row), row)).reduce(|| (0.0, usize::MAX), higher);
        if worst.is_none_or(|(highest, ..)| found.0 > highest) {
            worst = Some((found.0, entity, found.1));
        }
    }
    let (square, entity, row) = worst?;
    let body = world.get::<OfBody>(entity)?.0;
    let authoring = world.get::<Authoring>(body)?;
    let place = authoring.blocks.iter().position(|&block| block == entity)?;
    let element = authoring.element_id(place, row);
    let body = world.get::<Label>(body)?.0.clone();
    Some(StableStep { time_step: 2.0 / square.sqrt(), body, element })
}
