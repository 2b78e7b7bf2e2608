//! How far elements are squeezed: that raises their frequencies.

use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::components::*;
use crate::elements::node_count;
use crate::math::lane_place;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// The least ratio of distances, deformed over at rest, between two corners of an element; at most 1. About the least
/// principal stretch, by whose inverse the highest frequency of an element grows.
pub(super) fn least_stretch(world: &mut World) -> f64 {
    let blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.iter().filter_map(|&block| of_block(world, block)).fold(1.0, f64::min)
}

fn of_block(world: &World, entity: Entity) -> Option<f64> {
    let (block, connectivity) = (world.get::<Block>(entity)?, world.get::<Connectivity>(entity)?);
    let (rest, u) = (world.get::<RestPosition>(block.body)?, world.get::<Displacement>(block.body)?);
    let nodes = node_count(block.kind);
    let element = |row: usize| {
        let mut corners = [(DVec3::ZERO, DVec3::ZERO); crate::elements::MOST_NODES];
        for (a, corner) in corners[..nodes].iter_mut().enumerate() {
            let node = connectivity[lane_place(row, nodes, a)] as usize;
            *corner = (rest.0[node], rest.0[node] + u.vector(node));
        }
        let ratio = |a: usize, b: usize| {
            let apart = |i: fn(&(DVec3, DVec3)) -> DVec3| i(&corners[a]).distance_squared(i(&corners[b]));
            apart(|corner| corner.1) / apart(|corner| corner.0)
        };
        (1..nodes).flat_map(|a| (0..a).map(move |b| (a, b))).map(|(a, b)| ratio(a, b)).fold(1.0, f64::min)
    };
    let task =
        |task: usize| (task * ROWS_A_TASK..block.count.min((task + 1) * ROWS_A_TASK)).map(element).fold(1.0, f64::min);
    let least = world.resource::<Cpu>().map(block.count.div_ceil(ROWS_A_TASK), task).into_iter().fold(1.0, f64::min);
    Some(least.sqrt())
}
