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

/// What the search for rest writes beside, in the steps in which loads grow: what touches carries on.
const NOTED: [&str; 7] = [
    ToolTouch::NAME,
    ContactForce::NAME,
    SurfaceTouch::NAME,
    FaceTouch::NAME,
    TieState::NAME,
    SutureState::NAME,
    SutureForce::NAME,
];

/// These columns as they were at the beginning of the step.
#[derive(Default)]
pub(super) struct Kept {
    columns: Vec<(ColumnAccess, Entity, Vec<u8>)>,
    of_rest: bool,
}

impl Kept {
    /// What a search for rest leaves as it was.
    pub fn of_rest() -> Self {
        Self { columns: Vec::new(), of_rest: true }
    }

    /// Keeps them, where they were kept before.
    pub fn keep(&mut self, world: &mut World) {
        if self.columns.is_empty() {
            let of_rest = self.of_rest;
            let is_written = |name: &str| WRITTEN.contains(&name) || of_rest && NOTED.contains(&name);
            self.columns = find(world, is_written);
        }
        for (column, entity, bytes) in &mut self.columns {
            bytes.clear();
            bytes.extend_from_slice((column.bytes)(world, *entity).unwrap_or_default());
        }
    }

    /// Puts those of some names back.
    pub fn put_back(&self, world: &mut World, which: impl Fn(&str) -> bool) {
        for (column, entity, bytes) in self.columns.iter().filter(|(column, ..)| which(column.name)) {
            (column.write)(world, *entity, bytes);
        }
    }

    /// Their bytes.
    pub fn bytes(&self) -> usize {
        self.columns.iter().map(|(.., bytes)| bytes.len()).sum()
    }

    /// Whether viscous memories are among them.
    pub fn has_memories(&self) -> bool {
        self.columns.iter().any(|(column, ..)| column.name == ViscousMemory::NAME)
    }
}

fn find(world: &mut World, is_written: impl Fn(&str) -> bool) -> Vec<(ColumnAccess, Entity, Vec<u8>)> {
    let mut all = world.query_filtered::<Entity, Or<(With<Body>, With<Block>)>>();
    let entities: Vec<Entity> = all.iter(world).collect();
    let columns: Vec<ColumnAccess> = all_columns().into_iter().filter(|column| is_written(column.name)).collect();
    let mut found = Vec::new();
    for &entity in &entities {
        let own = columns.iter().filter(|column| (column.bytes)(world, entity).is_some());
        found.extend(own.map(|&column| (column, entity, Vec::new())));
    }
    found
}
