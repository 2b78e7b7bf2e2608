//! `element_forces` and the systems of nodes that follow it, in one pass over the patches: the nodes inside a patch
//! move while they are in the core's cache, those that patches share when all patches are done.

use super::element_forces::{BlockParts, BlockPartsItem, Precise};
use super::node_pass::{BodyColumns, BodyColumnsItem, InStep, NodePass, act, move_rows};
use super::node_system::{BoundSystem, Callers, OfRun};
use super::runs_on::HostSystem;
use crate::backend::cpu::{Cpu, NodeColumns, PatchInterior, ROWS_A_TASK, Undeclared};
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{ParamBuilder, QueryParamBuilder, SystemParamBuilder};
use bumpalo::Bump;
use std::sync::atomic::AtomicU32;

type Bodies<'w, 's> = Query<'w, 's, (BodyColumns, &'static Corners, &'static mut ElementForce)>;

/// `element_forces` and a pass over the nodes as one. Nodes go through the systems of another pass, too, to which those
/// of surfaces come later; in a step in which all sleep that act on surfaces in between, all nodes do. Bodies do not
/// wait for each other: threads take patches of any.
pub(crate) fn patch_pass(pass: NodePass, ahead: NodePass, world: &mut World) -> HostSystem {
    let ahead = ahead.after(&pass);
    let parameters = (
        QueryParamBuilder::new(|query| pass.callers(&ahead, query)),
        ParamBuilder::of::<InStep>(),
        ParamBuilder::query::<BlockParts>(),
        ParamBuilder::query::<(BodyColumns, &'static Corners, &'static mut ElementForce)>(),
    );
    let state = parameters.build_state(world);
    let mut system = state.build_system(
        move |callers: Callers, step: InStep, mut blocks: Query<BlockParts>, mut bodies: Bodies| -> Result<(), Error> {
            let (cpu, undeclared) = (&*step.cpu, Undeclared::default());
            cpu.with_arena(|arena| {
                // in the order of their bodies, and in a body of their forces
                let blocks = all(arena, blocks.iter().count(), blocks.iter_mut());
                blocks.sort_unstable_by_key(BlockPartsItem::place);
                let bodies = all(arena, bodies.iter().count(), bodies.iter_mut());
                bodies.sort_unstable_by_key(|(body, ..)| body.body);
                let mut blocks = blocks.chunk_by_mut(|one, other| one.place().0 == other.place().0).peekable();
                let tasks = bodies.iter_mut().map(|of_body| {
                    let body = of_body.0.body;
                    while blocks.next_if(|blocks| blocks[0].place().0 < body).is_some() {}
                    let own = blocks.next_if(|blocks| blocks[0].place().0 == body);
                    (of_body, own.unwrap_or_default())
                });
                cpu.for_each(tasks, |((body, corners, force), blocks)| {
                    cpu.with_arena(|arena| {
                        let of_body = StepOfBody {
                            cpu,
                            arena,
                            clock: &step.clock,
                            observed: step.is_observed(),
                            to_come: !ahead.is_empty() && !step.surfaces_sleep(),
                            corners,
                            systems: &pass.bind(&callers, &step, body, arena),
                            ahead: &ahead.bind(&callers, &step, body, arena),
                            undeclared: &undeclared,
                        };
                        match body.u.precision() {
                            Precision::F32 => of_body.take::<f32>(body, force, blocks),
                            Precision::F64 => of_body.take::<f64>(body, force, blocks),
                        }
                    });
                });
            });
            ahead.refuse(&undeclared)
        },
    );
    system.initialize(world);
    Box::new(system)
}

/// A step of one body.
struct StepOfBody<'a> {
    cpu: &'a Cpu,
    arena: &'a Bump,
    clock: &'a Clock,
    /// Whether somebody may look at forces after the pass; and whether those on nodes of surfaces are used later.
    observed: bool,
    to_come: bool,
    corners: &'a Corners,
    /// What is done to nodes; to those inside a patch as soon as that has summed their forces.
    systems: &'a [BoundSystem<'a>],
    /// What is done to them afterwards; to those of surfaces then or later.
    ahead: &'a [BoundSystem<'a>],
    undeclared: &'a Undeclared,
}

impl StepOfBody<'_> {
    fn take<T: Precise + OfRun>(
        &self,
        body: &mut BodyColumnsItem<'_, '_>,
        force: &mut ElementForce,
        blocks: &mut [BlockPartsItem<'_, '_>],
    ) {
        let &Self { cpu, arena, clock, to_come, systems, ahead, .. } = self;
        let non_finite = AtomicU32::new(u32::MAX);
        let mut shared = body.columns::<T>(&[], &non_finite, self.undeclared);
        let interior = arena.alloc_slice_fill_with(blocks.len(), |block| {
            arena.alloc_slice_fill_iter(blocks[block].take_inside(&mut shared))
        });
        let then = |free: &mut NodeColumns<'_, T>, deferred: &mut NodeColumns<'_, T>| {
            act_after_gather(systems, cpu, free);
            act(ahead, cpu, free);
            if deferred.rows() > 0 {
                act_after_gather(systems, cpu, deferred);
                act(if to_come { &[] } else { ahead }, cpu, deferred);
            }
        };
        // of the blocks up to the last that has some
        let mut found: Vec<Vec<usize>> = Vec::new();
        for (place, (block, nodes)) in blocks.iter_mut().zip(interior).enumerate() {
            let interior = PatchInterior { nodes, then: &then, observed: self.observed };
            let displacement = (&*shared.u, self.corners.first_interface);
            let patches = block.run(cpu, displacement, force.slice_mut(), Some(interior), false);
            if !patches.is_empty() {
                found.resize(place, Vec::new());
                found.push(patches);
            }
        }
        for (block, patches) in blocks.iter_mut().zip(&found) {
            block.note_inverted(patches, &body.u, clock);
        }
        // nodes of patches in which elements were inverted are where they were
        let mut shared = body.columns::<T>(force.slice(), &non_finite, self.undeclared);
        let (mut free, mut deferred) = (Vec::new(), Vec::new());
        for (block, found) in blocks.iter().zip(&found) {
            let inside = block.take_inside(&mut shared).enumerate();
            for (_, left) in inside.filter(|(patch, _)| found.binary_search(patch).is_ok()) {
                free.push(left.free);
                deferred.push(left.deferred);
            }
        }
        shared.take(self.corners.first_interface - shared.first);
        let never_wait = shared.take(self.corners.first_waiting - shared.first);
        let at_once = free.into_iter().chain(never_wait.tasks(ROWS_A_TASK));
        let others = deferred.into_iter().chain(shared.tasks(ROWS_A_TASK));
        move_rows(cpu, self.observed, at_once, &[systems, ahead]);
        match to_come {
            true => move_rows(cpu, true, others, &[systems]),
            false => move_rows(cpu, self.observed, others, &[systems, ahead]),
        }
        body.note_non_finite(non_finite, clock);
    }
}

/// Does what bound systems do to nodes inside a patch, whose forces are summed: `NodeSystem::act` of each but `gather`,
/// loads and then `integrate`.
fn act_after_gather<T: OfRun>(systems: &[BoundSystem<'_>], cpu: &Cpu, nodes: &mut NodeColumns<'_, T>) {
    if let Some(external) = nodes.external.as_deref_mut() {
        external.fill(T::default());
    }
    for system in systems.iter().map(BoundSystem::on_rows).filter(|system| !system.sums_forces()) {
        T::act(system, cpu, nodes);
    }
}

/// So many items, one after the other in memory.
fn all<I: Iterator>(arena: &Bump, count: usize, items: I) -> &mut [I::Item] {
    arena.alloc_slice_fill_iter(Counted { items, left: count })
}

struct Counted<I> {
    items: I,
    left: usize,
}

impl<I: Iterator> Iterator for Counted<I> {
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        self.left = self.left.saturating_sub(1);
        self.items.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Iterator> ExactSizeIterator for Counted<I> {}
