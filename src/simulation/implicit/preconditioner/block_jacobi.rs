//! The 3×3 block of each node, of all elements at rest.

use super::super::vectors::{copy, none, with_numbers};
use super::columns::{Columns, each_column, elements_left};
use super::{Operator, Preconditioner};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::math::Scalar;
use glam::{DMat3, DVec3};
use half::bf16;
use std::collections::BTreeMap;

/// B = the inverses of the diagonal blocks of D + c K, K that of bodies at rest: found once, and again when some
/// elements have gone; and of the springs that touch.
pub(in crate::simulation) struct BlockJacobi {
    /// The numbers of vectors.
    pub precision: Precision,
    /// Diagonal blocks of K (N/m), a node each; and while they are added up, in all digits.
    stiffness: Blocks,
    sums: Vec<DMat3>,
    /// How many elements it is of.
    elements: usize,
    /// Inverses of the blocks (m/N), as their nodes have turned.
    inverses: Blocks,
    /// What the inverses were made of.
    pub inertia: Reals,
    pub free: Vec<bool>,
    share: f64,
    /// What springs add to the blocks of nodes that they act on (N/m).
    springs: BTreeMap<usize, DMat3>,
}

/// Symmetric 3×3 matrices, a node each. Those of a run in f32 are in f32, by their diagonals and yx, zx and zy; the
/// stiffness at rest, of which a preconditioner needs no more than two digits, is in halves of these.
enum Blocks {
    Half(Vec<[bf16; 6]>),
    F32(Vec<[f32; 6]>),
    F64(Vec<DMat3>),
}

impl Default for Blocks {
    fn default() -> Self {
        Self::F32(Vec::new())
    }
}

impl Blocks {
    /// Zeros of so many nodes.
    fn zeros(precision: Precision, nodes: usize) -> Self {
        match precision {
            Precision::F32 => Self::F32(vec![[0.0; 6]; nodes]),
            Precision::F64 => Self::F64(vec![DMat3::ZERO; nodes]),
        }
    }

    /// The same, of a stiffness at rest.
    fn of_rest(precision: Precision, nodes: usize) -> Self {
        match precision {
            Precision::F32 => Self::Half(vec![[bf16::ZERO; 6]; nodes]),
            Precision::F64 => Self::F64(vec![DMat3::ZERO; nodes]),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Half(blocks) => blocks.len(),
            Self::F32(blocks) => blocks.len(),
            Self::F64(blocks) => blocks.len(),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Half(blocks) => size_of_val(&blocks[..]),
            Self::F32(blocks) => size_of_val(&blocks[..]),
            Self::F64(blocks) => size_of_val(&blocks[..]),
        }
    }

    fn set(&mut self, node: usize, matrix: DMat3) {
        match self {
            Self::Half(blocks) => blocks[node] = entries(matrix).map(bf16::from_f32),
            Self::F32(blocks) => blocks[node] = entries(matrix),
            Self::F64(blocks) => blocks[node] = matrix,
        }
    }

    fn get(&self, node: usize) -> DMat3 {
        match self {
            Self::Half(blocks) => widened(&blocks[node].map(bf16::to_f32)),
            Self::F32(blocks) => widened(&blocks[node]),
            Self::F64(blocks) => blocks[node],
        }
    }

    /// Makes z = B r of r.
    fn apply(&self, z: &mut Reals) {
        with_numbers!(z, T => {
            let nodes = z.slice_mut::<T>().as_chunks_mut::<3>().0.iter_mut();
            match self {
                Self::Half(blocks) => {
                    nodes.zip(blocks).for_each(|(z, block)| *z = times(widened(&block.map(bf16::to_f32)), *z));
                }
                Self::F32(blocks) => nodes.zip(blocks).for_each(|(z, block)| *z = times(widened(block), *z)),
                Self::F64(blocks) => nodes.zip(blocks).for_each(|(z, block)| *z = times(*block, *z)),
            }
        });
    }
}

fn times<T: Scalar>(block: DMat3, r: [T; 3]) -> [T; 3] {
    (block * DVec3::from(r.map(T::to_f64))).to_array().map(T::from_f64)
}

fn entries(matrix: DMat3) -> [f32; 6] {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let beside = [0.5 * (x.y + y.x), 0.5 * (x.z + z.x), 0.5 * (y.z + z.y)];
    [x.x, y.y, z.z, beside[0], beside[1], beside[2]].map(|entry| entry as f32)
}

fn widened(block: &[f32; 6]) -> DMat3 {
    let [xx, yy, zz, yx, zx, zy] = block.map(f64::from);
    DMat3::from_cols(DVec3::new(xx, yx, zx), DVec3::new(yx, yy, zy), DVec3::new(zx, zy, zz))
}

/// What is another than it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Changed {
    Nothing,
    /// D or the share of K.
    Shares,
    /// Which axes are free.
    Axes,
    /// Which elements there are.
    Bodies,
}

impl Preconditioner for BlockJacobi {
    fn apply(&mut self, _: &Cpu, residual: &Reals, z: &mut Reals) {
        copy(z, residual);
        self.apply_to(z);
    }

    fn follow(&mut self, operator: &Operator<'_>) {
        let changed = self.compare(operator);
        if changed == Changed::Bodies {
            self.begin(operator);
            each_column(operator, |columns| self.add(columns));
        }
        self.take(operator, changed);
    }

    fn block(&self, node: usize) -> DMat3 {
        self.inverses.get(node)
    }

    fn holds(&self) -> (String, Vec<(&'static str, u64)>) {
        let of_nodes = self.stiffness.bytes() + self.inverses.bytes();
        let of_axes = self.inertia.bytes().len() + size_of_val(&self.free[..]);
        ("the 3×3 blocks of nodes".into(), vec![("blocks of nodes", (of_nodes + of_axes) as u64)])
    }
}

impl BlockJacobi {
    /// None yet, for vectors of some numbers.
    pub fn of(precision: Precision) -> Self {
        Self {
            precision,
            stiffness: Blocks::default(),
            sums: Vec::new(),
            elements: 0,
            inverses: Blocks::default(),
            inertia: none(precision),
            free: Vec::new(),
            share: 0.0,
            springs: BTreeMap::new(),
        }
    }

    /// Makes z = B r of r.
    pub fn apply_to(&self, z: &mut Reals) {
        self.inverses.apply(z);
    }

    /// What of an operator is another than it was.
    pub fn compare(&mut self, operator: &Operator<'_>) -> Changed {
        let before = (self.stiffness.len() * 3, self.elements);
        self.elements = elements_left(operator);
        if before != (operator.free.len(), self.elements) {
            Changed::Bodies
        } else if self.free != operator.free {
            Changed::Axes
        } else if self.share != operator.stiffness
            || self.inertia != Reals::from_f64(self.precision, operator.inertia.all())
        {
            Changed::Shares
        } else {
            Changed::Nothing
        }
    }

    /// Begins with no stiffness, which comes by columns.
    pub fn begin(&mut self, operator: &Operator<'_>) {
        self.stiffness = Blocks::default();
        self.sums.clear();
        self.sums.resize(operator.free.len() / 3, DMat3::ZERO);
    }

    /// Adds what a column of all elements of a block is to the displaced node itself.
    pub fn add(&mut self, columns: &Columns<'_>) {
        for row in columns.rows() {
            let node = columns.node(row, columns.corner);
            *self.sums[node].col_mut(columns.axis) += columns.force(row, columns.corner);
        }
    }

    /// Follows an operator of which this has changed, and the springs that touch.
    pub fn take(&mut self, operator: &Operator<'_>, changed: Changed) {
        if !self.sums.is_empty() {
            self.stiffness = Blocks::of_rest(self.precision, self.sums.len());
            let sums = std::mem::take(&mut self.sums).into_iter().enumerate();
            sums.for_each(|(node, sum)| self.stiffness.set(node, sum));
        }
        if changed != Changed::Nothing {
            self.share = operator.stiffness;
            self.inertia = Reals::from_f64(self.precision, operator.inertia.all());
            self.free.clear();
            self.free.extend_from_slice(operator.free);
            self.springs.clear();
            self.inverses = Blocks::zeros(self.precision, self.stiffness.len());
            (0..self.stiffness.len()).for_each(|node| self.turn(node, DMat3::IDENTITY));
        }
        let before = std::mem::replace(&mut self.springs, blocks_of_springs(operator));
        for node in before.keys().chain(self.springs.keys()).copied().collect::<Vec<usize>>() {
            self.turn(node, DMat3::IDENTITY);
        }
    }

    /// Whether springs act on any node.
    pub fn is_touched(&self) -> bool {
        !self.springs.is_empty()
    }

    /// Finds the inverse of the block of a node that has turned; what holds it, and what touches it, does not turn with
    /// it.
    pub fn turn(&mut self, node: usize, rotation: DMat3) {
        let inverse = match self.free[3 * node..3 * node + 3] {
            [true, true, true] if rotation != DMat3::IDENTITY && !self.springs.contains_key(&node) => {
                rotation * self.inverse_of(node, DMat3::IDENTITY) * rotation.transpose()
            }
            _ => self.inverse_of(node, rotation),
        };
        self.inverses.set(node, inverse);
    }

    fn inverse_of(&self, node: usize, rotation: DMat3) -> DMat3 {
        let axes = 3 * node..3 * node + 3;
        if self.free[axes.clone()] == [false; 3] {
            return DMat3::ZERO;
        }
        let at_rest = self.stiffness.get(node);
        let is_turned = rotation != DMat3::IDENTITY;
        let stiffness = if is_turned { rotation * at_rest * rotation.transpose() } else { at_rest };
        let springs = self.springs.get(&node).copied().unwrap_or(DMat3::ZERO);
        inverse(stiffness * self.share + springs, self.inertia.get(node), &self.free[axes])
    }
}

/// Of the block of a node with its inertia, on the axes that are free; of its diagonal where that is not positive.
fn inverse(stiffness: DMat3, inertia: f64, free: &[bool]) -> DMat3 {
    let mut block = stiffness;
    for i in 0..3 {
        block.col_mut(i)[i] += inertia;
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

/// What springs add to the diagonal blocks of nodes (N/m).
fn blocks_of_springs(operator: &Operator<'_>) -> BTreeMap<usize, DMat3> {
    let mut blocks = BTreeMap::new();
    for spring in operator.springs {
        for &(first, weight) in spring.parts {
            *blocks.entry(first / 3).or_insert(DMat3::ZERO) += spring.slope * (weight * weight);
        }
    }
    blocks
}
