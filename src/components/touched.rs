//! What systems touch, as columns.

use super::{ColumnAccess, all_columns};
use bevy_ecs::component::ComponentId;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemAccess;

/// The components that a system touches, by its own access set; an exclusive one may touch everything.
pub struct Touched<'a>(pub &'a SystemAccess);

impl Touched<'_> {
    /// Whether it reads a component.
    pub fn reads(&self, id: ComponentId) -> bool {
        match self.0 {
            SystemAccess::None => false,
            SystemAccess::Shared(set) => set.combined_access().has_read(id),
            SystemAccess::Exclusive => true,
        }
    }

    /// Whether it writes one.
    pub fn writes(&self, id: ComponentId) -> bool {
        match self.0 {
            SystemAccess::None => false,
            SystemAccess::Shared(set) => set.combined_access().has_write(id),
            SystemAccess::Exclusive => true,
        }
    }

    /// The columns that it reads.
    pub fn read_columns(&self, world: &World) -> Vec<ColumnAccess> {
        columns(world, |id| self.reads(id))
    }

    /// The columns that it writes.
    pub fn written_columns(&self, world: &World) -> Vec<ColumnAccess> {
        columns(world, |id| self.writes(id))
    }
}

fn columns(world: &World, touched: impl Fn(ComponentId) -> bool) -> Vec<ColumnAccess> {
    all_columns().iter().copied().filter(|column| (column.id)(world).is_some_and(&touched)).collect()
}
