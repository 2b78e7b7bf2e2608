//! The 3×3 block of each node, of all elements at rest.

use super::super::super::block_forces::BlockForces;
use super::super::super::tangent::{at_an_instant, heights_at_nodes};
use super::{Operator, Preconditioner};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::elements::node_count;
use crate::math::lane_place;
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

/// How far a corner is displaced to see what it meets, as a share of the height of the flattest element.
const CHANGE: f64 = 1e-7;

/// B = the inverses of the diagonal blocks of D + c K, K that of bodies at rest: found once, a corner and an axis of
/// all elements at a time, and again when some have gone.
#[derive(Default)]
pub(in crate::simulation) struct BlockJacobi {
    /// Diagonal blocks of K (N/m), a node each.
    stiffness: Vec<DMat3>,
    /// How many elements it is of.
    elements: usize,
    inverses: Vec<DMat3>,
    /// What the inverses were made of.
    inertia: Vec<f64>,
    free: Vec<bool>,
    share: f64,
}

impl Preconditioner for BlockJacobi {
    fn apply(&self, residual: &[f64], z: &mut [f64]) {
        for ((inverse, r), z) in self.inverses.iter().zip(residual.chunks_exact(3)).zip(z.chunks_exact_mut(3)) {
            z.copy_from_slice(&(*inverse * DVec3::from_slice(r)).to_array());
        }
    }

    fn follow(&mut self, operator: &Operator<'_>) {
        let elements = elements_left(operator);
        if (self.stiffness.len() * 3, self.elements) != (operator.free.len(), elements) {
            self.elements = elements;
            self.stiffness = operator.bodies.iter().flat_map(|&body| blocks_of(operator.world, body)).collect();
        } else if self.share == operator.stiffness && self.inertia == operator.inertia && self.free == operator.free {
            return;
        }
        (self.share, self.inertia, self.free) = (operator.stiffness, operator.inertia.to_vec(), operator.free.to_vec());
        let block = |node: usize| {
            let axes = 3 * node..3 * node + 3;
            inverse(self.stiffness[node] * self.share, &self.inertia[axes.clone()], &self.free[axes])
        };
        self.inverses = (0..self.stiffness.len()).map(block).collect();
    }
}

/// How many elements have not been removed.
fn elements_left(operator: &Operator<'_>) -> usize {
    let blocks = operator.bodies.iter().filter_map(|&body| operator.world.get::<Authoring>(body));
    let left = |&entity: &Entity| {
        let count = operator.world.get::<Block>(entity).map_or(0, |block| block.count);
        let alive = operator.world.get::<Alive>(entity);
        alive.map_or(count, |alive| alive[..count].iter().filter(|&&alive| alive != 0).count())
    };
    blocks.flat_map(|authoring| &authoring.blocks).map(left).sum()
}

/// Of the block of a node with its inertia, on the axes that are free; of its diagonal where that is not positive.
fn inverse(stiffness: DMat3, inertia: &[f64], free: &[bool]) -> DMat3 {
    let mut block = stiffness;
    for i in 0..3 {
        block.col_mut(i)[i] += inertia[i];
        if !free[i] {
            (0..3).for_each(|j| {
                block.col_mut(i)[j] = 0.0;
                block.col_mut(j)[i] = 0.0;
            });
            block.col_mut(i)[i] = 1.0;
        }
    }
    let diagonal = DVec3::new(block.x_axis.x, block.y_axis.y, block.z_axis.z);
    let minor = diagonal.x * diagonal.y - block.y_axis.x * block.x_axis.y;
    let mut inverse = match diagonal.x > 0.0 && minor > 0.0 && block.determinant() > 1e-12 * diagonal.element_product()
    {
        true => block.inverse(),
        false => DMat3::from_diagonal(diagonal.map(|number| if number > 0.0 { 1.0 / number } else { 0.0 })),
    };
    inverse = (inverse + inverse.transpose()) * 0.5;
    (0..3).filter(|&i| !free[i]).for_each(|i| inverse.col_mut(i)[i] = 0.0);
    inverse
}

/// Of each node of a body the diagonal block of its stiffness at rest.
fn blocks_of(world: &World, body: Entity) -> Vec<DMat3> {
    let nodes = world.get::<Mass>(body).map_or(0, |mass| mass.len());
    let mut blocks = vec![DMat3::ZERO; nodes];
    let heights = heights_at_nodes(world, body).unwrap_or_default();
    let change = CHANGE * heights.into_iter().fold(f64::INFINITY, f64::min);
    if !(change.is_finite() && change > 0.0) {
        return blocks;
    }
    for &entity in world.get::<Authoring>(body).into_iter().flat_map(|authoring| &authoring.blocks) {
        let (Some(apart), Some(connectivity)) =
            (BlockForces::of(world, entity, at_an_instant), world.get::<Connectivity>(entity))
        else {
            continue;
        };
        add_blocks(world.resource::<Cpu>(), apart.apart(), connectivity, change, &mut blocks);
    }
    blocks
}

fn add_blocks(cpu: &Cpu, mut block: BlockForces<'_>, connectivity: &[u32], change: f64, blocks: &mut [DMat3]) {
    let (corners, count) = (node_count(block.block.kind), block.block.count);
    let mut u = vec![0.0; 3 * connectivity.len()];
    let mut forces = vec![0.0; 3 * connectivity.len()];
    for (corner, axis) in (0..corners).flat_map(|corner| (0..3).map(move |axis| (corner, axis))) {
        let place = |row: usize| 3 * (row * corners + corner) + axis;
        (0..count).for_each(|row| u[place(row)] = change);
        block.forces(cpu, &u, &mut forces);
        (0..count).for_each(|row| u[place(row)] = 0.0);
        for row in 0..count {
            let node = connectivity[lane_place(row, corners, corner)] as usize;
            let force = [0, 1, 2].map(|i| forces[lane_place(row, 3 * corners, 3 * corner + i)] / change);
            *blocks[node].col_mut(axis) += DVec3::from_array(force);
        }
    }
}
