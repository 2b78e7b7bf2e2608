//! What systems touch, as columns.

use crate::components::all_columns;
use bevy_ecs::component::ComponentId;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemAccess;

/// The columns that a system reads and writes, by its own access set.
pub(super) fn columns_of(access: &SystemAccess, world: &World) -> (Vec<&'static str>, Vec<&'static str>) {
    let names = |touched: fn(&SystemAccess, ComponentId) -> bool| {
        let columns = all_columns().into_iter();
        columns.filter(|c| (c.id)(world).is_some_and(|id| touched(access, id))).map(|c| c.name).collect()
    };
    (names(reads), names(writes))
}

/// Whether a system reads a component; an exclusive one may touch everything.
fn reads(access: &SystemAccess, id: ComponentId) -> bool {
    match access {
        SystemAccess::None => false,
        SystemAccess::Shared(set) => set.combined_access().has_read(id),
        SystemAccess::Exclusive => true,
    }
}

/// Whether it writes one.
pub(super) fn writes(access: &SystemAccess, id: ComponentId) -> bool {
    match access {
        SystemAccess::None => false,
        SystemAccess::Shared(set) => set.combined_access().has_write(id),
        SystemAccess::Exclusive => true,
    }
}
