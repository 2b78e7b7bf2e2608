//! The element kernel of a block run in f64 beside the simulation, whatever the run's precision and wherever it runs:
//! on copies, so that the world is only read.

use crate::backend::cpu::{BlockColumns, BlockLaw, Cpu, run_block};
use crate::components::*;
use crate::elements::with_element_of;
use crate::systems::means_of;
use bevy_ecs::prelude::*;
use std::borrow::Cow;

/// A block whose kernel runs in f64, beside the world.
pub(super) struct BlockForces<'w> {
    pub block: &'w Block,
    connectivity: &'w Connectivity,
    patches: Option<&'w Patches>,
    corners: Option<&'w BlockCorners>,
    shape: Cow<'w, [f64]>,
    fibres: Option<Cow<'w, [f64]>>,
    law: BlockLaw<f64>,
    /// Its viscous memory, which its kernel carries on.
    pub memory: Vec<f64>,
    volumes: Vec<f64>,
    means: Vec<f64>,
}

impl<'w> BlockForces<'w> {
    /// With the law made from the block's own; `None` where a column is missing.
    pub fn of(world: &'w World, entity: Entity, law: impl Fn(&BlockLaw<f64>) -> BlockLaw<f64>) -> Option<Self> {
        let block = world.get::<Block>(entity)?;
        let memory = world.get::<ViscousMemory>(entity);
        let corners = world.get::<BlockCorners>(entity);
        Some(Self {
            block,
            connectivity: world.get::<Connectivity>(entity)?,
            patches: world.get::<Patches>(entity),
            corners,
            shape: widened(&world.get::<RestShape>(entity)?.0),
            fibres: world.get::<FibreDirection>(entity).map(|f| widened(&f.0)),
            law: law(world.get::<BlockLaw<f64>>(entity)?),
            memory: memory.map_or(Vec::new(), |memory| widened(&memory.0).into_owned()),
            volumes: world.get::<ElementVolume>(entity).map_or(Vec::new(), |v| vec![0.0; v.len()]),
            means: world.get::<NodalVolumeChange>(entity).map_or(Vec::new(), |v| vec![0.0; v.len()]),
        })
    }

    /// Runs it: from the body's displacements (m) to the forces of all elements of the body at their corners (N).
    pub fn forces(&mut self, cpu: &Cpu, u: &[f64], element_force: &mut [f64]) {
        let block = self.block;
        if let Some(corners) = self.corners {
            let read = (self.connectivity, &*self.shape, corners, u);
            means_of(cpu, block, read, &self.law, &mut self.volumes, &mut self.means);
        }
        let columns = BlockColumns {
            displacement: u,
            first_row: 0,
            connectivity: self.connectivity,
            rest_shape: &self.shape,
            fibre_direction: self.fibres.as_deref(),
            nodal_volume_change: &self.means,
            memory: &mut self.memory,
            force: &mut element_force[block.force_offset..block.force_offset + block.force_length],
            patches: self.patches,
            inverted_go: false,
            interior: None,
        };
        with_element_of!(block, E => run_block::<E, f64>(cpu, columns, &self.law, patch_groups(block.kind)));
    }
}

/// In f64.
pub(super) fn widened(reals: &Reals) -> Cow<'_, [f64]> {
    match reals {
        Reals::F64(values) => Cow::Borrowed(values),
        Reals::F32(values) => Cow::Owned(values.iter().map(|&value| f64::from(value)).collect()),
    }
}
