//! How often it is looked at what tools take and suck.

use super::Assembly;
use super::contacts::motion;
use crate::components::*;
use crate::systems::criterion_steps;
use bevy_ecs::prelude::*;

/// From one look to the next a mouth goes no farther than this part of how far it reaches, as far as the scene tells.
pub(super) const FARTHEST: f64 = 0.5;

/// Chooses it by the fastest mouth: as often as criteria are looked at, oftener where a mouth would leave gaps, in
/// every step at most. In a static analysis all goes by and by.
pub(super) fn insert(assembly: &Assembly<'_>, world: &mut World) {
    let clock = *world.resource::<Clock>();
    let steps = |(way, speed): (f64, f64)| way / (speed * clock.time_step);
    let most = criterion_steps(&clock) as f64;
    let fewest = match clock.relaxation {
        None => mouths(assembly, world).into_iter().map(steps).fold(most, f64::min),
        Some(_) => most,
    };
    world.insert_resource(ToolLooks(fewest.max(1.0) as u64));
}

/// The time (s) that it takes the quickest mouth to go as far as it should from one look to the next: where that is ten
/// steps, or one in implicit ones, and more, they are as often as criteria are looked at.
pub(super) fn quickest(assembly: &Assembly<'_>, world: &mut World) -> f64 {
    mouths(assembly, world).into_iter().map(|(way, speed)| way / speed).fold(f64::INFINITY, f64::min)
}

/// Of each mouth how far it should go from one look to the next (m), and how fast it goes (m/s), at most.
fn mouths(assembly: &Assembly<'_>, world: &mut World) -> Vec<(f64, f64)> {
    let scene = &assembly.scene.scene;
    let of_removal = |removal: &ToolRemoval| (removal.tool.clone(), reach_of(removal));
    let of_suction = |suction: &Suction| (suction.tool.clone(), (0.0, suction.reach.min(suction.bore)));
    let mut mouths: Vec<(String, (f64, f64))> = world.query::<&Suction>().iter(world).map(of_suction).collect();
    let mut removals = world.query::<&ToolRemovals>();
    mouths.extend(removals.iter(world).flat_map(|removals| &removals.all).map(of_removal));
    let goes = |(tool, (arm, reach)): &(String, (f64, f64))| {
        let speed = motion(scene.tools.get(tool)?).fastest(*arm);
        Some((FARTHEST * reach, speed))
    };
    mouths.iter().filter_map(goes).collect()
}

/// How far the middle of what takes elements is from the tool's origin, and how far from there it takes them at least
/// (both m). A disc is about the origin.
pub(super) fn reach_of(removal: &ToolRemoval) -> (f64, f64) {
    let (arm, inside) = match &removal.mouth {
        Mouth::Disc(_) => (0.0, 0.0),
        Mouth::Tool(solid) => {
            solid.bounding_sphere().map_or((0.0, 0.0), |(middle, _)| (middle.length(), -solid.distance(middle).0))
        }
    };
    (arm, removal.reach + inside.max(0.0))
}
