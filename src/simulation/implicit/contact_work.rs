//! What contact takes in implicit steps, by how far nodes go, as all loads work: in implicit Euler alone that is where
//! the velocity at the end leads; and whether friction has a part in it.

use super::axes::Axes;
use super::place::Place;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::systems::{SurfaceContacts, count_surface_work, count_tool_work};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What touched nodes at the end of the last step: [`ContactForce`] and [`ToolTouch`] of bodies.
pub(super) struct TouchedBefore {
    by_surfaces: Vec<(Entity, Reals)>,
    by_tools: Vec<(Entity, Reals)>,
}

impl TouchedBefore {
    /// As columns have it until forces at the end of this step are noted.
    pub fn read(world: &mut World) -> Self {
        let mut forces = world.query::<(Entity, &ContactForce)>();
        let by_surfaces = forces.iter(world).map(|(body, force)| (body, force.0.clone())).collect();
        let mut touches = world.query::<(Entity, &ToolTouch)>();
        let by_tools = touches.iter(world).map(|(body, touch)| (body, touch.0.clone())).collect();
        Self { by_surfaces, by_tools }
    }

    /// Counts the work of a step, once its forces are noted.
    pub fn count_work(&self, world: &mut World, axes: &Axes, place: &Place<'_>) {
        let first_axis = |body| axes.each().find(|(other, _)| *other == body).map(|(_, range)| range.start);
        let moved = |first: usize| DVec3::from_array([0, 1, 2].map(|i| place.moved(first + i)));
        count_surface_work(world, &self.by_surfaces, first_axis, moved);
        count_tool_work(world, &self.by_tools, first_axis, moved);
    }
}

/// Whether something touches that friction may hold, in the last step that was taken.
pub(super) fn rubs(world: &mut World) -> bool {
    let wanted = [SurfaceTouch::NAME, FaceTouch::NAME, ToolTouch::NAME];
    // who cannot look says nothing
    if bring_to_host(world, |_, name| wanted.contains(&name)).is_err() {
        return false;
    }
    let has_friction = |[sticking, sliding]: [f64; 2]| sticking.max(sliding) > 0.0;
    let any = |of: &Reals, number: usize, stride: usize, touches: fn(f64) -> bool| {
        (number..of.len()).step_by(stride).any(|at| touches(of.get(at)))
    };
    for (contacts, touch) in world.query::<(&ToolContacts, &ToolTouch)>().iter(world) {
        let (count, numbers) = (contacts.tools.len(), contacts.numbers_a_tool());
        let mut rough = contacts.tools.iter().enumerate().filter(|(_, contact)| has_friction(contact.friction));
        if rough.any(|(tool, _)| any(&touch.0, numbers * tool + 3, numbers * count, |state| state >= 1.0)) {
            return true;
        }
    }
    let are_rough =
        |contacts: &SurfaceContacts| contacts.meetings.iter().flatten().any(|meeting| has_friction(meeting.friction));
    let mut touches = world.query::<(&SurfaceTouch, Option<&FaceTouch>)>();
    let touch = |(of_nodes, of_faces): (&SurfaceTouch, Option<&FaceTouch>)| {
        let touched = |number| PointState::of(number).touched();
        any(&of_nodes.0, 4, MEETING_NUMBERS, touched)
            || of_faces.is_some_and(|of_faces| any(&of_faces.0, 4, MEETING_NUMBERS, touched))
    };
    world.get_resource::<SurfaceContacts>().is_some_and(are_rough) && touches.iter(world).any(touch)
}
