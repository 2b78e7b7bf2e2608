//! Mass scaling: elements that need a smaller step than is wanted are made heavier. Gravity, damping and the mass that is
//! reported stay those of the real mass; only what resists acceleration grows.

use crate::assembly::square_frequencies;
use crate::components::*;
use crate::evaluation::{lane_place, node_count, rest_volume};
use bevy_ecs::prelude::*;

/// Halvings of the range in which the step is sought for which so much mass may be added.
const HALVINGS: usize = 60;

/// What was added (kg), and with which kinetic energy (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Added {
    pub mass: f64,
    pub energy: f64,
}

/// An element's mass (kg) and the bound of its stable step (s).
struct Light {
    mass: f64,
    bound: f64,
}

impl Light {
    /// What must be added (kg) for it to be stable up to a step (s): the bound goes with the root of the mass.
    fn added(&self, step: f64) -> f64 {
        self.mass * ((step / self.bound).powi(2) - 1.0).max(0.0)
    }
}

/// The largest stable step (s), at most `usual`, for which the share `most` of all mass is enough.
pub(super) fn step_for(world: &mut World, most: f64, least: f64, usual: f64) -> f64 {
    let mut elements = Vec::new();
    for block in blocks(world) {
        let squares = square_frequencies(world, block).into_iter().enumerate();
        let there = squares.filter(|(_, (_, volume))| *volume > 0.0);
        elements.extend(
            there.map(|(row, (square, _))| Light { mass: mass_of(world, block, row), bound: 2.0 / square.sqrt() }),
        );
    }
    let all: f64 = elements.iter().map(|element| element.mass).sum();
    let added = |step: f64| elements.iter().map(|element| element.added(step)).sum::<f64>();
    let (mut low, mut high) = (least, usual.max(least));
    if added(high) <= most * all {
        return high;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if added(middle) <= most * all { low = middle } else { high = middle }
    }
    low
}

/// Gives all bodies the columns for it; nothing is added yet.
pub(super) fn insert_columns(precision: Precision, world: &mut World) {
    for block in blocks(world) {
        let count = world.get::<Block>(block).map_or(0, |block| block.count);
        world.entity_mut(block).insert(AddedMass(vec![0.0; count]));
    }
    let bodies: Vec<(Entity, Vec<f64>)> = world
        .query::<(Entity, &Mass)>()
        .iter(world)
        .map(|(body, mass)| (body, (0..mass.len()).map(|node| mass.get(node)).collect()))
        .collect();
    for (body, mass) in bodies {
        world.entity_mut(body).insert(FictitiousMass(Reals::from_f64(precision, mass.into_iter())));
    }
}

/// Makes elements of a block so heavy that they are stable up to a step (s); `bounds` are rows and what they are stable up
/// to as they are, with what was added before. What their nodes weigh must be summed anew: [`weigh`].
pub(super) fn make_heavier(world: &mut World, block: Entity, bounds: &[(usize, f64)], step: f64) {
    let added: Vec<(usize, f64)> = {
        let Some(column) = world.get::<AddedMass>(block) else { return };
        let total = |row: usize| mass_of(world, block, row) + column.0[row];
        bounds.iter().map(|&(row, bound)| (row, Light { mass: total(row), bound }.added(step))).collect()
    };
    if let Some(mut column) = world.get_mut::<AddedMass>(block) {
        added.into_iter().for_each(|(row, added)| column.0[row] += added);
    }
}

/// Sums anew what resists acceleration at all nodes: their mass, and what was added to the elements that are there.
pub(super) fn weigh(world: &mut World) -> Added {
    let rate = world.resource::<Clock>().rate();
    let bodies: Vec<(Entity, Vec<Entity>)> = world
        .query_filtered::<(Entity, &Authoring), With<FictitiousMass>>()
        .iter(world)
        .map(|(body, authoring)| (body, authoring.blocks.clone()))
        .collect();
    let mut sum = Added::default();
    for (body, blocks) in bodies {
        let count = world.get::<Mass>(body).map_or(0, |mass| mass.len());
        let mut added = vec![0.0; count];
        for block in blocks {
            sum.mass += spread(world, block, &mut added);
        }
        let mut columns = world.query::<(&Mass, &mut FictitiousMass, &DisplacementStep)>();
        let Ok((mass, mut inertia, step)) = columns.get_mut(world, body) else { continue };
        for node in 0..count {
            let real = mass.get(node);
            // nodes without elements stay parked
            let now = if real > 0.0 { real + added[node] } else { 0.0 };
            sum.energy += 0.5 * (now - inertia.get(node)) * step.vector(node).length_squared() * rate * rate;
            inertia.set(node, now);
        }
    }
    sum
}

/// Gives nodes their parts of what was added to the elements of a block that are there; all of it (kg).
fn spread(world: &World, entity: Entity, nodes: &mut [f64]) -> f64 {
    let parts = (
        world.get::<Block>(entity),
        world.get::<Connectivity>(entity),
        world.get::<AddedMass>(entity),
        world.get::<RestShape>(entity),
    );
    let (Some(block), Some(connectivity), Some(added), Some(shape)) = parts else { return 0.0 };
    let corners = node_count(block.kind);
    let mut sum = 0.0;
    for row in (0..block.count).filter(|&row| added.0[row] > 0.0 && rest_volume(block, row, shape) > 0.0) {
        sum += added.0[row];
        for corner in 0..corners {
            nodes[connectivity[lane_place(row, corners, corner)] as usize] += added.0[row] / corners as f64;
        }
    }
    sum
}

/// Real mass of an element (kg).
fn mass_of(world: &World, entity: Entity, row: usize) -> f64 {
    let (Some(block), Some(shape)) = (world.get::<Block>(entity), world.get::<RestShape>(entity)) else { return 0.0 };
    let density = world.get::<Density>(block.material).map_or(0.0, |density| density.0);
    density * rest_volume(block, row, shape)
}

/// How much heavier an element is than it was: real and added mass over the real one.
pub(super) fn heaviness(world: &World, entity: Entity, row: usize) -> f64 {
    let real = mass_of(world, entity, row);
    match world.get::<AddedMass>(entity) {
        Some(added) if real > 0.0 => (real + added.0[row]) / real,
        _ => 1.0,
    }
}

/// Blocks in a fixed order.
fn blocks(world: &mut World) -> Vec<Entity> {
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    blocks
}
