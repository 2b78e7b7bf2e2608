//! Which columns make up a simulation's state, and how they get into a snapshot and out of it.

use crate::components::*;
use bevy_ecs::prelude::*;

/// Where a column belongs: a body by its name, or one of its blocks by its place in the body's list.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(deny_unknown_fields)]
pub struct ColumnOwner {
    /// The body's name.
    pub body: String,
    /// The block's place in the body's list; none: the body itself.
    pub block: Option<u32>,
}

/// All bodies by name, each with its blocks.
pub fn places(world: &mut World) -> Vec<(ColumnOwner, Entity)> {
    let mut bodies: Vec<(Label, Entity, Vec<Entity>)> = world
        .query::<(&Label, Entity, &Authoring)>()
        .iter(world)
        .map(|(label, entity, authoring)| (label.clone(), entity, authoring.blocks.clone()))
        .collect();
    bodies.sort();
    let of_body = |(label, entity, blocks): (Label, Entity, Vec<Entity>)| {
        let place = move |block| ColumnOwner { body: label.0.clone(), block };
        let itself = (place(None), entity);
        std::iter::once(itself).chain(blocks.into_iter().enumerate().map(move |(i, e)| (place(Some(i as u32)), e)))
    };
    bodies.into_iter().flat_map(of_body).collect()
}

/// A column that belongs to the state.
pub struct StateColumn {
    /// Where it belongs.
    pub place: ColumnOwner,
    /// The entity there.
    pub entity: Entity,
    /// Access to it.
    pub access: ColumnAccess,
}

/// The columns of a world's state in a fixed order: all whose [`Role`] says so. `further`: columns that custom systems
/// write.
pub fn state_columns(world: &mut World, further: &[&'static str]) -> Vec<StateColumn> {
    let accesses = all_columns();
    let mut columns = Vec::new();
    for (place, entity) in places(world) {
        // elements that are taken away are so in their rest shapes
        let removes = world.get::<Alive>(entity).is_some();
        let belongs = |access: &&ColumnAccess| match access.role {
            Role::State => true,
            Role::Given => further.contains(&access.name) || removes && access.name == RestShape::NAME,
            Role::Structure | Role::Scratch => false,
        };
        for access in accesses.iter().filter(belongs) {
            if (access.bytes)(world, entity).is_some() {
                columns.push(StateColumn { place: place.clone(), entity, access: *access });
            }
        }
    }
    columns
}

/// Faces of removed elements bear no load: the marks of faces follow from the elements'. What tools suck is in columns,
/// too.
pub fn update_faces(world: &mut World) {
    let suctions: Vec<(Entity, Entity)> =
        world.query::<(Entity, &OfBody, &Suction)>().iter(world).map(|(entity, body, _)| (entity, body.0)).collect();
    for (suction, body) in suctions {
        let columns = (world.get::<SuctionMarks>(body).cloned(), world.get::<SuctionPressure>(body).cloned());
        if let ((Some(marks), Some(pressure)), Some(mut suction)) = (columns, world.get_mut::<Suction>(suction)) {
            suction.renew(&marks, &pressure);
        }
    }
    let mut loads = world.query::<(&SceneLoad, &OfBody)>();
    for (load, body) in loads.iter(world) {
        let (Some(faces), Some(authoring)) = (load.on.faces(), world.get::<Authoring>(body.0)) else { continue };
        faces.mark(|(block, row)| {
            let alive = world.get::<Alive>(*authoring.blocks.get(block as usize)?)?;
            Some(alive[row as usize])
        });
    }
}
