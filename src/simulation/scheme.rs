//! How a run sums element forces: as it is told, or as its GPU can.

use crate::backend::patch_lists::pack;
use crate::components::*;
use bevy_ecs::prelude::*;

/// Makes room for the element forces of all bodies, in another scheme than before.
pub(super) fn sum_forces(scheme: Scheme, world: &mut World) {
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<ElementForce>>().iter(world).collect();
    bodies.into_iter().for_each(|body| crate::assembly::insert_forces(scheme, body, world));
}

/// Sums the forces of bodies in two passes whose patches no workgroup can sum. Says of which and why.
pub(super) fn fit_workgroups(world: &mut World) -> String {
    let blocks: Vec<(Entity, String)> = world
        .query::<(&Block, &Patches)>()
        .iter(world)
        .filter_map(|(block, patches)| Some((block.body, pack(block, patches).err()?)))
        .collect();
    let mut said = String::new();
    for (body, reason) in blocks {
        let name = world.get::<Label>(body).map_or_else(String::new, |label| label.0.clone());
        if !said.contains(&format!("of `{name}`")) {
            said += &format!("; forces of `{name}` are summed in two passes: {reason}");
            crate::assembly::insert_forces(Scheme::TwoPass, body, world);
        }
    }
    said
}
