//! Ties in implicit steps, whose forces are among the loads: what these fall by.

use super::HOLDS;
use super::work::STIFF;
use crate::components::*;
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

/// Finds the ties that hold, as springs whose forces are not told. `first_axis` is that of a body.
pub(crate) fn find(world: &World, first_axis: impl Fn(Entity) -> Option<usize>, found: &mut Vec<TouchingSpring>) {
    let (Some(glue), Some(springs)) = (world.get_resource::<Glue>(), world.resource::<Clock>().springs) else { return };
    for tie in &glue.ties {
        let [of, onto] = tie.bodies.map(|body| glue.bodies[body]);
        let holds = world.get::<TieState>(of).is_some_and(|state| state.get(TIE_NUMBERS * tie.place) == HOLDS);
        let is_left = world.get::<Alive>(tie.element.0).is_none_or(|alive| alive[tie.element.1 as usize] == 1);
        let (Some(mass), Some(from), Some(to)) = (world.get::<Mass>(of), first_axis(of), first_axis(onto)) else {
            continue;
        };
        if !holds || !is_left {
            continue;
        }
        let mass: f64 = tie.nodes.iter().map(|&(row, weight)| weight * mass.get(row as usize)).sum();
        let stiffness = mass * STIFF / (springs.step * springs.step);
        let point = tie.nodes.iter().map(|&(row, weight)| (from + 3 * row as usize, weight));
        let face = tie.bearers().map(|(row, weight)| (to + 3 * row as usize, -weight));
        let parts = point.chain(face).collect();
        found.push(TouchingSpring { parts, force: DVec3::ZERO, slopes: [DMat3::IDENTITY * stiffness, DMat3::ZERO] });
    }
}
