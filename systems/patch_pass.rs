//! `element_forces` and the systems of nodes that follow it, in one pass over the patches: the nodes inside a patch move while
//! they are in the core's cache, those that patches share when all patches are done.

use super::element_forces::{BlockParts, Precise};
use super::gather::sum_at;
use super::node_pass::{BodyColumns, BodyColumnsItem, OnBodies, OnRows, move_rows};
use super::registry::HostSystem;
use crate::backend::cpu::{Cpu, Factors, Inside, NodeColumns, ROWS_A_TASK};
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use bevy_ecs::system::IntoSystem;
use std::sync::atomic::AtomicU32;

/// `element_forces` and others as one, in their order.
pub(crate) fn patch_pass(systems: Vec<String>) -> HostSystem {
    let pass = move |cpu: Res<Cpu>,
                     clock: Res<Clock>,
                     observed: Res<Observed>,
                     on_bodies: OnBodies,
                     mut blocks: Query<BlockParts>,
                     mut bodies: Query<(BodyColumns, &Authoring, &Corners, &mut ElementForce)>|
          -> Result<(), Error> {
        for (mut body, authoring, corners, mut force) in &mut bodies {
            let on_rows = &on_bodies.of(&systems, &body);
            let step =
                Step { cpu: &cpu, clock: &clock, observed: observed.0, blocks: &authoring.blocks, corners, on_rows };
            match body.u.precision() {
                Precision::F32 => step.take::<f32>(&mut body, &mut force, &mut blocks),
                Precision::F64 => step.take::<f64>(&mut body, &mut force, &mut blocks),
            }
        }
        Ok(())
    };
    Box::new(IntoSystem::into_system(pass))
}

/// A step of one body.
struct Step<'a> {
    cpu: &'a Cpu,
    clock: &'a Clock,
    observed: bool,
    blocks: &'a [Entity],
    corners: &'a Corners,
    on_rows: &'a OnRows<'a>,
}

impl Step<'_> {
    fn take<T: Precise>(
        &self,
        body: &mut BodyColumnsItem<'_, '_>,
        force: &mut ElementForce,
        blocks: &mut Query<BlockParts>,
    ) {
        let factors = Factors::<T>::of(self.clock);
        let astray = AtomicU32::new(u32::MAX);
        let patches = |blocks: &Query<BlockParts>, entity: Entity| -> Vec<u32> {
            let parts = blocks.get(entity).ok();
            parts.and_then(|block| block.patches).map_or(Vec::new(), |patches| patches.inside.clone())
        };
        let rows: Vec<Vec<u32>> = self.blocks.iter().map(|&entity| patches(blocks, entity)).collect();
        let (mut inside, shared) = inside_patches(body.columns::<T>(), &rows);
        let act = |rows: &mut NodeColumns<'_, T>| self.on_rows.act(self.cpu, rows);
        let mut found = Vec::new();
        for (&entity, nodes) in self.blocks.iter().zip(&mut inside) {
            let inside = Inside { nodes, before: &act, factors: &factors, observed: self.observed, astray: &astray };
            let displacement = (&*shared.u, self.corners.first_shared);
            let patches = blocks
                .get_mut(entity)
                .map_or(Vec::new(), |mut block| block.run(self.cpu, displacement, force.slice_mut(), Some(inside)));
            found.push((entity, patches));
        }
        for (entity, patches) in &found {
            if let Ok(mut block) = blocks.get_mut(*entity) {
                block.note_inverted(patches, &body.u, self.clock);
            }
        }
        // nodes of patches in which elements were inverted are where they were
        let mut shared = body.columns::<T>();
        let mut left = Vec::new();
        if found.iter().any(|(_, found)| !found.is_empty()) {
            for (patches, (_, found)) in rows.iter().zip(&found) {
                for (patch, &rows) in patches.iter().enumerate() {
                    let nodes = shared.take(rows as usize);
                    left.extend(found.binary_search(&patch).is_ok().then_some(nodes));
                }
            }
        } else {
            shared.take(self.corners.first_shared);
        }
        left.extend(shared.tasks(ROWS_A_TASK));
        let forces = force.slice();
        let others = move_rows(self.cpu, &factors, self.observed, left, |rows| {
            sum_at(self.corners, forces, rows.first, rows.internal);
            self.on_rows.act(self.cpu, rows);
        });
        body.note_astray(astray.into_inner().min(others), self.clock);
    }
}

/// The nodes inside the patches of each block, and all others.
fn inside_patches<'a, T>(
    mut all: NodeColumns<'a, T>,
    blocks: &[Vec<u32>],
) -> (Vec<Vec<NodeColumns<'a, T>>>, NodeColumns<'a, T>) {
    let inside = blocks.iter().map(|patches| patches.iter().map(|&rows| all.take(rows as usize)).collect()).collect();
    (inside, all)
}
