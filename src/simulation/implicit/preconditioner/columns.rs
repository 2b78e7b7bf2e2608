//! Columns of the stiffness of elements at rest, which preconditioners are made of: a corner and an axis of all
//! elements of a block at a time.

use super::super::super::block_forces::BlockForces;
use super::super::super::tangent::{at_an_instant, heights_at_nodes};
use super::Operator;
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::elements::node_count;
use crate::math::lane_place;
use crate::mesh::lowest;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// How far a corner is displaced to see what it meets, as a share of the height of the flattest element there:
/// curvature of the law and rounding are then some 1e-6 of the slope.
const CHANGE: f64 = 1e-7;

/// A column of the stiffness of each element of a block.
pub(super) struct Columns<'a> {
    /// The corner that is displaced, and along which axis.
    pub corner: usize,
    pub axis: usize,
    /// How many corners an element has.
    pub corners: usize,
    /// Where the nodes of the body begin among those of all.
    first: usize,
    connectivity: &'a [u32],
    /// Forces (N) as displaced and at rest, and for each element 1 over how far (1/m); 0 of those that are removed.
    forces: [&'a [f64]; 2],
    per_change: &'a [f64],
}

impl Columns<'_> {
    /// The elements that are left.
    pub fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.per_change.len()).filter(|&row| self.per_change[row] > 0.0)
    }

    /// The node of a corner, among those of all bodies.
    pub fn node(&self, row: usize, corner: usize) -> usize {
        self.first + self.connectivity[lane_place(row, self.corners, corner)] as usize
    }

    /// What the displacement of a metre would make of force at a corner (N/m).
    pub fn force(&self, row: usize, corner: usize) -> DVec3 {
        let [displaced, at_rest] = self.forces;
        let number = |i: usize| lane_place(row, 3 * self.corners, 3 * corner + i);
        let change = |i: usize| displaced[number(i)] - at_rest[number(i)];
        DVec3::new(change(0), change(1), change(2)) * self.per_change[row]
    }
}

/// Gives all columns of all elements of all bodies: of each corner of a block one axis after the other.
pub(super) fn each_column(operator: &Operator<'_>, mut take: impl FnMut(&Columns<'_>)) {
    let (world, mut first) = (operator.world, 0);
    for &body in operator.bodies {
        let heights = heights_at_nodes(world, body).unwrap_or_default();
        for &entity in world.get::<Authoring>(body).into_iter().flat_map(|authoring| &authoring.blocks) {
            let (Some(apart), Some(connectivity)) =
                (BlockForces::of(world, entity, at_an_instant), world.get::<Connectivity>(entity))
            else {
                continue;
            };
            let alive = world.get::<Alive>(entity);
            let is_left = |row: usize| alive.is_none_or(|alive| alive[row] != 0);
            let of_block = (first, &connectivity[..], &heights[..]);
            columns_of(world.resource::<Cpu>(), apart.apart(), of_block, is_left, &mut take);
        }
        first += world.get::<Mass>(body).map_or(0, |mass| mass.len());
    }
}

fn columns_of(
    cpu: &Cpu,
    mut block: BlockForces<'_>,
    (first, connectivity, heights): (usize, &[u32], &[f64]),
    is_left: impl Fn(usize) -> bool,
    take: &mut impl FnMut(&Columns<'_>),
) {
    let (corners, count) = (node_count(block.block.kind), block.block.count);
    let node = |row: usize, corner: usize| connectivity[lane_place(row, corners, corner)] as usize;
    let change = |row: usize| {
        let height = (0..corners).map(|corner| heights[node(row, corner)]).fold(f64::INFINITY, f64::min);
        if is_left(row) && height.is_finite() { CHANGE * height } else { 0.0 }
    };
    let changes: Vec<f64> = (0..count).map(change).collect();
    let per_change: Vec<f64> = changes.iter().map(|&by| if by > 0.0 { 1.0 / by } else { 0.0 }).collect();
    let mut u = vec![0.0; 3 * connectivity.len()];
    let [mut displaced, mut at_rest] = [vec![0.0; u.len()], vec![0.0; u.len()]];
    block.forces(cpu, &u, &mut at_rest);
    for (corner, axis) in (0..corners).flat_map(|corner| (0..3).map(move |axis| (corner, axis))) {
        let place = |row: usize| 3 * (row * corners + corner) + axis;
        (0..count).for_each(|row| u[place(row)] = changes[row]);
        block.forces(cpu, &u, &mut displaced);
        (0..count).for_each(|row| u[place(row)] = 0.0);
        let forces = [&displaced[..], &at_rest[..]];
        take(&Columns { corner, axis, corners, first, connectivity, forces, per_change: &per_change });
    }
}

/// Nodes that elements left in the body connect, each piece in the order of its nodes; nodes without elements are in
/// none.
pub(in crate::simulation::implicit) fn pieces(world: &World, body: Entity) -> Vec<Vec<usize>> {
    let nodes = world.get::<Mass>(body).map_or(0, |mass| mass.len());
    let mut lower: Vec<u32> = (0..nodes as u32).collect();
    let mut has_elements = vec![false; nodes];
    for &entity in world.get::<Authoring>(body).into_iter().flat_map(|authoring| &authoring.blocks) {
        let (Some(block), Some(connectivity)) = (world.get::<Block>(entity), world.get::<Connectivity>(entity)) else {
            continue;
        };
        let (corners, alive) = (node_count(block.kind), world.get::<Alive>(entity));
        for row in (0..block.count).filter(|&row| alive.is_none_or(|alive| alive[row] != 0)) {
            let node = |corner: usize| connectivity[lane_place(row, corners, corner)];
            for corner in 0..corners {
                has_elements[node(corner) as usize] = true;
                let (a, b) = (lowest(&mut lower, node(0)), lowest(&mut lower, node(corner)));
                lower[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut place = vec![usize::MAX; nodes];
    let mut pieces: Vec<Vec<usize>> = Vec::new();
    for node in (0..nodes).filter(|&node| has_elements[node]) {
        let first = lowest(&mut lower, node as u32) as usize;
        if first == node {
            place[node] = pieces.len();
            pieces.push(Vec::new());
        }
        pieces[place[first]].push(node);
    }
    pieces
}

/// How many elements have not been removed.
pub(super) fn elements_left(operator: &Operator<'_>) -> usize {
    let blocks = operator.bodies.iter().filter_map(|&body| operator.world.get::<Authoring>(body));
    let left = |&entity: &Entity| {
        let count = operator.world.get::<Block>(entity).map_or(0, |block| block.count);
        let alive = operator.world.get::<Alive>(entity);
        alive.map_or(count, |alive| alive[..count].iter().filter(|&&alive| alive != 0).count())
    };
    blocks.flat_map(|authoring| &authoring.blocks).map(left).sum()
}
