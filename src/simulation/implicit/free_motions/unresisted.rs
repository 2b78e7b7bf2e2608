//! Rigid motions at rest that nothing resists where bodies are. The stiffness has no answer to what rounding leaves of
//! forces along them, so that solves would move bodies as far as they like: the part of an iteration along them is
//! taken out.

use super::super::springs::Springs;
use super::{DEPENDENT, FreeMotion, null_space, reach, without_constraint};
use crate::components::Reals;
use glam::DVec3;

/// A share of all forces that is more than rounding, where it is along a motion: in f32 rounding leaves some 1e-6 of
/// them, and what is left of 1e-5 is rest there.
const PUSHES: f64 = 1e-5;

/// Pieces of bodies that some motion is left to which no constraint holds.
#[derive(Default)]
pub(in crate::simulation::implicit) struct Unresisted {
    /// Of each its nodes among those of all bodies, and where they were (m).
    pieces: Vec<Vec<(usize, DVec3)>>,
    /// Of each node its piece, and its place in that.
    of_nodes: Vec<Option<(usize, usize)>>,
}

/// A piece where it is now: held axes may have gone elsewhere, and with them its hinge.
struct Piece {
    /// Nodes, and where they are from the middle (m).
    nodes: Vec<(usize, DVec3)>,
    /// Rotations (rad/m) and translations that move no held axis from there.
    motions: Vec<[DVec3; 2]>,
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

/// A motion of nodes, and how much of it is in where they go.
pub(in crate::simulation::implicit) struct Field(Vec<Part>);

/// Of a node.
struct Part {
    node: usize,
    /// The way of its free axes in the motion.
    way: DVec3,
    /// How much each of its axes tells of the motion, held ones too; times those ways, of all nodes, it adds up to 1,
    /// times those in another field of the same bodies to 0.
    weight: DVec3,
}

impl Unresisted {
    /// Of free motions, those of a piece one after the other. Of what is glued or tied none is known.
    pub fn of(motions: &[FreeMotion]) -> Self {
        let mut all = Self::default();
        let first = |motion: &FreeMotion| motion.nodes.first().map(|(node, _)| *node);
        for of_piece in motions.chunk_by(|one, other| first(one) == first(other)) {
            let Some(FreeMotion { nodes, is_tied: false, .. }) = of_piece.first() else { continue };
            for (place, &(node, _)) in nodes.iter().enumerate() {
                let length = all.of_nodes.len().max(node + 1);
                all.of_nodes.resize(length, None);
                all.of_nodes[node] = Some((all.pieces.len(), place));
            }
            all.pieces.push(nodes.clone());
        }
        all
    }

    /// Those that the springs which touch do not resist either, where nodes have moved by so much since (m), and only
    /// where neither they nor other forces, F − R there (N), do work along them.
    pub fn fields(&self, moved: &Reals, (net, free): (&Reals, &[bool]), springs: &Springs) -> Vec<Field> {
        let pieces: Vec<Piece> = self.pieces.iter().map(|nodes| Piece::at(nodes, moved, free)).collect();
        let held = self.held_by(&pieces, springs);
        pieces.iter().zip(held).flat_map(|(piece, held)| piece.fields(&piece.left_by(&held), net, free)).collect()
    }

    fn held_by(&self, pieces: &[Piece], springs: &Springs) -> Vec<Held> {
        let mut all = vec![Held::default(); pieces.len()];
        if pieces.is_empty() {
            return all;
        }
        for spring in springs.touching() {
            let slope = spring.slopes[0] + spring.slopes[1];
            let end = |&(first, weight): &(usize, f64)| {
                let (piece, place) = self.of_nodes.get(first / 3).copied().flatten()?;
                Some((piece, pieces[piece].nodes[place].1, weight))
            };
            let mut ends: Vec<(usize, DVec3, f64)> = spring.parts.iter().filter_map(end).collect();
            ends.sort_by_key(|(piece, ..)| *piece);
            for of_piece in ends.chunk_by(|one, other| one.0 == other.0) {
                let number = of_piece[0].0;
                let way = |motion: &[DVec3; 2]| {
                    of_piece.iter().map(|&(_, arm, weight)| along(*motion, arm) * weight).sum::<DVec3>()
                };
                let ways: Vec<DVec3> = pieces[number].motions.iter().map(way).collect();
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
    /// Where its nodes have moved from where they were.
    fn at(nodes: &[(usize, DVec3)], moved: &Reals, free: &[bool]) -> Self {
        let place = |&(node, was): &(usize, DVec3)| was + moved.vector(node);
        let middle = nodes.iter().map(place).sum::<DVec3>() / nodes.len() as f64;
        let nodes: Vec<(usize, DVec3)> = nodes.iter().map(|one| (one.0, place(one) - middle)).collect();
        let motions = without_constraint(&nodes, reach(&nodes), free);
        Self { nodes, motions }
    }

    /// The combinations of its motions that springs neither resist nor push along.
    fn left_by(&self, held: &Held) -> Vec<[DVec3; 2]> {
        let work = |parts: &[f64; 6]| parts.iter().zip(held.work).map(|(part, work)| part * work).sum::<f64>();
        let left = combinations(self.motions.len(), held.stiffness).into_iter();
        let left = left.filter(|parts| work(parts).abs() <= PUSHES * held.most);
        left.map(|parts| combined(&self.motions, parts)).collect()
    }

    /// Fields of motions that no force does work along. Of a translation each node tells as much as any other. Of a
    /// rotation nodes tell what turns about the middle, wherever its hinge is: what goes with the hinge is no rotation.
    fn fields(&self, motions: &[[DVec3; 2]], net: &Reals, free: &[bool]) -> Vec<Field> {
        let motions: Vec<[DVec3; 2]> =
            motions.iter().copied().filter(|motion| !self.is_worked_along(*motion, net, free)).collect();
        // those of their combinations that turn nothing
        let mut turns = [[0.0; 6]; 6];
        for (i, [one, _]) in motions.iter().enumerate() {
            motions.iter().enumerate().for_each(|(j, [other, _])| turns[i][j] = one.dot(*other));
        }
        let translations = combinations(motions.len(), turns).into_iter().map(|parts| combined(&motions, parts));
        let translations = translations.map(|motion| (motion, [DVec3::ZERO, motion[1]]));
        let rotations = motions.iter().map(|&motion| (motion, [motion[0], DVec3::ZERO]));
        let mut all: Vec<Field> = Vec::new();
        for (motion, told_by) in translations.chain(rotations) {
            let part = |&(node, arm): &(usize, DVec3)| {
                let way = on_free_axes(along(motion, arm), node, free);
                Part { node, way, weight: along(told_by, arm) }
            };
            let mut field = Field(self.nodes.iter().map(part).collect());
            let size = field.0.iter().map(|part| part.way.length_squared()).sum::<f64>();
            all.iter().for_each(|other| field.leave_out(other));
            let product = field.product();
            // what is made of the others leaves rounding
            if product > DEPENDENT * size {
                field.0.iter_mut().for_each(|part| part.way /= product);
                all.push(field);
            }
        }
        all
    }

    /// Whether forces on all axes (N) do work along a motion of free ones.
    fn is_worked_along(&self, motion: [DVec3; 2], forces: &Reals, free: &[bool]) -> bool {
        let (mut sum, mut size) = (0.0, 0.0);
        for &(node, arm) in &self.nodes {
            let parts = on_free_axes(along(motion, arm), node, free) * forces.vector(node);
            sum += parts.element_sum();
            size += parts.abs().element_sum();
        }
        sum.abs() > PUSHES * size
    }
}

impl Field {
    /// Of its own weights and ways.
    fn product(&self) -> f64 {
        self.0.iter().map(|part| part.weight.dot(part.way)).sum()
    }

    /// Takes another of the same piece out: neither tells of the other then.
    fn leave_out(&mut self, other: &Field) {
        let pairs = || self.0.iter().zip(&other.0);
        let of_ways = pairs().map(|(own, other)| other.weight.dot(own.way)).sum::<f64>();
        let of_weights = pairs().map(|(own, other)| other.way.dot(own.weight)).sum::<f64>();
        for (own, other) in self.0.iter_mut().zip(&other.0) {
            own.way -= of_ways * other.way;
            own.weight -= of_weights * other.weight;
        }
    }

    /// Takes the part along it out of where all axes go (m), those that are held too, which are left as they are.
    pub fn take_out_of_way(&self, p: &mut Reals) {
        let share = self.0.iter().map(|part| part.weight.dot(p.vector(part.node))).sum::<f64>();
        for part in &self.0 {
            p.set_vector(part.node, p.vector(part.node) - share * part.way);
        }
    }

    /// Takes the part that does work along it out of forces on free axes (N).
    pub fn take_out_of_forces(&self, forces: &mut Reals, free: &[bool]) {
        let work = self.0.iter().map(|part| part.way.dot(forces.vector(part.node))).sum::<f64>();
        for part in &self.0 {
            let weight = on_free_axes(part.weight, part.node, free);
            forces.set_vector(part.node, forces.vector(part.node) - work * weight);
        }
    }
}

/// How a rotation and a translation move a node that is so far from the middle (m).
fn along([rotation, translation]: [DVec3; 2], arm: DVec3) -> DVec3 {
    translation + rotation.cross(arm)
}

/// A vector at a node without its parts along axes that are not free.
fn on_free_axes(vector: DVec3, node: usize, free: &[bool]) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|axis| if free[3 * node + axis] { vector[axis] } else { 0.0 }))
}

/// Combinations of so many motions that a form of theirs leaves, which is positive semi-definite.
fn combinations(count: usize, mut form: [[f64; 6]; 6]) -> Vec<[f64; 6]> {
    let largest = (0..count).map(|i| form[i][i]).fold(0.0, f64::max);
    // motions that there are not are held
    (count..6).for_each(|i| form[i][i] = if largest > 0.0 { largest } else { 1.0 });
    null_space(form)
}

/// A combination of motions.
fn combined(motions: &[[DVec3; 2]], parts: [f64; 6]) -> [DVec3; 2] {
    let sum = |which: usize| motions.iter().zip(parts).map(|(motion, part)| motion[which] * part).sum::<DVec3>();
    [sum(0), sum(1)]
}
