//! `element_forces` and the systems of nodes that follow it, in one pass over the patches: the nodes inside a patch
//! move while they are in the core's cache, those that patches share when all patches are done.

use super::element_forces::{BlockParts, Precise};
use super::node_pass::{BodyColumns, BodyColumnsItem, InStep, NodePass, act, act_after_gather, move_rows};
use super::node_system::{BoundSystems, OfRun};
use super::registry::HostSystem;
use crate::backend::cpu::{Cpu, NodeColumns, PatchInterior, ROWS_A_TASK};
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{DynSystemParam, ParamBuilder, SystemParamBuilder};
use std::sync::atomic::AtomicU32;

/// `element_forces` and a pass over the nodes as one. Nodes inside patches go through the systems of another pass, too,
/// which the others come to later.
pub(crate) fn patch_pass(pass: NodePass, ahead: NodePass, world: &mut World) -> HostSystem {
    let count = pass.parameters().len();
    let parameters = (
        [pass.parameters(), ahead.parameters()].into_iter().flatten().collect::<Vec<_>>(),
        ParamBuilder::of::<InStep>(),
        ParamBuilder::query::<BlockParts>(),
        ParamBuilder::query::<(BodyColumns, &Authoring, &Corners, &mut ElementForce)>(),
    );
    let mut system = parameters.build_state(world).build_system(
        move |mut callers: Vec<DynSystemParam>,
              step: InStep,
              mut blocks: Query<BlockParts>,
              mut bodies: Query<(BodyColumns, &Authoring, &Corners, &mut ElementForce)>|
              -> Result<(), Error> {
            let (callers, callers_ahead) = callers.split_at_mut(count);
            for (mut body, authoring, corners, mut force) in &mut bodies {
                let of_body = StepOfBody {
                    cpu: &step.cpu,
                    clock: &step.clock,
                    observed: step.is_observed(),
                    to_come: !ahead.is_empty(),
                    blocks: &authoring.blocks,
                    first_interface: corners.first_interface,
                    systems: pass.bind(callers, &step, &body),
                    ahead: ahead.bind(callers_ahead, &step, &body),
                };
                match body.u.precision() {
                    Precision::F32 => of_body.take::<f32>(&mut body, &mut force, &mut blocks),
                    Precision::F64 => of_body.take::<f64>(&mut body, &mut force, &mut blocks),
                }
            }
            Ok(())
        },
    );
    system.initialize(world);
    Box::new(system)
}

/// A step of one body.
struct StepOfBody<'a> {
    cpu: &'a Cpu,
    clock: &'a Clock,
    /// Whether somebody may look at forces after the pass; and whether those on nodes outside patches are used later.
    observed: bool,
    to_come: bool,
    blocks: &'a [Entity],
    first_interface: usize,
    /// What is done to nodes; to those inside a patch as soon as that has summed their forces.
    systems: BoundSystems<'a>,
    /// What is done to those inside a patch afterwards, and to others later.
    ahead: BoundSystems<'a>,
}

impl StepOfBody<'_> {
    fn take<T: Precise + OfRun>(
        &self,
        body: &mut BodyColumnsItem<'_, '_>,
        force: &mut ElementForce,
        blocks: &mut Query<BlockParts>,
    ) {
        let non_finite = AtomicU32::new(u32::MAX);
        let patches = |blocks: &Query<BlockParts>, entity: Entity| -> Vec<u32> {
            let parts = blocks.get(entity).ok();
            parts.and_then(|block| block.patches).map_or(Vec::new(), |patches| patches.interior.clone())
        };
        let rows: Vec<Vec<u32>> = self.blocks.iter().map(|&entity| patches(blocks, entity)).collect();
        let (mut interior, shared) = patch_interiors(body.columns::<T>(&[], &non_finite), &rows);
        let then = |nodes: &mut NodeColumns<'_, T>| {
            act_after_gather(&self.systems, self.cpu, nodes);
            act(&self.ahead, self.cpu, nodes);
        };
        let mut found = Vec::new();
        for (&entity, nodes) in self.blocks.iter().zip(&mut interior) {
            let interior = PatchInterior { nodes, then: &then, observed: self.observed };
            let displacement = (&*shared.u, self.first_interface);
            let patches = blocks
                .get_mut(entity)
                .map_or(Vec::new(), |mut block| block.run(self.cpu, displacement, force.slice_mut(), Some(interior)));
            found.push((entity, patches));
        }
        for (entity, patches) in &found {
            if let Ok(mut block) = blocks.get_mut(*entity) {
                block.note_inverted(patches, &body.u, self.clock);
            }
        }
        // nodes of patches in which elements were inverted are where they were
        let mut shared = body.columns::<T>(force.slice(), &non_finite);
        let mut left = Vec::new();
        if found.iter().any(|(_, found)| !found.is_empty()) {
            for (patches, (_, found)) in rows.iter().zip(&found) {
                for (patch, &rows) in patches.iter().enumerate() {
                    let nodes = shared.take(rows as usize);
                    left.extend(found.binary_search(&patch).is_ok().then_some(nodes));
                }
            }
        } else {
            shared.take(self.first_interface);
        }
        if !self.to_come {
            left.extend(shared.tasks(ROWS_A_TASK));
            move_rows(self.cpu, self.observed, left, &[&self.systems]);
        } else {
            move_rows(self.cpu, self.observed, left, &[&self.systems, &self.ahead]);
            move_rows(self.cpu, true, shared.tasks(ROWS_A_TASK), &[&self.systems]);
        }
        body.note_non_finite(non_finite, self.clock);
    }
}

/// The nodes inside the patches of each block, and all others.
fn patch_interiors<'a, T>(
    mut all: NodeColumns<'a, T>,
    blocks: &[Vec<u32>],
) -> (Vec<Vec<NodeColumns<'a, T>>>, NodeColumns<'a, T>) {
    let interior = blocks.iter().map(|patches| patches.iter().map(|&rows| all.take(rows as usize)).collect()).collect();
    (interior, all)
}
