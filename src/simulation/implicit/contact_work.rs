//! What contact takes in implicit steps, by how far nodes go, as all loads work: in implicit Euler alone that is where
//! the velocity at the end leads.

use super::axes::Axes;
use super::place::Place;
use crate::components::*;
use crate::systems::{count_surface_work, count_tool_work};
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
