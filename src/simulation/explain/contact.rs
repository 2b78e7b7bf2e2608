//! What keeps things apart: how much is looked at, and what is held for it.

use super::ContactInUse;
use crate::components::*;
use crate::systems::{SurfaceContacts, find_surfaces};
use bevy_ecs::prelude::*;

/// The systems of contact that a world has.
pub(super) fn in_use(world: &mut World) -> Vec<ContactInUse> {
    let of_tools = [tools(world), free_tools(world), grasps(world), suctions(world)];
    of_tools.into_iter().chain([surfaces(world)]).flatten().collect()
}

fn tools(world: &mut World) -> Option<ContactInUse> {
    let (mut of, mut lists, mut distances) = (Vec::new(), 0, 0);
    for (label, contacts) in world.query::<(&Label, &ToolContacts)>().iter(world) {
        let tools: Vec<&str> = contacts.tools.iter().map(|contact| contact.tool.as_str()).collect();
        of.push(format!("{} nodes of {} may be touched by {}", contacts.rows.len(), label.0, tools.join(", ")));
        lists += size_of_val(&contacts.rows[..]) + size_of_val(&contacts.masks[..]);
        distances += contacts.tools.iter().map(|contact| contact.geometry.bytes()).sum::<usize>();
    }
    let mut found = of_nodes("tool_contact", of, [lists, distances])?;
    found.of.push(
        "each is looked at in every step, in the pass of the nodes; who is outside a ball around a tool costs least"
            .into(),
    );
    Some(found)
}

/// What one system of tools may meet, nodes of each body and tool in a line; nothing of none.
fn of_nodes(system: &str, mut of: Vec<String>, [lists, distances]: [usize; 2]) -> Option<ContactInUse> {
    of.sort();
    let held = vec![("lists of these nodes", lists as u64), ("distances to tools", distances as u64)];
    (!of.is_empty()).then(|| ContactInUse { system: system.into(), of, held, bytes_a_face: 0.0 })
}

fn free_tools(world: &World) -> Option<ContactInUse> {
    let tools = &world.get_resource::<FreeTools>()?.all;
    let (mut of, mut lists) = (Vec::new(), 0);
    for tool in tools {
        for met in &tool.meets {
            of.push(format!("{} nodes of {} may be touched by {}", met.rows.len(), met.name, tool.name));
            lists += size_of_val(&met.rows[..]);
        }
    }
    let distances = tools.iter().map(|tool| tool.geometry.bytes()).sum();
    of_nodes("free_tool", of, [lists, distances])
}

fn grasps(world: &mut World) -> Option<ContactInUse> {
    let (mut of, mut lists, mut distances) = (Vec::new(), 0, 0);
    for (label, grasps) in world.query::<(&Label, &Grasps)>().iter(world) {
        let tools: Vec<&str> = grasps.grasps.iter().map(|grasp| grasp.tool.tool.as_str()).collect();
        of.push(format!("{} nodes of {} may be held by {}", grasps.rows.len(), label.0, tools.join(", ")));
        lists += size_of_val(&grasps.rows[..]) + size_of_val(&grasps.masks[..]);
        distances += grasps.grasps.iter().map(|grasp| grasp.tool.geometry.bytes()).sum::<usize>();
    }
    of_nodes("grasp", of, [lists, distances])
}

fn suctions(world: &mut World) -> Option<ContactInUse> {
    let mut query = world.query::<(&Suction, &OfBody)>();
    let world = &*world;
    let of_body = |(suction, body): (&Suction, &OfBody)| {
        let label = &world.get::<Label>(body.0)?.0;
        Some(format!("{} faces of {label} may be in the mouth of {}", suction.faces.len(), suction.tool))
    };
    let mut of: Vec<String> = query.iter(world).filter_map(of_body).collect();
    of.sort();
    (!of.is_empty()).then(|| ContactInUse { system: "suction_mouth".into(), of, held: Vec::new(), bytes_a_face: 0.0 })
}

fn surfaces(world: &mut World) -> Option<ContactInUse> {
    world.get_resource::<SurfaceContacts>()?;
    // a run finds them in its first step
    find_surfaces(world);
    let contacts = world.get_resource::<SurfaceContacts>()?;
    let (memory, [points, faces]) = (contacts.memory(), contacts.size());
    let columns: usize = contacts.bodies.iter().map(|&body| columns(world, body)).sum();
    let skin = contacts.skin * contacts.edge;
    let sweeps = if contacts.sweeps == 1 { "once".into() } else { format!("{} times", contacts.sweeps) };
    let of = vec![
        format!("{points} points that may meet {faces} faces; forces are corrected {sweeps} in a step"),
        format!(
            "lists of what may be near what hold {} pairs, and are made anew when nodes have come {skin:.3e} m nearer",
            memory.pairs
        ),
        "what steps and lists take is in the summary of a run: `surface_contact`".into(),
    ];
    let held = [
        ("surfaces", memory.surfaces),
        ("trees of boxes", memory.trees),
        ("lists", memory.lists),
        ("what a step finds", memory.step),
    ];
    Some(ContactInUse {
        system: "surface_contact".into(),
        of,
        held: held.map(|(name, bytes)| (name, bytes as u64)).to_vec(),
        bytes_a_face: (memory.total() + columns) as f64 / faces.max(1) as f64,
    })
}

/// Bytes of a body's columns that contact between surfaces alone has.
fn columns(world: &World, body: Entity) -> usize {
    let bytes = |reals: Option<&Reals>| {
        reals.map_or(0, |reals| reals.len() * if reals.precision() == Precision::F32 { 4 } else { 8 })
    };
    let entity = world.entity(body);
    let of_nodes = entity.get::<SurfaceTouch>().map(|of| &of.0);
    let of_faces = entity.get::<FaceTouch>().map(|of| &of.0);
    bytes(entity.get::<ContactForce>().map(|of| &of.0)) + bytes(of_nodes) + bytes(of_faces)
}
