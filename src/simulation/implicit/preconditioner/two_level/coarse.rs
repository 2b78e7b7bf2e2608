//! The coarse level of a piece of a body: rigid motions of aggregates of its nodes, and what resists them.

use super::super::columns::Column;
use super::super::{Operator, SpringSlope};
use super::aggregates::{Aggregates, RIGID, motions};
use super::cholesky::Cholesky;
use super::rotation::{angle, rotation};
use super::touched::Touched;
use glam::{DMat3, DVec3};
use std::collections::BTreeSet;

/// Nodes of an aggregate at most, as long as a piece has no more aggregates than that: the matrix is dense.
const NODES_AN_AGGREGATE: usize = 30;
const MOST_AGGREGATES: usize = 128;
/// What has turned less (rad) is not turned back.
const HARDLY_TURNED: f64 = 0.035;

/// The coarse level of a piece.
pub(in crate::simulation::implicit) struct Coarse {
    /// Its nodes that move along some axis, among those of all bodies, in their order.
    pub nodes: Vec<usize>,
    /// Where they are at rest (m).
    rest: Vec<DVec3>,
    aggregates: Aggregates,
    /// Pᵀ K P: rows up to the diagonal, one after the other.
    stiffness: Vec<f64>,
    factor: Cholesky,
    /// What springs add to the matrix of the factor.
    touched: Touched,
    /// How each aggregate has turned, and the arms of nodes as they are then.
    rotations: Vec<DMat3>,
    arms: Vec<DVec3>,
    coarse: Vec<f64>,
    /// Along each axis that nothing holds, 1/ΣD of the piece (m/N); else 0.
    pub per_inertia: DVec3,
}

/// The place of an entry in rows up to the diagonal.
fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

impl Coarse {
    /// Of the nodes of a piece, with their rest positions (m); without its stiffness.
    pub fn of(piece: &[(usize, DVec3)], operator: &Operator<'_>) -> Self {
        let moves = |node: usize| operator.free[3 * node..3 * node + 3].contains(&true);
        let (nodes, rest): (Vec<usize>, Vec<DVec3>) = piece.iter().filter(|(node, _)| moves(*node)).copied().unzip();
        let most = NODES_AN_AGGREGATE.max(nodes.len().div_ceil(MOST_AGGREGATES));
        let aggregates = Aggregates::of(&rest, most);
        let size = RIGID * aggregates.count();
        let mut new = Self {
            stiffness: vec![0.0; size * (size + 1) / 2],
            factor: Cholesky::of(Vec::new(), 0),
            touched: Touched::default(),
            rotations: vec![DMat3::IDENTITY; aggregates.count()],
            arms: aggregates.arm.clone(),
            coarse: vec![0.0; size],
            per_inertia: DVec3::ZERO,
            nodes,
            rest,
            aggregates,
        };
        new.find_inertia(piece, operator);
        new
    }

    /// Which axes nothing holds, and how much inertia there is along them.
    fn find_inertia(&mut self, piece: &[(usize, DVec3)], operator: &Operator<'_>) {
        for axis in 0..3 {
            let all_free = piece.iter().all(|(node, _)| operator.free[3 * node + axis]);
            let sum: f64 = piece.iter().map(|(node, _)| operator.inertia[3 * node + axis]).sum();
            self.per_inertia[axis] = if all_free && sum > 0.0 { 1.0 / sum } else { 0.0 };
        }
    }

    /// Adds what a column of an element's stiffness is to the rigid motions of its corners, whose places among the
    /// nodes are told.
    pub(super) fn add(&mut self, column: &Column<'_>, places: &[Option<usize>], free: &[bool]) {
        let Some(own) = places[column.corner] else { return };
        let motion = motions(self.aggregates.arm[own], column.axis);
        let across = RIGID * self.aggregates.of_node[own];
        for (&other, force) in places.iter().zip(column.forces) {
            let Some(other) = other else { continue };
            let axis = |i: usize| if free[3 * self.nodes[other] + i] { force[i] } else { 0.0 };
            let force = DVec3::new(axis(0), axis(1), axis(2));
            let turn = self.aggregates.arm[other].cross(force);
            let forces = [force.x, force.y, force.z, turn.x, turn.y, turn.z];
            let down = RIGID * self.aggregates.of_node[other];
            for (i, force) in forces.iter().enumerate() {
                for (j, motion) in motion.iter().enumerate() {
                    let (row, of_column) = ((down + i).max(across + j), (down + i).min(across + j));
                    // both halves of the matrix come by
                    let share = if row == of_column { 1.0 } else { 0.5 };
                    self.stiffness[place(row, of_column)] += share * force * motion;
                }
            }
        }
    }

    /// Makes the factor of Pᵀ (D + c K) P.
    pub fn factorize(&mut self, piece: &[(usize, DVec3)], operator: &Operator<'_>) {
        self.find_inertia(piece, operator);
        let mut matrix: Vec<f64> = self.stiffness.iter().map(|entry| entry * operator.stiffness).collect();
        for (own, &node) in self.nodes.iter().enumerate() {
            let first = RIGID * self.aggregates.of_node[own];
            for axis in (0..3).filter(|axis| operator.free[3 * node + axis]) {
                let motion = motions(self.aggregates.arm[own], axis);
                let inertia = operator.inertia[3 * node + axis];
                for (i, j) in (0..RIGID).flat_map(|i| (0..=i).map(move |j| (i, j))) {
                    matrix[place(first + i, first + j)] += inertia * motion[i] * motion[j];
                }
            }
        }
        self.factor = Cholesky::of(matrix, self.coarse.len());
        self.touched.forget();
    }

    /// Takes the springs that act on nodes of this piece alone, with aggregates as they have turned: Pᵀ of them P.
    pub fn touch(&mut self, operator: &Operator<'_>) {
        let own = |first: usize| self.nodes.binary_search(&(first / 3)).ok();
        let is_own = |spring: &&SpringSlope<'_>| spring.parts.iter().all(|&(first, _)| own(first).is_some());
        let springs: Vec<&SpringSlope<'_>> = operator.springs.iter().filter(is_own).collect();
        let parts = springs.iter().flat_map(|spring| spring.parts);
        let aggregates: BTreeSet<usize> =
            parts.filter_map(|&(first, _)| Some(self.aggregates.of_node[own(first)?])).collect();
        let aggregates: Vec<usize> = aggregates.into_iter().collect();
        let count = RIGID * aggregates.len();
        let mut stiffness = vec![0.0; count * count];
        for spring in springs {
            // of each unknown the point's motion against what it touches
            let mut ways = vec![(0, DVec3::ZERO); 0];
            for &(first, weight) in spring.parts {
                let Some(own) = own(first) else { continue };
                let aggregate = self.aggregates.of_node[own];
                let Ok(place) = aggregates.binary_search(&aggregate) else { continue };
                for axis in (0..3).filter(|axis| operator.free[first + axis]) {
                    // along this axis of space, of motions in the frame of the aggregate
                    let back = self.rotations[aggregate].transpose().col(axis) * weight;
                    let turn = self.aggregates.arm[own].cross(back);
                    for (i, way) in back.to_array().into_iter().chain(turn.to_array()).enumerate() {
                        ways.push((RIGID * place + i, DVec3::AXES[axis] * way));
                    }
                }
            }
            for &(i, way) in &ways {
                let force = spring.slope * way;
                ways.iter().for_each(|&(j, other)| stiffness[count * i + j] += force.dot(other));
            }
        }
        self.touched.take(&aggregates, stiffness, &self.factor, self.coarse.len());
    }

    /// Turns aggregates as their nodes have turned, at displacements (m). Whether any has.
    pub fn turn(&mut self, displacement: impl Fn(usize) -> DVec3) -> bool {
        let count = self.aggregates.count();
        let mut middles = vec![[DVec3::ZERO; 2]; count];
        let mut shapes = vec![DMat3::ZERO; count];
        let places: Vec<DVec3> =
            self.nodes.iter().zip(&self.rest).map(|(&node, rest)| *rest + displacement(node)).collect();
        for (own, &aggregate) in self.aggregates.of_node.iter().enumerate() {
            let share = 1.0 / self.aggregates.sizes[aggregate] as f64;
            middles[aggregate][0] += share * self.rest[own];
            middles[aggregate][1] += share * places[own];
        }
        for (own, &aggregate) in self.aggregates.of_node.iter().enumerate() {
            let (rest, x) = (self.rest[own] - middles[aggregate][0], places[own] - middles[aggregate][1]);
            shapes[aggregate] += DMat3::from_cols(x * rest.x, x * rest.y, x * rest.z);
        }
        let turned = |shape: DMat3| rotation(shape).filter(|rotation| angle(rotation) > HARDLY_TURNED);
        let found: Vec<Option<DMat3>> = shapes.into_iter().map(turned).collect();
        let any = found.iter().any(Option::is_some);
        self.rotations = found.into_iter().map(|rotation| rotation.unwrap_or(DMat3::IDENTITY)).collect();
        for (own, arm) in self.arms.iter_mut().enumerate() {
            *arm = self.rotations[self.aggregates.of_node[own]] * self.aggregates.arm[own];
        }
        any
    }

    /// Its nodes, among those of all bodies, each with its aggregate and its arm at rest.
    pub fn members(&self) -> impl Iterator<Item = (usize, usize, DVec3)> + '_ {
        let of_aggregates = self.aggregates.of_node.iter().zip(&self.aggregates.arm);
        self.nodes.iter().zip(of_aggregates).map(|(&node, (&aggregate, &arm))| (node, aggregate, arm))
    }

    /// How each aggregate has turned.
    pub fn rotations(&self) -> &[DMat3] {
        &self.rotations
    }

    /// The inverse of the matrix, row by row (m/N).
    pub fn inverse(&self) -> Vec<f64> {
        self.factor.inverse()
    }

    /// How many unknowns it has.
    pub fn size(&self) -> usize {
        self.coarse.len()
    }

    /// Bytes of the matrix and its factor.
    pub fn bytes_of_matrix(&self) -> usize {
        size_of_val(&self.stiffness[..]) + self.factor.bytes()
    }

    /// Bytes of what belongs to its nodes and aggregates.
    pub fn bytes(&self) -> usize {
        let of_nodes = size_of_val(&self.nodes[..]) + size_of_val(&self.rest[..]) + size_of_val(&self.arms[..]);
        let turned = size_of_val(&self.rotations[..]) + size_of_val(&self.coarse[..]);
        of_nodes + turned + self.aggregates.bytes() + self.touched.bytes()
    }

    /// The nodes with how they have turned.
    pub fn turned_nodes(&self) -> impl Iterator<Item = (usize, DMat3)> + '_ {
        self.nodes.iter().zip(&self.aggregates.of_node).map(|(&node, &aggregate)| (node, self.rotations[aggregate]))
    }

    /// Adds P A⁻¹ Pᵀ r to z, on free axes.
    pub fn correct(&mut self, free: &[bool], residual: &[f64], z: &mut [f64]) {
        self.coarse.fill(0.0);
        for ((&node, &aggregate), arm) in self.nodes.iter().zip(&self.aggregates.of_node).zip(&self.arms) {
            let r = DVec3::from_slice(&residual[3 * node..]);
            let turn = arm.cross(r);
            let sums = &mut self.coarse[RIGID * aggregate..][..RIGID];
            (0..3).for_each(|i| (sums[i], sums[3 + i]) = (sums[i] + r[i], sums[3 + i] + turn[i]));
        }
        turn_all(&mut self.coarse, &self.rotations, DMat3::transpose);
        self.factor.solve(&mut self.coarse);
        self.touched.correct(&mut self.coarse);
        turn_all(&mut self.coarse, &self.rotations, |rotation| *rotation);
        for ((&node, &aggregate), &arm) in self.nodes.iter().zip(&self.aggregates.of_node).zip(&self.arms) {
            let motion = &self.coarse[RIGID * aggregate..][..RIGID];
            let moved = DVec3::from_slice(motion) + DVec3::from_slice(&motion[3..]).cross(arm);
            for i in (0..3).filter(|i| free[3 * node + i]) {
                z[3 * node + i] += moved[i];
            }
        }
    }
}

/// Turns translations and rotations of aggregates into other frames.
fn turn_all(motions: &mut [f64], rotations: &[DMat3], which: impl Fn(&DMat3) -> DMat3) {
    for (motion, rotation) in motions.chunks_exact_mut(3).zip(rotations.iter().flat_map(|rotation| [rotation; 2])) {
        motion.copy_from_slice(&(which(rotation) * DVec3::from_slice(motion)).to_array());
    }
}

#[cfg(test)]
impl Coarse {
    /// Compares the matrix with what products of K with all motions of all aggregates make.
    pub fn compare_with(&self, operator: &Operator<'_>, mut times: impl FnMut(&[f64], &mut [f64])) {
        let along = |column: usize, vector: &mut [f64]| {
            for (own, &node) in self.nodes.iter().enumerate() {
                if self.aggregates.of_node[own] == column / RIGID {
                    for axis in (0..3).filter(|axis| operator.free[3 * node + axis]) {
                        vector[3 * node + axis] = motions(self.aggregates.arm[own], axis)[column % RIGID];
                    }
                }
            }
        };
        let size = self.coarse.len();
        let mut largest = 0.0_f64;
        for column in 0..size {
            let (mut motion, mut image) = (vec![0.0; operator.free.len()], vec![0.0; operator.free.len()]);
            along(column, &mut motion);
            times(&motion, &mut image);
            for row in column..size {
                let mut other = vec![0.0; motion.len()];
                along(row, &mut other);
                let expected: f64 = image.iter().zip(&other).map(|(f, u)| f * u).sum();
                let found = self.stiffness[place(row, column)];
                let [a, b] = [row, column].map(|i| self.stiffness[place(i, i)]);
                // differences of forces of one side have the curvature of the law in them
                assert!((found - expected).abs() < 1e-5 * (a * b).sqrt(), "{row}, {column}: {found}, not {expected}");
                largest = largest.max(found);
            }
        }
        assert!(size > RIGID && largest > 0.0);
    }
}
