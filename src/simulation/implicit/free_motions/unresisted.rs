//! Rigid motions at rest that nothing resists where bodies are. The stiffness has no answer to what rounding leaves of
//! forces along them, so that solves would move bodies as far as they like: the part of an iteration along them is
//! taken out.

use super::super::springs::Springs;
use super::{FreeMotion, null_space};
use crate::components::Reals;
use glam::DVec3;

/// A share of all forces that is more than rounding, where it is along a motion.
const PUSHES: f64 = 1e-5;

/// Pieces of bodies with the motions of each that no constraint holds.
#[derive(Default)]
pub(in crate::simulation::implicit) struct Unresisted {
    pieces: Vec<Piece>,
    /// Of each node its piece, and where it was from that one's middle (m).
    of_nodes: Vec<Option<(usize, DVec3)>>,
}

struct Piece {
    /// Rotations (rad/m) and translations.
    motions: Vec<[DVec3; 2]>,
    /// Nodes among those of all bodies, and where they were from the middle (m).
    nodes: Vec<(usize, DVec3)>,
}

/// What springs do to the motions of a piece.
#[derive(Clone, Copy, Default)]
struct Held {
    /// cᵀ K c of combinations c of the motions.
    stiffness: [[f64; 6]; 6],
    /// The work of forces along each of them, and the most that it could be.
    work: [f64; 6],
    most: f64,
}

/// A motion of nodes whose squares add up to 1.
pub(in crate::simulation::implicit) struct Field(Vec<(usize, DVec3)>);

impl Unresisted {
    /// Of free motions, those of a piece one after the other. Of what is glued or tied none is known.
    pub fn of(motions: &[FreeMotion]) -> Self {
        let mut all = Self::default();
        let first = |motion: &FreeMotion| motion.nodes.first().map(|(node, _)| *node);
        for of_piece in motions.chunk_by(|one, other| first(one) == first(other)) {
            let Some(FreeMotion { nodes, is_tied: false, .. }) = of_piece.first() else { continue };
            for &(node, arm) in nodes {
                let length = all.of_nodes.len().max(node + 1);
                all.of_nodes.resize(length, None);
                all.of_nodes[node] = Some((all.pieces.len(), arm));
            }
            let motions = of_piece.iter().map(|motion| [motion.rotation, motion.translation]).collect();
            all.pieces.push(Piece { motions, nodes: nodes.clone() });
        }
        all
    }

    /// Those that the springs which touch do not resist either, where nodes have moved by so much since (m): across
    /// each other, and only where neither they nor other forces, F − R there (N), do work along them.
    pub fn fields(&self, moved: &Reals, net: &Reals, springs: &Springs) -> Vec<Field> {
        let mut all: Vec<Field> = Vec::new();
        for (piece, held) in self.pieces.iter().zip(self.held_by(springs, moved)) {
            let first = all.len();
            for motion in piece.left_by(&held) {
                let way = |&(node, arm): &(usize, DVec3)| (node, along(motion, arm + moved.vector(node)));
                let mut field = Field(piece.nodes.iter().map(way).collect());
                if field.is_worked_along(net) {
                    continue;
                }
                for other in &all[first..] {
                    let part = field.ways().zip(other.ways()).map(|(way, other)| way.dot(other)).sum::<f64>();
                    field.0.iter_mut().zip(other.ways()).for_each(|((_, way), other)| *way -= part * other);
                }
                let length = field.ways().map(DVec3::length_squared).sum::<f64>().sqrt();
                if length > 0.0 {
                    field.0.iter_mut().for_each(|(_, way)| *way /= length);
                    all.push(field);
                }
            }
        }
        all
    }

    fn held_by(&self, springs: &Springs, moved: &Reals) -> Vec<Held> {
        let mut all = vec![Held::default(); self.pieces.len()];
        if self.pieces.is_empty() {
            return all;
        }
        for spring in springs.touching() {
            let slope = spring.slopes[0] + spring.slopes[1];
            let end = |&(first, weight): &(usize, f64)| {
                let node = first / 3;
                let (piece, arm) = self.of_nodes.get(node).copied().flatten()?;
                Some((piece, arm + moved.vector(node), weight))
            };
            let mut ends: Vec<(usize, DVec3, f64)> = spring.parts.iter().filter_map(end).collect();
            ends.sort_by_key(|(piece, ..)| *piece);
            for of_piece in ends.chunk_by(|one, other| one.0 == other.0) {
                let number = of_piece[0].0;
                let motions = &self.pieces[number].motions;
                let way = |motion: &[DVec3; 2]| {
                    of_piece.iter().map(|&(_, arm, weight)| along(*motion, arm) * weight).sum::<DVec3>()
                };
                let ways: Vec<DVec3> = motions.iter().map(way).collect();
                let held = &mut all[number];
                held.most += spring.force.length();
                for (i, one) in ways.iter().enumerate() {
                    held.work[i] += one.dot(spring.force);
                    let row = &mut held.stiffness[i];
                    ways.iter().zip(row).for_each(|(other, entry)| *entry += one.dot(slope * *other));
                }
            }
        }
        all
    }
}

impl Piece {
    /// The combinations of its motions that springs neither resist nor push along.
    fn left_by(&self, held: &Held) -> Vec<[DVec3; 2]> {
        let (count, mut stiffness) = (self.motions.len(), held.stiffness);
        let largest = (0..count).map(|i| stiffness[i][i]).fold(0.0, f64::max);
        // motions that it does not have are held
        (count..6).for_each(|i| stiffness[i][i] = if largest > 0.0 { largest } else { 1.0 });
        let work = |parts: &[f64; 6]| parts.iter().zip(held.work).map(|(part, work)| part * work).sum::<f64>();
        let left = null_space(stiffness).into_iter().filter(|parts| work(parts).abs() <= PUSHES * held.most);
        let motion = |parts: [f64; 6]| {
            let sum =
                |which: usize| self.motions.iter().zip(parts).map(|(motion, part)| motion[which] * part).sum::<DVec3>();
            [sum(0), sum(1)]
        };
        left.map(motion).collect()
    }
}

impl Field {
    fn ways(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.0.iter().map(|(_, way)| *way)
    }

    /// Whether forces on all axes (N) do work along it.
    fn is_worked_along(&self, forces: &Reals) -> bool {
        let (mut sum, mut size) = (0.0, 0.0);
        for &(node, way) in &self.0 {
            let parts = way * forces.vector(node);
            sum += parts.element_sum();
            size += parts.abs().element_sum();
        }
        sum.abs() > PUSHES * size
    }

    /// Takes the part along it out of a vector over all axes.
    pub fn take_out(&self, of: &mut Reals) {
        let part = self.0.iter().map(|&(node, way)| way.dot(of.vector(node))).sum::<f64>();
        for &(node, way) in &self.0 {
            of.set_vector(node, of.vector(node) - part * way);
        }
    }
}

/// How a rotation and a translation move a node that is so far from the middle (m).
fn along([rotation, translation]: [DVec3; 2], arm: DVec3) -> DVec3 {
    translation + rotation.cross(arm)
}
