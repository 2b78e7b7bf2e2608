//! The coarse level of a piece of a body: rigid motions of aggregates of its nodes, and what resists them.

use super::super::Operator;
use super::aggregates::{Aggregates, RIGID, motions};
use super::cholesky::Cholesky;
use super::rotation::{angle, rotation};
use crate::backend::cpu::Cpu;
use crate::components::{Precision, Reals};
use glam::{DMat3, DVec3};

/// Nodes of an aggregate at most, as long as a piece has no more aggregates than that: the matrix is dense.
const NODES_AN_AGGREGATE: usize = 30;
const MOST_AGGREGATES: usize = 128;
/// What has turned less (rad) is not turned back.
const HARDLY_TURNED: f64 = 0.035;

/// The coarse level of a piece.
pub(in crate::simulation::implicit) struct Coarse {
    /// Its nodes that move along some axis, among those of all bodies, one aggregate after the other.
    pub nodes: Vec<u32>,
    pub aggregates: Aggregates,
    /// The arms of its nodes at rest (see [`Aggregates::arm`]).
    arms: Reals,
    /// Pᵀ K P: columns from the diagonal down, one after the other.
    pub stiffness: Vec<f64>,
    factor: Cholesky,
    /// How each aggregate has turned.
    rotations: Vec<DMat3>,
    /// Along which axes nothing holds the piece, and 1/ΣD of it there (m/N); else 0.
    all_free: [bool; 3],
    pub per_inertia: DVec3,
}

/// The place of an entry in rows up to the diagonal.
fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Where a column of so many unknowns begins, of columns from the diagonal down.
pub(super) fn start(column: usize, size: usize) -> usize {
    column * size - column * column.saturating_sub(1) / 2
}

impl Coarse {
    /// Of the nodes of a piece, with their rest positions (m); without its stiffness.
    pub fn of(piece: &[(usize, DVec3)], operator: &Operator<'_>, precision: Precision) -> Self {
        let moves = |node: usize| operator.free[3 * node..3 * node + 3].contains(&true);
        let (nodes, rest): (Vec<usize>, Vec<DVec3>) = piece.iter().filter(|(node, _)| moves(*node)).copied().unzip();
        let most = NODES_AN_AGGREGATE.max(nodes.len().div_ceil(MOST_AGGREGATES));
        let mut aggregates = Aggregates::within(&rest, most);
        let order = aggregates.sort();
        let nodes = order.iter().map(|&own| nodes[own] as u32).collect();
        let arms = std::mem::take(&mut aggregates.arm).into_iter().flat_map(|arm| arm.to_array());
        let arms = Reals::from_f64(precision, arms);
        let all_free = [0, 1, 2].map(|axis| piece.iter().all(|(node, _)| operator.free[3 * node + axis]));
        let size = RIGID * aggregates.count();
        let mut new = Self {
            stiffness: vec![0.0; size * (size + 1) / 2],
            factor: Cholesky::default(),
            rotations: vec![DMat3::IDENTITY; aggregates.count()],
            all_free,
            per_inertia: DVec3::ZERO,
            nodes,
            aggregates,
            arms,
        };
        new.find_inertia(operator);
        new
    }

    /// How much inertia there is along axes that nothing holds.
    fn find_inertia(&mut self, operator: &Operator<'_>) {
        let sum: f64 = self.nodes.iter().map(|&node| operator.inertia.of(node as usize)).sum();
        let per_inertia = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        self.per_inertia = DVec3::from_array(self.all_free.map(|all_free| if all_free { per_inertia } else { 0.0 }));
    }

    /// Makes the factor of Pᵀ (D + c K) P.
    pub fn factorize(&mut self, operator: &Operator<'_>) {
        self.find_inertia(operator);
        let size = self.size();
        let entries = (0..size).flat_map(|row| (0..=row).map(move |column| start(column, size) + row - column));
        let mut matrix: Vec<f64> = entries.map(|entry| self.stiffness[entry] * operator.stiffness).collect();
        for (node, aggregate, arm) in self.members() {
            let first = RIGID * aggregate;
            for axis in (0..3).filter(|axis| operator.free[3 * node + axis]) {
                let motion = motions(arm, axis);
                let inertia = operator.inertia.of(node);
                for (i, j) in (0..RIGID).flat_map(|i| (0..=i).map(move |j| (i, j))) {
                    matrix[place(first + i, first + j)] += inertia * motion[i] * motion[j];
                }
            }
        }
        self.factor = Cholesky::of(operator.world.resource::<Cpu>(), matrix, size);
    }

    /// How far a part of a node's motion along an axis goes with each motion of its aggregate, as that has turned: its
    /// first unknown among those of the piece, and the ways.
    pub fn ways(&self, own: usize, axis: usize, part: f64) -> (usize, [f64; RIGID]) {
        let aggregate = self.aggregates.of(own);
        let back = self.rotations[aggregate].transpose().col(axis) * part;
        let turn = self.arms.vector(own).cross(back);
        (RIGID * aggregate, [back.x, back.y, back.z, turn.x, turn.y, turn.z])
    }

    /// A column of the inverse of the matrix (m/N).
    pub fn column(&self, unknown: usize) -> Vec<f64> {
        self.factor.column(unknown)
    }

    /// Turns aggregates as their nodes have turned, which were at rest and have been displaced so far (m). Whether any
    /// has.
    pub fn turn(&mut self, moved: impl Fn(usize) -> (DVec3, DVec3)) -> bool {
        let mut any = false;
        for (range, turned) in self.aggregates.ranges.iter().zip(&mut self.rotations) {
            let nodes = || self.nodes[range.clone()].iter().map(|&node| moved(node as usize));
            let (mut middles, share) = ([DVec3::ZERO; 2], 1.0 / range.len() as f64);
            for (rest, displacement) in nodes() {
                middles[0] += share * rest;
                middles[1] += share * (rest + displacement);
            }
            let mut shape = DMat3::ZERO;
            for (rest, displacement) in nodes() {
                let (x, rest) = (rest + displacement - middles[1], rest - middles[0]);
                shape += DMat3::from_cols(x * rest.x, x * rest.y, x * rest.z);
            }
            let found = rotation(shape).filter(|rotation| angle(rotation) > HARDLY_TURNED);
            any |= found.is_some();
            *turned = found.unwrap_or(DMat3::IDENTITY);
        }
        any
    }

    /// Its nodes, among those of all bodies, each with its aggregate and its arm at rest.
    pub fn members(&self) -> impl Iterator<Item = (usize, usize, DVec3)> + '_ {
        self.aggregates.ranges.iter().enumerate().flat_map(move |(aggregate, range)| {
            range.clone().map(move |own| (self.nodes[own] as usize, aggregate, self.arms.vector(own)))
        })
    }

    /// P: of each unknown how all axes of all bodies go with it.
    pub fn motions(&self, free: &[bool]) -> Vec<Vec<f64>> {
        let mut all = vec![vec![0.0; free.len()]; self.size()];
        for (node, aggregate, arm) in self.members() {
            for axis in (0..3).filter(|axis| free[3 * node + axis]) {
                let ways = motions(arm, axis);
                (0..RIGID).for_each(|i| all[RIGID * aggregate + i][3 * node + axis] = ways[i]);
            }
        }
        all
    }

    /// How each aggregate has turned.
    pub fn rotations(&self) -> &[DMat3] {
        &self.rotations
    }

    /// The inverse of the matrix, row by row (m/N).
    pub fn inverse(&self) -> Vec<f64> {
        (0..self.size()).flat_map(|unknown| self.factor.column(unknown)).collect()
    }

    /// How many unknowns it has.
    pub fn size(&self) -> usize {
        RIGID * self.aggregates.count()
    }

    /// Bytes of the matrix and its factor.
    pub fn bytes_of_matrix(&self) -> usize {
        size_of_val(&self.stiffness[..]) + self.factor.bytes()
    }

    /// Bytes of what belongs to its nodes and aggregates.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + self.arms.bytes().len()
            + size_of_val(&self.rotations[..])
            + self.aggregates.bytes()
    }

    /// The nodes with how they have turned.
    pub fn turned_nodes(&self) -> impl Iterator<Item = (usize, DMat3)> + '_ {
        self.members().map(|(node, aggregate, _)| (node, self.rotations[aggregate]))
    }

    /// A⁻¹ Pᵀ r, of a residual r (N).
    pub fn solve(&mut self, cpu: &Cpu, residual: &Reals, motions: &mut [f64]) {
        let of_aggregates = self.rotations.iter().zip(&self.aggregates.ranges);
        for (sums, (rotation, range)) in motions.chunks_exact_mut(RIGID).zip(of_aggregates) {
            let (mut force, mut turn) = (DVec3::ZERO, DVec3::ZERO);
            let is_turned = *rotation != DMat3::IDENTITY;
            for own in range.clone() {
                let r = residual.vector(self.nodes[own] as usize);
                let arm = self.arms.vector(own);
                force += r;
                turn += if is_turned { *rotation * arm } else { arm }.cross(r);
            }
            sums[..3].copy_from_slice(&(rotation.transpose() * force).to_array());
            sums[3..].copy_from_slice(&(rotation.transpose() * turn).to_array());
        }
        self.factor.solve(cpu, motions);
    }

    /// Moves nodes on free axes of z with the motions of their aggregates.
    pub fn carry(&self, motions: &[f64], free: &[bool], z: &mut Reals) {
        let of_aggregates = self.rotations.iter().zip(&self.aggregates.ranges);
        for (motion, (rotation, range)) in motions.chunks_exact(RIGID).zip(of_aggregates) {
            let (moved, turned) = (*rotation * DVec3::from_slice(motion), *rotation * DVec3::from_slice(&motion[3..]));
            let is_turned = *rotation != DMat3::IDENTITY;
            for own in range.clone() {
                let (node, arm) = (self.nodes[own] as usize, self.arms.vector(own));
                let step = (moved + turned.cross(if is_turned { *rotation * arm } else { arm })).to_array();
                let step: [f64; 3] = std::array::from_fn(|i| if free[3 * node + i] { step[i] } else { 0.0 });
                z.set_vector(node, z.vector(node) + DVec3::from(step));
            }
        }
    }
}
