//! What a step that is not found leaves as it was.

use super::super::step_change::keep_memories;
use super::axes::Axes;
use super::bonds::may_let_go;
use super::forces_before::ForcesBefore;
use crate::components::*;
use bevy_ecs::prelude::*;

/// Whether the search for a step writes over a column beside those of forces; what rounding leaves out is written when
/// one is taken, and what moves is in the [`Motion`](super::axes::Motion) that it begins with.
fn is_tried(column: &ColumnAccess) -> bool {
    let subjects = [Subject::Memory, Subject::Grip];
    column.role == Role::State && subjects.contains(&column.subject)
}

/// Whether the search for rest does, whose motions begin where loads have grown to: what touches carries on there.
fn is_tried_at_rest(column: &ColumnAccess) -> bool {
    let moves = column.role == Role::State && column.subject == Subject::Motion;
    is_tried(column) || moves && column.increments != Increments::SecondHalf || column.subject == Subject::Touch
}

/// Whether forces at the end of a step go on from what a column had at its beginning, and it has another when the step
/// is found. Threads and ties that let go at its end do not hold any more.
fn is_carried_on(column: &ColumnAccess) -> bool {
    let of_attachments = [SutureState::NAME, TieState::NAME].contains(&column.name);
    let subjects = [Subject::Memory, Subject::Touch];
    column.role == Role::State && subjects.contains(&column.subject) && !of_attachments
}

/// These columns as they were at the beginning of the step, and forces.
pub(super) struct Kept {
    pub forces: ForcesBefore,
    columns: Vec<(ColumnAccess, Entity, Vec<u8>)>,
    of_rest: bool,
}

impl Kept {
    /// What the search for a step leaves as it was.
    pub fn new(precision: Precision) -> Self {
        Self { forces: ForcesBefore::new(precision), columns: Vec::new(), of_rest: false }
    }

    /// What a search for rest leaves as it was.
    pub fn of_rest(precision: Precision) -> Self {
        Self { of_rest: true, ..Self::new(precision) }
    }

    /// Keeps them, where they were kept before.
    pub fn keep(&mut self, world: &mut World, axes: &Axes) {
        self.forces.read(world, axes);
        if self.columns.is_empty() {
            let tried: fn(&ColumnAccess) -> bool = if self.of_rest { is_tried_at_rest } else { is_tried };
            // where elements may go, or threads and ties let go, forces are taken once more
            let loses = is_anywhere::<Alive>(world) || may_let_go(world);
            self.columns = find(world, |column| tried(column) || loses && is_carried_on(column));
        }
        for (column, entity, bytes) in &mut self.columns {
            bytes.clear();
            bytes.extend_from_slice((column.bytes)(world, *entity).unwrap_or_default());
        }
    }

    /// Puts all back.
    pub fn put_back(&self, world: &mut World, axes: &Axes) {
        self.forces.put_back(world, axes);
        self.put_columns_back(world, |_| true);
    }

    /// Puts memories back, and keeps them for who looks at stress once the step is taken.
    pub fn put_memories_back(&self, world: &mut World) {
        self.put_columns_back(world, |column| column.subject == Subject::Memory);
        keep_memories(world);
    }

    /// Puts back what forces at the end of the step go on from, and keeps what was there: a second time all is as it
    /// was.
    pub fn exchange_carried_on(&mut self, world: &mut World) {
        for (column, entity, bytes) in self.columns.iter_mut().filter(|(column, ..)| is_carried_on(column)) {
            let now = (column.bytes)(world, *entity).unwrap_or_default().to_vec();
            (column.write)(world, *entity, bytes);
            *bytes = now;
        }
    }

    fn put_columns_back(&self, world: &mut World, which: impl Fn(&ColumnAccess) -> bool) {
        for (column, entity, bytes) in self.columns.iter().filter(|(column, ..)| which(column)) {
            (column.write)(world, *entity, bytes);
        }
    }

    /// Their bytes.
    pub fn bytes(&self) -> usize {
        self.forces.bytes() + self.columns.iter().map(|(.., bytes)| bytes.len()).sum::<usize>()
    }

    /// Whether viscous memories are among them.
    pub fn has_memories(&self) -> bool {
        self.columns.iter().any(|(column, ..)| column.subject == Subject::Memory)
    }
}

fn find(world: &mut World, is_written: impl Fn(&ColumnAccess) -> bool) -> Vec<(ColumnAccess, Entity, Vec<u8>)> {
    let mut all = world.query_filtered::<Entity, Or<(With<Body>, With<Block>)>>();
    let entities: Vec<Entity> = all.iter(world).collect();
    let columns: Vec<ColumnAccess> = all_columns().iter().copied().filter(is_written).collect();
    let mut found = Vec::new();
    for &entity in &entities {
        let own = columns.iter().filter(|column| (column.bytes)(world, entity).is_some());
        found.extend(own.map(|&column| (column, entity, Vec::new())));
    }
    found
}
