//! Mass scaling: elements that need a smaller step than is wanted are made heavier. Gravity, damping and the mass that
//! is reported stay those of the real mass; only what resists acceleration grows.

use crate::assembly::{alike_in_any_precision, author_of};
use crate::components::*;
use crate::elements::mass_shares;
use crate::evaluation::rest_volume;
use crate::math::lane_place;
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
        elements.extend(there(world, block).map(|(_, element)| element));
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
        world.entity_mut(body).insert(InertialMass(Reals::from_f64(precision, mass.into_iter())));
    }
}

/// Elements of a block that are there at rest, by their rows: without what was added.
fn there(world: &World, block: Entity) -> impl Iterator<Item = (usize, Light)> {
    let elements = alike_in_any_precision(world, block).into_iter().enumerate();
    let there = elements.filter(|(_, (_, mass))| *mass > 0.0);
    there.map(|(row, (square, mass))| (row, Light { mass, bound: 2.0 / square.sqrt() }))
}

/// What has to be added to elements so that they are stable up to a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Additions {
    /// Block, row, mass (kg) that comes on top of what was added before.
    elements: Vec<(Entity, usize, f64)>,
}

impl Additions {
    /// For all elements at rest, to which nothing was added yet.
    pub fn at_rest(world: &mut World, step: f64) -> Self {
        let mut additions = Self::default();
        for block in blocks(world) {
            additions.elements.extend(there(world, block).map(|(row, element)| (block, row, element.added(step))));
        }
        additions
    }

    /// For elements of a block: rows, and what they are stable up to as they are, with what was added before.
    pub fn and(&mut self, world: &World, block: Entity, bounds: &[(usize, f64)], step: f64) {
        let needed = |&(row, bound): &(usize, f64)| {
            let (mass, _) = scaled_mass(world, block, row)?;
            Some((block, row, Light { mass, bound }.added(step)))
        };
        self.elements.extend(bounds.iter().filter_map(needed));
    }

    /// All of it (kg); infinite where one is no number.
    pub fn mass(&self) -> f64 {
        let mass: f64 = self.elements.iter().map(|(_, _, added)| added).sum();
        if mass.is_nan() { f64::INFINITY } else { mass }
    }

    /// Body and author's number of the element that needs most.
    pub fn most_needy(&self, world: &World) -> (String, u64) {
        let order = |added: f64| if added.is_nan() { f64::INFINITY } else { added };
        let most = self.elements.iter().max_by(|a, b| order(a.2).total_cmp(&order(b.2)));
        most.and_then(|&(block, row, _)| author_of(world, block, row)).unwrap_or_default()
    }

    /// Adds it. What nodes weigh must be summed anew: [`scale_masses`].
    pub fn make(&self, world: &mut World) {
        for &(block, row, added) in &self.elements {
            if let Some(mut column) = world.get_mut::<AddedMass>(block) {
                column.0[row] += added;
            }
        }
    }
}

/// Sums anew what resists acceleration at all nodes: their mass, and what was added to the elements that are there.
pub(super) fn scale_masses(world: &mut World) -> Added {
    let rate = world.resource::<Clock>().rate();
    let bodies: Vec<(Entity, Vec<Entity>)> = world
        .query_filtered::<(Entity, &Authoring), With<InertialMass>>()
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
        let mut columns = world.query::<(&Mass, &mut InertialMass, &DisplacementIncrement)>();
        let Ok((mass, mut inertia, step)) = columns.get_mut(world, body) else { continue };
        for node in 0..count {
            let real = mass.get(node);
            // nodes without elements stay inactive
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
    let shares = mass_shares(block.kind);
    let mut sum = 0.0;
    for row in (0..block.count).filter(|&row| added.0[row] > 0.0 && rest_volume(block, row, shape) > 0.0) {
        sum += added.0[row];
        for (corner, share) in shares.iter().enumerate() {
            nodes[connectivity[lane_place(row, shares.len(), corner)] as usize] += added.0[row] * share;
        }
    }
    sum
}

/// Real mass of an element (kg), as the world's precision has it.
fn mass_of(world: &World, entity: Entity, row: usize) -> f64 {
    let (Some(block), Some(shape)) = (world.get::<Block>(entity), world.get::<RestShape>(entity)) else { return 0.0 };
    ElementInertia::of(world, entity).of_row(row)[0] * rest_volume(block, row, shape)
}

/// The mass that an element's nodes move with for it (kg), and how many times its real one that is; `None` of one that
/// is not there.
pub(super) fn scaled_mass(world: &World, entity: Entity, row: usize) -> Option<(f64, f64)> {
    let real = mass_of(world, entity, row);
    let added = world.get::<AddedMass>(entity).map_or(0.0, |added| added.0[row]);
    (real > 0.0).then(|| (real + added, (real + added) / real))
}

/// Real mass of all elements (kg).
pub(super) fn mass_of_all(world: &mut World) -> f64 {
    blocks(world).into_iter().map(|block| there(world, block).map(|(_, element)| element.mass).sum::<f64>()).sum()
}

/// Blocks in a fixed order.
fn blocks(world: &mut World) -> Vec<Entity> {
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    blocks
}
