//! Two levels: the 3×3 blocks of nodes, and rigid motions of aggregates of neighbours, which take the slow modes out.
//! Both are of bodies at rest, and turned as the aggregates have turned since.

mod aggregates;
mod cholesky;
mod coarse;
mod rotation;
mod touched;

use super::block_jacobi::{BlockJacobi, Changed, apply_blocks};
use super::columns::{each_column, pieces};
use super::{Operator, Preconditioner};
use crate::components::*;
use crate::elements::MOST_NODES;
pub(in super::super) use aggregates::RIGID;
use bevy_ecs::prelude::*;
pub(in super::super) use coarse::Coarse;
use glam::{DMat3, DVec3};

/// B r = Q (D⁻¹ + P A⁻¹ Pᵀ) Qᵀ r, D the diagonal blocks, P the rigid motions of aggregates of some 30 nodes, A = Pᵀ
/// (D + c K) P their dense matrix, a piece of a body each, Q the rotations of the aggregates. Springs that touch are in
/// D, and in A those that act on one piece alone.
///
/// Of a piece that nothing holds along an axis, what it does as a whole is solved apart from that: B t = t tᵀ r / tᵀ D
/// t along its translation t, and the rest of B without a mean motion. So it keeps its linear momentum however early a
/// solve ends, as [`Mass`](super::Mass) does.
#[derive(Default)]
pub(in crate::simulation) struct TwoLevel {
    fine: BlockJacobi,
    pieces: Vec<Piece>,
    /// The inverses of the blocks, turned.
    inverses: Vec<DMat3>,
    turned: bool,
    /// How often matrices have been made.
    made: u64,
    /// The residual without what moves pieces as a whole (N).
    residual: Vec<f64>,
}

struct Piece {
    /// All its nodes, among those of all bodies, and where they are at rest (m).
    nodes: Vec<(usize, DVec3)>,
    coarse: Coarse,
}

impl Preconditioner for TwoLevel {
    fn apply(&mut self, residual: &[f64], z: &mut [f64]) {
        self.residual.copy_from_slice(residual);
        let inertia = &self.fine.inertia;
        let wholes: Vec<DVec3> = self.pieces.iter().map(|piece| piece.whole(inertia, &mut self.residual)).collect();
        apply_blocks(&self.inverses, &self.residual, z);
        for (piece, whole) in self.pieces.iter_mut().zip(wholes) {
            piece.coarse.correct(&self.fine.free, &self.residual, z);
            piece.move_as_a_whole(inertia, whole, z);
        }
    }

    fn follow(&mut self, operator: &Operator<'_>) {
        let touches = self.fine.is_touched() || !operator.springs.is_empty();
        let changed = self.fine.update(operator);
        if changed == Changed::Bodies {
            self.pieces = find_pieces(operator);
        }
        if changed != Changed::Nothing {
            self.made += 1;
            self.pieces.iter_mut().for_each(|piece| piece.coarse.factorize(&piece.nodes, operator));
        }
        self.turn(operator, changed != Changed::Nothing || touches);
        if touches {
            self.pieces.iter_mut().for_each(|piece| piece.coarse.touch(operator));
        }
        self.residual.resize(operator.free.len(), 0.0);
    }

    fn block(&self, node: usize) -> DMat3 {
        self.inverses[node]
    }

    fn coarse(&self) -> Vec<&Coarse> {
        self.pieces.iter().map(|piece| &piece.coarse).collect()
    }

    fn made(&self) -> u64 {
        self.made
    }

    fn settle(&self, right: &[f64], x: &mut [f64]) {
        self.pieces.iter().for_each(|piece| piece.settle(&self.fine.inertia, right, x));
    }

    fn holds(&self) -> (String, Vec<(&'static str, u64)>) {
        let (blocks, mut held) = self.fine.holds();
        let turned = size_of_val(&self.inverses[..]) + size_of_val(&self.residual[..]);
        let of_pieces = self.pieces.iter().map(|piece| piece.coarse.bytes() + size_of_val(&piece.nodes[..]));
        let aggregates: usize = self.pieces.iter().map(|piece| piece.coarse.size() / RIGID).sum();
        let matrices: usize = self.pieces.iter().map(|piece| piece.coarse.bytes_of_matrix()).sum();
        held.push(("blocks that have turned", turned as u64));
        held.push(("aggregates", of_pieces.sum::<usize>() as u64));
        held.push(("coarse matrices with their factors", matrices as u64));
        let coarse = format!("{aggregates} aggregates of nodes with {RIGID} rigid motions each");
        (format!("{blocks}, and {coarse}"), held)
    }
}

impl TwoLevel {
    fn turn(&mut self, operator: &Operator<'_>, again: bool) {
        let places: Vec<f64> = operator.bodies.iter().flat_map(|&body| place_of(operator, body)).collect();
        let displacement = |node: usize| DVec3::from_slice(&places[3 * node..]);
        let mut turned = false;
        for piece in &mut self.pieces {
            turned |= piece.coarse.turn(displacement);
        }
        if turned || self.turned || again {
            self.inverses.clear();
            self.inverses.extend((0..operator.free.len() / 3).map(|node| self.fine.at_rest(node)));
        }
        if turned {
            for (node, rotation) in self.pieces.iter().flat_map(|piece| piece.coarse.turned_nodes()) {
                if rotation != DMat3::IDENTITY {
                    self.inverses[node] = self.fine.turned(node, rotation);
                }
            }
        }
        self.turned = turned;
    }
}

/// Where the nodes of a body have gone (m).
fn place_of(operator: &Operator<'_>, body: Entity) -> Vec<f64> {
    let Some(displacement) = operator.world.get::<Displacement>(body) else { return Vec::new() };
    let mut places = vec![0.0; displacement.len()];
    displacement.read(&mut places);
    places
}

impl Piece {
    /// Takes out of a residual what moves the piece as a whole, r − D t (tᵀ r/tᵀ D t); gives that motion (m).
    fn whole(&self, inertia: &[f64], residual: &mut [f64]) -> DVec3 {
        let per_inertia = self.coarse.per_inertia;
        if per_inertia == DVec3::ZERO {
            return DVec3::ZERO;
        }
        let force: DVec3 = self.nodes.iter().map(|(node, _)| DVec3::from_slice(&residual[3 * node..])).sum();
        let motion = force * per_inertia;
        for (node, _) in &self.nodes {
            (0..3).for_each(|i| residual[3 * node + i] -= inertia[3 * node + i] * motion[i]);
        }
        motion
    }

    /// Adds a motion of the whole to x (m) such that tᵀ (b − D x) = 0 along each axis that nothing holds: elements do
    /// not resist it, so that D alone is there of the operator.
    fn settle(&self, inertia: &[f64], right: &[f64], x: &mut [f64]) {
        let per_inertia = self.coarse.per_inertia;
        if per_inertia == DVec3::ZERO {
            return;
        }
        let left = |axis: usize| right[axis] - inertia[axis] * x[axis];
        let sum = |i: usize| -> f64 { self.nodes.iter().map(|(node, _)| left(3 * node + i)).sum() };
        let motion = DVec3::new(sum(0), sum(1), sum(2)) * per_inertia;
        for (node, _) in &self.nodes {
            (0..3).for_each(|i| x[3 * node + i] += motion[i]);
        }
    }

    /// Puts a motion (m) in the place of the mean one in z.
    fn move_as_a_whole(&self, inertia: &[f64], motion: DVec3, z: &mut [f64]) {
        let per_inertia = self.coarse.per_inertia;
        if per_inertia == DVec3::ZERO {
            return;
        }
        let weighted = |node: usize| DVec3::from_slice(&inertia[3 * node..]) * DVec3::from_slice(&z[3 * node..]);
        let mean = self.nodes.iter().map(|(node, _)| weighted(*node)).sum::<DVec3>() * per_inertia;
        for (node, _) in &self.nodes {
            (0..3).for_each(|i| z[3 * node + i] += motion[i] - mean[i]);
        }
    }
}

/// The pieces of all bodies, with the stiffness of their coarse levels.
fn find_pieces(operator: &Operator<'_>) -> Vec<Piece> {
    let (mut all, mut first) = (Vec::new(), 0);
    for &body in operator.bodies {
        let Some(rest) = operator.world.get::<RestPosition>(body) else { continue };
        // of each node of the body its piece, and its place among those of it that move
        let mut places = vec![(usize::MAX, None); rest.0.len()];
        for nodes in pieces(operator.world, body) {
            let nodes: Vec<(usize, DVec3)> = nodes.into_iter().map(|node| (first + node, rest.0[node])).collect();
            let coarse = Coarse::of(&nodes, operator);
            nodes.iter().for_each(|(node, _)| places[node - first].0 = all.len());
            coarse.nodes.iter().enumerate().for_each(|(place, node)| places[node - first].1 = Some(place));
            all.push(Piece { nodes, coarse });
        }
        each_column(operator.world, body, |column| {
            if !operator.free[3 * (first + column.nodes[column.corner]) + column.axis] {
                return;
            }
            let Some(piece) = all.get_mut(places[column.nodes[0]].0) else { return };
            let mut of_corners = [None; MOST_NODES];
            of_corners.iter_mut().zip(column.nodes).for_each(|(place, &node)| *place = places[node].1);
            let of_corners = &of_corners[..column.nodes.len()];
            piece.coarse.add(&column, of_corners, operator.free);
        });
        first += rest.0.len();
    }
    all
}

#[cfg(test)]
mod tests;
