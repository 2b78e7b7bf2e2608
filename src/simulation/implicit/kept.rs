//! What a step that is not found leaves as it was.

use crate::components::*;
use bevy_ecs::prelude::*;

/// Columns that the search for a step writes over.
const WRITTEN: [&str; 6] = [
    Displacement::NAME,
    DisplacementIncrement::NAME,
    InternalForce::NAME,
    ExternalForce::NAME,
    ViscousMemory::NAME,
    ToolHold::NAME,
];

/// These columns as they were at the beginning of the step.
#[derive(Default)]
pub(super) struct Kept(Vec<(ColumnAccess, Entity, Vec<u8>)>);

impl Kept {
    /// Keeps them, where they were kept before.
    pub fn keep(&mut self, world: &mut World) {
        if self.0.is_empty() {
            self.0 = find(world);
        }
        for (column, entity, bytes) in &mut self.0 {
            bytes.clear();
            bytes.extend_from_slice((column.bytes)(world, *entity).unwrap_or_default());
        }
    }

    /// Puts those of some names back.
    pub fn put_back(&self, world: &mut World, which: impl Fn(&str) -> bool) {
        for (column, entity, bytes) in self.0.iter().filter(|(column, ..)| which(column.name)) {
            (column.write)(world, *entity, bytes);
        }
    }

    /// Their bytes.
    pub fn bytes(&self) -> usize {
        self.0.iter().map(|(.., bytes)| bytes.len()).sum()
    }

    /// Whether viscous memories are among them.
    pub fn has_memories(&self) -> bool {
        self.0.iter().any(|(column, ..)| column.name == ViscousMemory::NAME)
    }
}

fn find(world: &mut World) -> Vec<(ColumnAccess, Entity, Vec<u8>)> {
    let mut all = world.query_filtered::<Entity, Or<(With<Body>, With<Block>)>>();
    let entities: Vec<Entity> = all.iter(world).collect();
    let columns: Vec<ColumnAccess> =
        all_columns().into_iter().filter(|column| WRITTEN.contains(&column.name)).collect();
    let mut found = Vec::new();
    for &entity in &entities {
        let own = columns.iter().filter(|column| (column.bytes)(world, entity).is_some());
        found.extend(own.map(|&column| (column, entity, Vec::new())));
    }
    found
}
