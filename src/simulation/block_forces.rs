//! The element kernel of a block run in f64 beside the simulation, whatever the run's precision and wherever it runs:
//! on copies, so that the world is only read.

use crate::backend::cpu::{BlockColumns, BlockLaw, Cpu, run_block};
use crate::components::*;
use crate::elements::{node_count, with_element_of};
use crate::math::lane_place;
use crate::systems::means_of;
use bevy_ecs::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// A block whose kernel runs in f64, beside the world.
pub(super) struct BlockForces<'w> {
    pub block: &'w Block,
    connectivity: Cow<'w, Connectivity>,
    patches: Option<&'w Patches>,
    corners: Option<Cow<'w, BlockCorners>>,
    /// Where its forces are among those of the body.
    range: Range<usize>,
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
            connectivity: Cow::Borrowed(world.get::<Connectivity>(entity)?),
            patches: world.get::<Patches>(entity),
            corners: corners.map(Cow::Borrowed),
            range: block.force_offset..block.force_offset + block.force_length,
            shape: widened(&world.get::<RestShape>(entity)?.0),
            fibres: world.get::<FibreDirection>(entity).map(|f| widened(&f.0)),
            law: law(world.get::<BlockLaw<f64>>(entity)?),
            memory: memory.map_or(Vec::new(), |memory| widened(&memory.0).into_owned()),
            volumes: world.get::<ElementVolume>(entity).map_or(Vec::new(), |v| vec![0.0; v.len()]),
            means: world.get::<NodalVolumeChange>(entity).map_or(Vec::new(), |v| vec![0.0; v.len()]),
        })
    }

    /// The same block without a history, with each corner of each element a node of its own, and forces one after the
    /// other as in the scheme of two passes: corner `a` of the element of a row is node `row·nodes + a`.
    pub fn apart(self) -> Self {
        let nodes = node_count(self.block.kind);
        let count = self.connectivity.len();
        let mut connectivity = vec![0; count];
        for (row, corner) in (0..count / nodes).flat_map(|row| (0..nodes).map(move |corner| (row, corner))) {
            connectivity[lane_place(row, nodes, corner)] = (row * nodes + corner) as u32;
        }
        let elements = (0..self.block.count * nodes).map(|node| (node / nodes) as u32).collect();
        let starts = (0..=count).map(|node| node.min(self.block.count * nodes) as u32).collect();
        let means = if self.means.is_empty() { Vec::new() } else { vec![0.0; count] };
        Self {
            connectivity: Cow::Owned(Connectivity(connectivity)),
            patches: None,
            corners: self.corners.map(|_| Cow::Owned(BlockCorners { starts, elements })),
            range: 0..3 * count,
            means,
            memory: vec![0.0; self.memory.len()],
            ..self
        }
    }

    /// Runs it: from the body's displacements (m) to the forces of all elements of the body at their corners (N).
    pub fn forces(&mut self, cpu: &Cpu, u: &[f64], element_force: &mut [f64]) {
        let block = self.block;
        if let Some(corners) = &self.corners {
            let read = (&*self.connectivity, &*self.shape, &**corners, u);
            means_of(cpu, block, read, &self.law, &mut self.volumes, &mut self.means);
        }
        let columns = BlockColumns {
            displacement: u,
            first_row: 0,
            connectivity: &self.connectivity,
            rest_shape: &self.shape,
            fibre_direction: self.fibres.as_deref(),
            nodal_volume_change: &self.means,
            memory: &mut self.memory,
            force: &mut element_force[self.range.clone()],
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
