//! A bound of all frequencies by nodes: as certain as that of the stiffest element, never a smaller step, and nearly as
//! cheap.
//!
//! An element's bound says K_e ≤ ω_e² M_e, with the lumped mass s_a m_e at its node a, s_a the node's share. Summed
//! over all elements,
//!
//! xᵀKx ≤ Σ_e ω_e² m_e Σ_{a of e} s_a |x_a|² = Σ_a |x_a|² Σ_{e at a} ω_e² s_a m_e,
//!
//! so ω² of all is at most the largest mean of ω_e² over the elements that meet in a node, by the mass that each brings
//! there. A sliver brings little: beside elements of usual size it counts for that much less. The same holds of what is
//! added to a stiffness whose highest frequency is known. Nodes that are held along all axes do not move and do not
//! count.

use super::damped_step::square_with_damping;
use super::mass_scaling::scaled_mass;
use super::stiffness::StiffnessTracker;
use crate::assembly::undamped_square_frequencies;
use crate::components::*;
use crate::elements::mass_shares;
use crate::math::lane_place;
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// Means over the elements of each node.
pub(super) struct NodalMeans {
    /// Of each body's nodes the sums of mass times number, and of mass (kg).
    bodies: BTreeMap<Entity, Vec<(f64, f64)>>,
}

impl NodalMeans {
    pub fn new() -> Self {
        Self { bodies: BTreeMap::new() }
    }

    /// Adds elements of a block: row, mass that its nodes move with for it (kg), number.
    pub fn add(&mut self, world: &World, entity: Entity, elements: impl Iterator<Item = (usize, f64, f64)>) {
        let (Some(block), Some(connectivity)) = (world.get::<Block>(entity), world.get::<Connectivity>(entity)) else {
            return;
        };
        let (shares, count) = (mass_shares(block.kind), world.get::<Mass>(block.body).map_or(0, |mass| mass.len()));
        let nodes = self.bodies.entry(block.body).or_insert_with(|| vec![(0.0, 0.0); count]);
        for (row, mass, number) in elements {
            for (corner, share) in shares.iter().enumerate() {
                let share = mass * share;
                let (sum, all) = &mut nodes[connectivity[lane_place(row, shares.len(), corner)] as usize];
                *all += share;
                *sum += share * number;
            }
        }
    }

    /// The largest mean of all nodes that move; infinite where one is no number.
    pub fn largest(&self, world: &World) -> f64 {
        let mut largest = 0.0_f64;
        for (&body, nodes) in &self.bodies {
            let axes = world.get::<ConstrainedAxes>(body);
            let moves = |node: usize| axes.is_none_or(|axes| axes[node] & 7 != 7);
            for (_, (sum, mass)) in nodes.iter().enumerate().filter(|(node, (_, mass))| *mass > 0.0 && moves(*node)) {
                let mean = sum / mass;
                // max forgets what is no number
                largest = if mean.is_nan() { f64::INFINITY } else { largest.max(mean) };
            }
        }
        largest
    }
}

/// For each axis of the bodies' nodes, one body after the other, the square of the mean of ω² of the elements there as
/// they are now, over the largest: where the highest frequency may be.
pub(super) fn weights_now(world: &mut World, trackers: &mut [StiffnessTracker], bodies: &[Entity]) -> Vec<f64> {
    let mut means = NodalMeans::new();
    for block in trackers {
        let entity = block.entity;
        let of_row = |(row, square, _): (usize, f64, f64)| Some((row, scaled_mass(world, entity, row)?.0, square));
        let elements: Vec<_> = block.now(world).into_iter().filter_map(of_row).collect();
        means.add(world, entity, elements.into_iter());
    }
    let largest = means.largest(world);
    let weight = |(sum, mass): &(f64, f64)| if *mass > 0.0 { (sum / mass / largest).powi(2).min(1.0) } else { 0.0 };
    let of_body = |body| means.bodies.get(body).into_iter().flatten().map(weight);
    bodies.iter().flat_map(of_body).flat_map(|weight| [weight; 3]).collect()
}

/// The bound of ω² of all bodies at rest (1/s²), with the mass that was added.
pub(super) fn bound_at_rest(world: &mut World) -> f64 {
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    let mut means = NodalMeans::new();
    for block in blocks {
        let of_row = |(row, (square, volume)): (usize, (f64, f64))| {
            let (mass, mass_factor) = scaled_mass(world, block, row)?;
            (volume > 0.0).then_some((row, mass, square / mass_factor))
        };
        means.add(world, block, undamped_square_frequencies(world, block).into_iter().enumerate().filter_map(of_row));
    }
    let square = means.largest(world);
    square_with_damping(square, world)
}
