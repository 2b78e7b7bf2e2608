//! What conjugate gradients are preconditioned with: a cheap approximate inverse of the operator of a Newton iteration.

mod block_jacobi;
mod columns;
mod two_level;

use super::equation::Inertia;
use super::vectors::{combine, copy, none, resize, update};
use crate::backend::cpu::Cpu;
use crate::components::{Precision, Reals};
use crate::scene::schema;
use bevy_ecs::prelude::*;
use block_jacobi::BlockJacobi;
pub(super) use columns::pieces;
use glam::DMat3;
pub(super) use two_level::{Coarse, RIGID, TwoLevel};

/// The operator A = D + c K of a linear solve, D diagonal (mass and damping), K the tangent stiffness of all bodies.
/// Its rows are all axes of all nodes, bodies one after the other.
#[derive(Clone, Copy)]
pub(in crate::simulation) struct Operator<'a> {
    /// The world; displacements in it are those at which K is taken.
    pub world: &'a World,
    /// The bodies, in their order.
    pub bodies: &'a [Entity],
    /// Whether an axis moves freely: not held, and not of an inactive node.
    pub free: &'a [bool],
    /// D of each node (N/m): c_m M, and what damping adds; 0 in statics. Of axes that are not free it does not count.
    pub inertia: Inertia<'a>,
    /// c, the share of K.
    pub stiffness: f64,
    /// The springs that touch.
    pub springs: &'a [SpringSlope<'a>],
}

/// A spring as a part of the operator.
pub(in crate::simulation) struct SpringSlope<'a> {
    /// First axes of its nodes, with signed weights.
    pub parts: &'a [(usize, f64)],
    /// What its force falls by (N/m), c and all: 3 × 3, symmetric.
    pub slope: DMat3,
}

/// An approximate inverse B of the operator: symmetric and positive definite on free axes, the same from one residual
/// to the next of a solve.
pub(in crate::simulation) trait Preconditioner: Send + Sync {
    /// z = B r (m) of a residual r (N), both over all axes of all bodies; where an axis is not free, r and z are 0. The
    /// same for any number of threads.
    fn apply(&mut self, cpu: &Cpu, residual: &Reals, z: &mut Reals);

    /// Follows an operator that may have changed, before each solve: where nodes have gone, which elements are left,
    /// how long the step is. What changes little may stay as it was.
    fn follow(&mut self, _: &Operator<'_>) {}

    /// What of it works on a node by itself, as it follows the operator now (m/N): symmetric.
    fn block(&self, node: usize) -> DMat3;

    /// The coarse levels that are added to that; their matrices are others where [`made`](Self::made) is another.
    fn coarse(&self) -> Vec<&Coarse> {
        Vec::new()
    }

    /// How often matrices of coarse levels have been made.
    fn made(&self) -> u64 {
        0
    }

    /// Moves bodies as a whole in a solution x (m) of a system with that right-hand side (N), which blocks and coarse
    /// levels alone have found: so that it keeps the momentum that [`apply`](Self::apply) keeps.
    fn settle(&self, _right: &Reals, _x: &mut Reals) {}

    /// What it is made of, in words, once it follows an operator; and the bytes that it holds.
    fn holds(&self) -> (String, Vec<(&'static str, u64)>);
}

/// None: z = r.
pub(in crate::simulation) struct Identity;

impl Preconditioner for Identity {
    fn apply(&mut self, _: &Cpu, residual: &Reals, z: &mut Reals) {
        copy(z, residual);
    }

    fn block(&self, _: usize) -> DMat3 {
        DMat3::IDENTITY
    }

    fn holds(&self) -> (String, Vec<(&'static str, u64)>) {
        ("nothing".into(), Vec::new())
    }
}

/// The diagonal D alone. It keeps linear momentum however early a solve ends.
pub(in crate::simulation) struct Mass {
    per_inertia: Reals,
}

impl Preconditioner for Mass {
    fn apply(&mut self, _: &Cpu, residual: &Reals, z: &mut Reals) {
        copy(z, residual);
        combine(z, &self.per_inertia, |r, per_inertia| r * per_inertia);
    }

    fn follow(&mut self, operator: &Operator<'_>) {
        let inverse = |axis: usize| {
            let inertia = operator.inertia.of(axis / 3);
            if operator.free[axis] && inertia > 0.0 { 1.0 / inertia } else { 0.0 }
        };
        resize(&mut self.per_inertia, operator.free.len());
        update(&mut self.per_inertia, |axis, _| inverse(axis));
    }

    fn block(&self, node: usize) -> DMat3 {
        DMat3::from_diagonal(self.per_inertia.vector(node))
    }

    fn holds(&self) -> (String, Vec<(&'static str, u64)>) {
        ("masses".into(), vec![("masses", self.per_inertia.bytes().len() as u64)])
    }
}

/// The one of a name, for vectors of some numbers.
pub(in crate::simulation) fn of_name(name: schema::Preconditioner, numbers: Precision) -> Box<dyn Preconditioner> {
    match name {
        schema::Preconditioner::TwoLevel => Box::new(TwoLevel::of(numbers)),
        schema::Preconditioner::BlockJacobi => Box::new(BlockJacobi::of(numbers)),
        schema::Preconditioner::Mass => Box::new(Mass { per_inertia: none(numbers) }),
        schema::Preconditioner::Identity => Box::new(Identity),
    }
}
