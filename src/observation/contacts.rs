//! What bodies feel where they touch others, themselves and tools.

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What a body feels where its surface touches others or itself, in the step that has just been taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ContactReading {
    /// The force on it (N); what it does to itself is 0 in sum.
    pub force: DVec3,
    /// How many of its nodes touch faces.
    pub nodes: usize,
    /// How deep the deepest of these is inside (m); 0 where none is.
    pub penetration: f64,
    /// What impact and friction at these nodes have taken since the start (J).
    pub loss: f64,
}

/// What a body feels; `None` of one that may not meet others or itself.
///
/// # Errors
/// What the GPU says.
pub fn read_contact(world: &mut World, body: Entity) -> Result<Option<ContactReading>, Error> {
    bring_to_host(world, |_, name| [ContactForce::NAME, SurfaceTouch::NAME].contains(&name))?;
    let (Some(force), Some(touch)) = (world.get::<ContactForce>(body), world.get::<SurfaceTouch>(body)) else {
        return Ok(None);
    };
    let mut reading = ContactReading { force: force.vectors().sum(), ..ContactReading::default() };
    for first in (0..touch.len()).step_by(MEETING_NUMBERS) {
        if touch.get(first + 4) > 1.0 {
            reading.nodes += 1;
            reading.penetration = reading.penetration.max(-touch.get(first + 5));
        }
        reading.loss += touch.get(first + 7);
    }
    Ok(Some(reading))
}

/// What touches each node of a body (N), in the author's order: other bodies, itself, tools.
///
/// # Errors
/// What the GPU says.
pub(super) fn contact_forces(body: Entity, world: &mut World) -> Result<Vec<DVec3>, Error> {
    bring_to_host(world, |_, name| [ContactForce::NAME, ToolTouch::NAME, ToolHold::NAME].contains(&name))?;
    let entity = world.entity(body);
    let Some(authoring) = entity.get::<Authoring>() else { return Ok(Vec::new()) };
    let count = authoring.node_rows.len();
    let mut forces = match entity.get::<ContactForce>() {
        Some(forces) => forces.vectors().collect(),
        None => vec![DVec3::ZERO; count],
    };
    if let (Some(contacts), Some(touch)) = (entity.get::<ToolContacts>(), entity.get::<ToolTouch>()) {
        for (place, &row) in contacts.rows.iter().enumerate() {
            let first = contacts.numbers() * place;
            let of_tool = |tool: usize| touch.vector_at(first + contacts.numbers_a_tool() * tool);
            forces[row as usize] += (0..contacts.tools.len()).map(of_tool).sum::<DVec3>();
        }
    }
    super::grasps::forces(entity, &mut forces);
    super::free_tools::add_forces(world, body, &mut forces);
    Ok(authoring.node_rows.iter().map(|&row| forces[row as usize]).collect())
}

/// The same over the area of the surface around each node as it is (Pa): a third of its triangles, a quarter of its
/// quadrilaterals.
///
/// # Errors
/// What the GPU says.
pub(super) fn contact_tractions(body: Entity, world: &mut World) -> Result<Vec<DVec3>, Error> {
    let forces = contact_forces(body, world)?;
    bring_to_host(world, |_, name| name == Displacement::NAME || name == Alive::NAME)?;
    let entity = world.entity(body);
    let (Some(authoring), Some(rest), Some(u)) =
        (entity.get::<Authoring>(), entity.get::<RestPosition>(), entity.get::<Displacement>())
    else {
        return Ok(forces);
    };
    let alive = |block: u32, row: u32| {
        let alive = world.get::<Alive>(authoring.blocks[block as usize]);
        alive.is_none_or(|alive| alive[row as usize] == 1)
    };
    let place = |node: u32| {
        let row = authoring.node_rows[node as usize] as usize;
        rest.0[row] + u.vector(row)
    };
    let mut areas = vec![0.0; forces.len()];
    for facet in authoring.surface(alive).iter().flat_map(|face| face.facets()) {
        let [a, b, c, d] = facet.map(place);
        let corners = if facet[2] == facet[3] { 3 } else { 4 };
        // of a triangle, whose last corner is there twice, the second half is nothing
        let area = 0.5 * ((b - a).cross(c - a).length() + (c - a).cross(d - a).length());
        facet[..corners].iter().for_each(|&node| areas[node as usize] += area / corners as f64);
    }
    let over = |(force, area): (DVec3, f64)| if area > 0.0 { force / area } else { DVec3::ZERO };
    Ok(forces.into_iter().zip(areas).map(over).collect())
}
