//! A bound of all frequencies by nodes: as certain as that of the stiffest element, never a smaller step, and nearly as cheap.
//!
//! An element's bound says K_e ≤ ω_e² M_e, with the lumped mass m_e/n at each of its n nodes. Summed over all elements,
//!
//! xᵀKx ≤ Σ_e ω_e² m_e/n Σ_{a of e} |x_a|² = Σ_a |x_a|² Σ_{e at a} ω_e² m_e/n,
//!
//! so ω² of all is at most the largest mean of ω_e² over the elements that meet in a node, by the mass that each brings there. A sliver
//! brings little: beside elements of usual size it counts for that much less. The same holds of what is added to a stiffness whose
//! highest frequency is known. Nodes that are held along all axes do not move and do not count.

use super::damped_step::square_with_damping;
use super::mass_scaling::heavy_mass;
use crate::assembly::undamped_square_frequencies;
use crate::components::*;
use crate::evaluation::{lane_place, node_count};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// Means over the elements of each node, of N numbers an element.
pub(super) struct NodalMeans<const N: usize> {
    /// Of each body's nodes the sums of mass times number, and of mass (kg).
    bodies: BTreeMap<Entity, Vec<([f64; N], f64)>>,
}

impl<const N: usize> NodalMeans<N> {
    pub fn new() -> Self {
        Self { bodies: BTreeMap::new() }
    }

    /// Adds elements of a block: row, mass that its nodes move with for it (kg), numbers.
    pub fn add(&mut self, world: &World, entity: Entity, elements: impl Iterator<Item = (usize, f64, [f64; N])>) {
        let (Some(block), Some(connectivity)) = (world.get::<Block>(entity), world.get::<Connectivity>(entity)) else {
            return;
        };
        let (corners, count) = (node_count(block.kind), world.get::<Mass>(block.body).map_or(0, |mass| mass.len()));
        let nodes = self.bodies.entry(block.body).or_insert_with(|| vec![([0.0; N], 0.0); count]);
        for (row, mass, numbers) in elements {
            let share = mass / corners as f64;
            for corner in 0..corners {
                let (sums, all) = &mut nodes[connectivity[lane_place(row, corners, corner)] as usize];
                *all += share;
                sums.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += share * number);
            }
        }
    }

    /// The largest means of all nodes that move; infinite where one is no number.
    pub fn largest(&self, world: &World) -> [f64; N] {
        let mut largest = [0.0_f64; N];
        for (&body, nodes) in &self.bodies {
            let axes = world.get::<ConstrainedAxes>(body);
            let moves = |node: usize| axes.is_none_or(|axes| axes[node] & 7 != 7);
            for (_, (sums, mass)) in nodes.iter().enumerate().filter(|(node, (_, mass))| *mass > 0.0 && moves(*node)) {
                for (most, sum) in largest.iter_mut().zip(sums) {
                    let mean = sum / mass;
                    // max forgets what is no number
                    *most = if mean.is_nan() { f64::INFINITY } else { most.max(mean) };
                }
            }
        }
        largest
    }
}

/// The bound of ω² of all bodies at rest (1/s²), with the mass that was added.
pub(super) fn bound_at_rest(world: &mut World) -> f64 {
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    let mut means = NodalMeans::<1>::new();
    for block in blocks {
        let of_row = |(row, (square, volume)): (usize, (f64, f64))| {
            let (mass, heavier) = heavy_mass(world, block, row)?;
            (volume > 0.0).then_some((row, mass, [square / heavier]))
        };
        means.add(world, block, undamped_square_frequencies(world, block).into_iter().enumerate().filter_map(of_row));
    }
    let square = means.largest(world)[0];
    square_with_damping(square, world)
}
