//! Bodies that nothing holds against what acts on them have no rest: where one flies away the search ends.

use super::super::residual::State;
use super::Relaxing;
use crate::components::{Clock, Label, RestPosition};
use crate::error::Error;
use crate::scene::schema::{Scene, Tool};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// How far what comes to rest may go, in lengths of all bodies together, their tools' ways and those of held nodes.
/// What something holds stays within some of them: rubber tears at ten times its length, and pseudo-steps, which begin
/// at rest, go beyond where they end by less than the way there; that is twenty. Five times as many are gone in some
/// hundred pseudo-steps by what nothing holds, and lead no rest astray.
const FAR: f64 = 100.0;

/// How far (m) nodes may go, where none is told to go anywhere.
pub(super) fn far(scene: &Scene, world: &mut World) -> f64 {
    let mut all = world.query::<&RestPosition>();
    let bodies = corners(all.iter(world).flat_map(|rest| rest.0.iter().copied()));
    let tools = || scene.tools.values();
    FAR * (length(bodies) + tools().map(way).sum::<f64>()) + tools().map(|tool| turns(tool, bodies)).sum::<f64>()
}

/// How far a tool goes (m) at most, but for what turns it.
fn way(tool: &Tool) -> f64 {
    let moves = tool.moves.iter().map(|part| {
        let [least, most] = part.curve.range();
        part.displacement.length() * least.abs().max(most.abs())
    });
    length(corners(tool.places().into_iter().map(|place| place.at))) + moves.sum::<f64>()
}

/// How far (m) a tool carries points of a box at most where it turns about its origin: to the other side of it.
fn turns(tool: &Tool, [low, high]: [DVec3; 2]) -> f64 {
    let farthest = |at: DVec3| (at - low).abs().max((high - at).abs()).length();
    2.0 * tool.places().into_iter().map(|place| farthest(place.at)).fold(0.0, f64::max)
}

/// Two corners of the box around points (m).
fn corners(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.fold(none, |[low, high], at| [low.min(at), high.max(at)])
}

/// The diagonal of a box (m).
fn length([low, high]: [DVec3; 2]) -> f64 {
    low.distance(high)
}

impl Relaxing {
    /// Ends the search where a body has gone so far that nothing can hold it.
    pub(super) fn stay_near(&mut self, now: &State, world: &World) -> Result<(), Error> {
        let Some((body, way)) = now.farthest().filter(|(_, way)| way.length() > self.far + FAR * now.told(world))
        else {
            return Ok(());
        };
        let name = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
        let [x, y, z] = way.normalize_or_zero().to_array();
        let told = format!("body {name} flies away along ({x:.2}, {y:.2}, {z:.2}), {:.3e} m so far", way.length());
        self.equilibrium.flies_away = Some(told);
        Err(self.given_up(world.resource::<Clock>().step))
    }
}
