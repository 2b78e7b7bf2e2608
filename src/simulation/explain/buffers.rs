//! Columns and buffers, counted.

use super::Buffer;
use crate::backend::Buffers;
use crate::backend::gpu::GpuLimits;
use crate::backend::kernel::{BufferId, Composed, Composer, DESKTOP_WORKGROUP, Kernel, KernelError, MostBuffers};
use crate::components::{Corners, Label, Patches, RestPosition, all_columns, columns_in};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bytes of every column of every entity, and what the entities are called.
pub struct Sizes {
    bytes: BTreeMap<(Entity, &'static str), u64>,
    names: BTreeMap<Entity, String>,
}

impl Sizes {
    /// Of a world.
    pub fn of(world: &mut World) -> Self {
        let mut query = world.query::<(Entity, Option<&Label>)>();
        let names: BTreeMap<Entity, String> = query
            .iter(world)
            .map(|(entity, label)| (entity, label.map_or_else(|| entity.to_string(), |label| label.0.clone())))
            .collect();
        let mut bytes = BTreeMap::new();
        for column in all_columns() {
            for &entity in names.keys() {
                if let Some(found) = (column.bytes)(world, entity) {
                    bytes.insert((entity, column.name), found.len() as u64);
                }
            }
        }
        Self { bytes, names }
    }

    /// Those of some names that occur in the world: systems also ask for columns that the scene may not call for.
    pub fn existing(&self, names: &[&'static str]) -> Vec<&'static str> {
        let occurs = |name: &&str| self.bytes.keys().any(|(_, column)| column == name);
        names.iter().copied().filter(|name| occurs(name)).collect()
    }

    /// Bytes of all columns of these names.
    pub fn sum(&self, names: &[&'static str]) -> u64 {
        self.bytes.iter().filter(|((_, name), _)| names.contains(name)).map(|(_, bytes)| bytes).sum()
    }

    fn name_of(&self, entity: Entity) -> String {
        self.names.get(&entity).cloned().unwrap_or_default()
    }
}

/// All columns on the host, by what they belong to.
pub fn host_columns(sizes: &Sizes, world: &mut World) -> Vec<Buffer> {
    let column = |entity: Entity, name: &str, bytes: u64| Buffer {
        of: sizes.name_of(entity),
        name: name.to_string(),
        kind: "column",
        bytes,
    };
    let mut columns: Vec<Buffer> =
        sizes.bytes.iter().map(|((entity, name), bytes)| column(*entity, name, *bytes)).collect();
    // these have no twin on the device, or another one
    for (entity, rest, corners) in world.query::<(Entity, &RestPosition, &Corners)>().iter(world) {
        columns.push(column(entity, "rest_position", size_of_val(rest.0.as_slice()) as u64));
        let map = size_of_val(corners.starts.as_slice()) + size_of_val(corners.corners.as_slice());
        columns.push(column(entity, "corners", map as u64));
    }
    for (entity, patches) in world.query::<(Entity, &Patches)>().iter(world) {
        let nodes = size_of_val(patches.starts.as_slice()) + size_of_val(patches.nodes.as_slice());
        let bytes = nodes + size_of_val(patches.connectivity.as_slice());
        columns.push(column(entity, "patches", bytes as u64));
    }
    columns.sort_by(|a, b| a.of.cmp(&b.of).then(b.bytes.cmp(&a.bytes)).then(a.name.cmp(&b.name)));
    columns
}

/// Counts what kernels bind instead of making it.
pub struct Counter<'a> {
    sizes: &'a Sizes,
    columns: BTreeMap<(Entity, &'static str), BufferId>,
    /// What the device allows, if there is one.
    limits: Option<GpuLimits>,
    composer: Composer,
    /// All buffers; the place is the id.
    pub buffers: Vec<Buffer>,
}

impl<'a> Counter<'a> {
    /// Nothing counted yet.
    pub fn new(sizes: &'a Sizes, limits: Option<GpuLimits>) -> Self {
        Self { sizes, columns: BTreeMap::new(), limits, composer: Composer::default(), buffers: Vec::new() }
    }

    /// The buffer of an id.
    pub fn get(&self, id: BufferId) -> Option<&Buffer> {
        self.buffers.get(id.0 as usize)
    }

    fn add(&mut self, of: String, name: String, kind: &'static str, bytes: u64) -> BufferId {
        self.buffers.push(Buffer { of, name, kind, bytes });
        BufferId(self.buffers.len() as u32 - 1)
    }
}

impl Buffers for Counter<'_> {
    fn column(&mut self, entity: Entity, name: &'static str) -> BufferId {
        if let Some(&id) = self.columns.get(&(entity, name)) {
            return id;
        }
        let buffer = all_columns().iter().find(|column| column.name == name).map_or(name, |column| column.buffer);
        let there: Vec<&'static str> = columns_in(buffer).map(|column| column.name).collect();
        let bytes = there.iter().filter_map(|&name| self.sizes.bytes.get(&(entity, name))).sum();
        let id = self.add(self.sizes.name_of(entity), buffer.into(), "column", bytes);
        self.columns.extend(there.into_iter().map(|name| ((entity, name), id)));
        id
    }

    fn compose(&mut self, kernel: &Kernel) -> Result<Arc<Composed>, KernelError> {
        self.composer.compose(kernel)
    }

    fn are_of_device(&self) -> bool {
        false
    }

    fn most_buffers(&self) -> MostBuffers {
        self.limits.map_or(MostBuffers::DESKTOP, |limits| limits.buffers)
    }

    fn workgroup_invocations(&self) -> usize {
        self.limits.map_or(DESKTOP_WORKGROUP, |limits| limits.workgroup_size as usize)
    }

    fn constants(&mut self, label: String, bytes: &[u8]) -> BufferId {
        self.add(String::new(), label, "constants", bytes.len() as u64)
    }

    fn uniform(&mut self, label: String, bytes: &[u8]) -> BufferId {
        self.add(String::new(), label, "uniform", bytes.len() as u64)
    }
}
