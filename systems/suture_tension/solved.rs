//! Threads in implicit steps, whose forces are those at the end of the step that is solved for.

use super::{Drawn, HOLDS, SuturedColumnsReadOnly, draw};
use crate::components::*;
use bevy_ecs::prelude::*;
use glam::DMat3;

/// Finds the threads that are taut where nodes are, in a step whose signals are there. `first_axis` is that of a body.
pub(crate) fn find(world: &mut World, first_axis: impl Fn(Entity) -> Option<usize>, found: &mut Vec<TouchingSpring>) {
    if !world.contains_resource::<Sutures>() {
        return;
    }
    let (mut bodies, mut blocks) = (world.query::<SuturedColumnsReadOnly>(), world.query::<&Alive>());
    let (bodies, blocks) = (bodies.query(world), blocks.query(world));
    let (sutures, signals) = (world.resource::<Sutures>(), world.resource::<Signals>());
    for suture in &sutures.all {
        let [first, second] = &suture.ends;
        let state = bodies.get(first.body).ok().and_then(|columns| columns.state);
        if state.map(|state| state.get(SUTURE_NUMBERS * suture.place)) != Some(HOLDS) {
            continue;
        }
        let Drawn { way, length, tension, left, .. } = draw(suture, (sutures, signals), &bodies, &blocks);
        // what is no number is told by guards, not lost
        if length < suture.slack(signals.values()[suture.signal][0]) || length == 0.0 || left == 0.0 {
            continue;
        }
        let way = way / length;
        let along = DMat3::from_cols(way * way.x, way * way.y, way * way.z);
        let slope = along * (left * suture.stiffness) + (DMat3::IDENTITY - along) * (tension / length);
        let ends = [(first, 1.0), (second, -1.0)];
        let parts = ends.into_iter().filter_map(|(end, sign)| Some((first_axis(end.body)?, end, sign)));
        let parts = parts.flat_map(|(axis, end, sign)| {
            end.nodes.iter().map(move |&(row, weight)| (axis + 3 * row as usize, sign * weight))
        });
        found.push(TouchingSpring { parts: parts.collect(), force: way * tension, slopes: [slope, DMat3::ZERO] });
    }
}
