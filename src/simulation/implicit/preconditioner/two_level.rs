//! Two levels: the 3×3 blocks of nodes, and rigid motions of aggregates of neighbours, which take the slow modes out.
//! Both are of bodies at rest, and turned as the aggregates have turned since.

mod aggregates;
mod assembly;
mod cholesky;
mod coarse;
mod rotation;
mod touched;

use super::super::vectors::copy;
use super::block_jacobi::{BlockJacobi, Changed};
use super::columns::{each_column, pieces};
use super::{Operator, Preconditioner, SpringSlope};
use crate::backend::cpu::Cpu;
use crate::components::*;
pub(in super::super) use aggregates::RIGID;
use assembly::Assembly;
use bevy_ecs::prelude::*;
pub(in super::super) use coarse::Coarse;
use glam::{DMat3, DVec3};
use std::collections::BTreeSet;
use touched::{MOST_TOUCHED, Touched};

/// B r = Q (D⁻¹ + P A⁻¹ Pᵀ) Qᵀ r, D the diagonal blocks, P the rigid motions of aggregates of some 30 nodes, A = Pᵀ
/// (D + c K) P their dense matrix, a piece of a body each, Q the rotations of the aggregates. Springs that touch are in
/// D and in A, which they couple pieces in; of more aggregates than they may act on there, in D alone. At rest, where
/// rigid motions of a piece that nothing else holds are left out of A, springs that couple pieces are in D alone, too.
///
/// Of a piece that nothing holds along an axis, what it does as a whole is solved apart from that: B t = t tᵀ r / tᵀ D
/// t along its translation t, and the rest of B without a mean motion. So it keeps its linear momentum however early a
/// solve ends, as [`Mass`](super::Mass) does. Where a spring holds it to something that is no piece it does not.
pub(in crate::simulation) struct TwoLevel {
    fine: BlockJacobi,
    pieces: Vec<Piece>,
    /// Of each node its piece, and where it stands among the nodes there that move; empty until something touches.
    places: Vec<Option<[u32; 2]>>,
    touched: Touched,
    /// The motions of all aggregates.
    motions: Vec<f64>,
    turned: bool,
    /// How often matrices have been made.
    made: u64,
}

struct Piece {
    /// Its body, and the first of that's nodes among those of all bodies.
    body: Entity,
    first_node: usize,
    coarse: Coarse,
    /// Where its unknowns begin among those of all.
    first: usize,
    /// Whether a spring holds it to something that is no piece.
    is_held: bool,
}

impl Preconditioner for TwoLevel {
    fn apply(&mut self, cpu: &Cpu, residual: &Reals, z: &mut Reals) {
        copy(z, residual);
        let inertia = &self.fine.inertia;
        let mut wholes = Vec::new();
        if self.pieces.iter().any(Piece::moves) {
            wholes.extend(self.pieces.iter().map(|piece| piece.whole(inertia, z)));
        }
        for piece in &mut self.pieces {
            let own = piece.first..piece.first + piece.coarse.size();
            piece.coarse.solve(cpu, z, &mut self.motions[own]);
        }
        self.fine.apply_to(z);
        self.touched.correct(&mut self.motions);
        for (number, piece) in self.pieces.iter().enumerate() {
            piece.coarse.carry(&self.motions[piece.first..], &self.fine.free, z);
            if let Some(&whole) = wholes.get(number) {
                piece.move_as_a_whole(inertia, whole, z);
            }
        }
    }

    fn follow(&mut self, operator: &Operator<'_>) {
        let touches = self.fine.is_touched() || !operator.springs.is_empty();
        let changed = self.fine.compare(operator);
        if matches!(changed, Changed::Axes | Changed::Bodies) {
            self.fine.begin(operator);
            self.pieces = find_pieces(operator, &mut self.fine);
            self.places.clear();
            let size = self.pieces.last().map_or(0, |piece| piece.first + piece.coarse.size());
            self.motions.resize(size, 0.0);
        }
        self.fine.take(operator, changed);
        if changed != Changed::Nothing {
            self.made += 1;
            self.pieces.iter_mut().for_each(|piece| piece.coarse.factorize(operator));
            self.touched.forget();
        }
        self.turn(operator, changed != Changed::Nothing || touches);
        if touches {
            if self.places.is_empty() {
                self.places = places_of(&self.pieces, operator.free.len() / 3);
            }
            self.touch(operator);
        }
    }

    fn block(&self, node: usize) -> DMat3 {
        self.fine.block(node)
    }

    fn coarse(&self) -> Vec<&Coarse> {
        self.pieces.iter().map(|piece| &piece.coarse).collect()
    }

    fn made(&self) -> u64 {
        self.made
    }

    fn settle(&self, right: &Reals, x: &mut Reals) {
        self.pieces.iter().for_each(|piece| piece.settle(&self.fine.inertia, right, x));
    }

    fn holds(&self) -> (String, Vec<(&'static str, u64)>) {
        let (blocks, mut held) = self.fine.holds();
        let places = size_of_val(&self.places[..]) + size_of_val(&self.motions[..]) + self.touched.bytes();
        let of_pieces = self.pieces.iter().map(|piece| piece.coarse.bytes());
        let aggregates: usize = self.pieces.iter().map(|piece| piece.coarse.size() / RIGID).sum();
        let matrices: usize = self.pieces.iter().map(|piece| piece.coarse.bytes_of_matrix()).sum();
        held.push(("aggregates", (places + of_pieces.sum::<usize>()) as u64));
        held.push(("coarse matrices with their factors", matrices as u64));
        let coarse = format!("{aggregates} aggregates of nodes with {RIGID} rigid motions each");
        (format!("{blocks}, and {coarse}"), held)
    }
}

impl TwoLevel {
    /// Whether an aggregate has turned.
    pub fn is_turned(&self) -> bool {
        self.turned
    }

    /// None yet, for vectors of some numbers.
    pub fn of(numbers: Precision) -> Self {
        Self {
            fine: BlockJacobi::of(numbers),
            pieces: Vec::new(),
            places: Vec::new(),
            touched: Touched::default(),
            motions: Vec::new(),
            turned: false,
            made: 0,
        }
    }

    /// Takes the springs that touch, with aggregates as they have turned: Pᵀ of them P.
    fn touch(&mut self, operator: &Operator<'_>) {
        let place = |first: usize| self.places[first / 3].map(|place| place.map(|number| number as usize));
        let at_rest = operator.inertia.all().all(|inertia| inertia == 0.0);
        let is_of_one = |spring: &&SpringSlope<'_>| {
            let mut pieces = spring.parts.iter().filter_map(|&(first, _)| Some(place(first)?[0]));
            let one = pieces.next();
            pieces.all(|piece| Some(piece) == one)
        };
        let springs: Vec<_> = operator.springs.iter().filter(|spring| !at_rest || is_of_one(spring)).collect();
        let parts = springs.iter().flat_map(|spring| spring.parts);
        let on = parts.filter_map(|&(first, _)| {
            let [piece, own] = place(first)?;
            let Piece { coarse, first, .. } = &self.pieces[piece];
            Some(first / RIGID + coarse.aggregates.of(own))
        });
        let aggregates: Vec<usize> = on.collect::<BTreeSet<usize>>().into_iter().collect();
        let (aggregates, springs) = match aggregates.len() {
            0..=MOST_TOUCHED => (aggregates, springs),
            _ => (Vec::new(), Vec::new()),
        };
        let count = RIGID * aggregates.len();
        let mut stiffness = vec![0.0; count * count];
        let mut held = vec![false; self.pieces.len()];
        for spring in springs {
            let is_held = is_outside(spring, |first| place(first).is_none());
            // of each unknown the point's motion against what it touches
            let mut ways: Vec<(usize, DVec3)> = Vec::new();
            for &(first, weight) in spring.parts {
                let Some([piece, own]) = place(first) else { continue };
                held[piece] |= is_held;
                let Piece { coarse, first: begins, .. } = &self.pieces[piece];
                for axis in (0..3).filter(|axis| operator.free[first + axis]) {
                    let (unknown, moved) = coarse.ways(own, axis, weight);
                    let Ok(at) = aggregates.binary_search(&((begins + unknown) / RIGID)) else { continue };
                    ways.extend((0..RIGID).map(|i| (RIGID * at + i, DVec3::AXES[axis] * moved[i])));
                }
            }
            for &(i, way) in &ways {
                let force = spring.slope * way;
                ways.iter().for_each(|&(j, other)| stiffness[count * i + j] += force.dot(other));
            }
        }
        let pieces = &self.pieces;
        self.touched.take(&aggregates, stiffness, |aggregate| {
            let of = pieces.partition_point(|piece| piece.first <= RIGID * aggregate) - 1;
            let Piece { coarse, first, .. } = &pieces[of];
            let own = RIGID * aggregate - first;
            (*first, (own..own + RIGID).map(|unknown| coarse.column(unknown)).collect())
        });
        self.pieces.iter_mut().zip(held).for_each(|(piece, held)| piece.is_held = held);
    }

    fn turn(&mut self, operator: &Operator<'_>, again: bool) {
        let mut turned = false;
        for Piece { coarse, body, first_node, .. } in &mut self.pieces {
            let (rest, displacement) =
                (operator.world.get::<RestPosition>(*body), operator.world.get::<Displacement>(*body));
            if let (Some(rest), Some(displacement)) = (rest, displacement) {
                turned |= coarse.turn(|node| (rest.0[node - *first_node], displacement.vector(node - *first_node)));
            }
        }
        if turned || self.turned || again {
            for (node, rotation) in self.pieces.iter().flat_map(|piece| piece.coarse.turned_nodes()) {
                self.fine.turn(node, rotation);
            }
        }
        self.turned = turned;
    }
}

/// Whether a spring acts on something that is at rest, or led.
fn is_outside(spring: &SpringSlope<'_>, is_led: impl Fn(usize) -> bool) -> bool {
    let sum: f64 = spring.parts.iter().map(|(_, weight)| weight).sum();
    sum.abs() > 0.5 || spring.parts.iter().any(|&(first, weight)| weight != 0.0 && is_led(first))
}

impl Piece {
    /// Its nodes, among those of all bodies; all that move.
    fn each_node(&self) -> impl Iterator<Item = usize> + '_ {
        self.coarse.nodes.iter().map(|&node| node as usize)
    }

    /// Whether there is an axis that nothing holds.
    fn moves(&self) -> bool {
        self.per_inertia() != DVec3::ZERO
    }

    /// Along each axis that nothing holds, 1/ΣD of it (m/N); else 0.
    fn per_inertia(&self) -> DVec3 {
        if self.is_held { DVec3::ZERO } else { self.coarse.per_inertia }
    }

    /// Takes out of a residual what moves the piece as a whole, r − D t (tᵀ r/tᵀ D t); gives that motion (m).
    fn whole(&self, inertia: &Reals, residual: &mut Reals) -> DVec3 {
        let per_inertia = self.per_inertia();
        if per_inertia == DVec3::ZERO {
            return DVec3::ZERO;
        }
        let force: DVec3 = self.each_node().map(|node| residual.vector(node)).sum();
        let motion = force * per_inertia;
        for node in self.each_node() {
            residual.set_vector(node, residual.vector(node) - inertia.get(node) * motion);
        }
        motion
    }

    /// Adds a motion of the whole to x (m) such that tᵀ (b − D x) = 0 along each axis that nothing holds: elements do
    /// not resist it, so that D alone is there of the operator.
    fn settle(&self, inertia: &Reals, right: &Reals, x: &mut Reals) {
        let per_inertia = self.per_inertia();
        if per_inertia == DVec3::ZERO {
            return;
        }
        let left = |node: usize| right.vector(node) - inertia.get(node) * x.vector(node);
        let motion = self.each_node().map(left).sum::<DVec3>() * per_inertia;
        for node in self.each_node() {
            x.set_vector(node, x.vector(node) + motion);
        }
    }

    /// Puts a motion (m) in the place of the mean one in z.
    fn move_as_a_whole(&self, inertia: &Reals, motion: DVec3, z: &mut Reals) {
        let per_inertia = self.per_inertia();
        if per_inertia == DVec3::ZERO {
            return;
        }
        let weighted = |node: usize| z.vector(node) * inertia.get(node);
        let mean = self.each_node().map(weighted).sum::<DVec3>() * per_inertia;
        for node in self.each_node() {
            z.set_vector(node, z.vector(node) + (motion - mean));
        }
    }
}

/// The pieces of all bodies, with the stiffness of their coarse levels; that of nodes comes by beside.
fn find_pieces(operator: &Operator<'_>, fine: &mut BlockJacobi) -> Vec<Piece> {
    let (mut all, mut first, mut unknowns) = (Vec::new(), 0, 0);
    for &body in operator.bodies {
        let Some(rest) = operator.world.get::<RestPosition>(body) else { continue };
        for nodes in pieces(operator.world, body) {
            let nodes: Vec<(usize, DVec3)> = nodes.into_iter().map(|node| (first + node, rest.0[node])).collect();
            let coarse = Coarse::of(&nodes, operator, fine.precision);
            let end = unknowns + coarse.size();
            all.push(Piece { body, first_node: first, coarse, first: unknowns, is_held: false });
            unknowns = end;
        }
        first += rest.0.len();
    }
    let mut assembly = Assembly::of(all.iter().map(|piece| &piece.coarse), operator.free);
    let cpu = operator.world.resource::<Cpu>();
    each_column(operator, |columns| {
        fine.add(columns);
        assembly.add(cpu, columns, all.iter_mut().map(|piece| &mut piece.coarse));
    });
    all
}

/// Of each node of all bodies its piece, and where it stands there.
fn places_of(pieces: &[Piece], nodes: usize) -> Vec<Option<[u32; 2]>> {
    let mut places = vec![None; nodes];
    for (number, piece) in pieces.iter().enumerate() {
        let nodes = piece.coarse.members().enumerate();
        nodes.for_each(|(own, (node, ..))| places[node] = Some([number as u32, own as u32]));
    }
    places
}
