//! `tool_removal`: the same elements are chosen.

use super::kernel_worlds::Effects;
use super::pair::{UNIT, entities, run};
use bevy_ecs::prelude::*;
use glam::{DQuat, DVec3};
use sinew::components::*;
use sinew::scene::schema::Curve;
use sinew::tools::{Shape, Solid};

/// A disc and a ball in each body, turned and off its middle, that take what is near; each element may go but every
/// seventh.
fn tools(world: &mut World, volume: f64) {
    for body in entities::<Displacement>(world) {
        let blocks = world.get::<Authoring>(body).unwrap().blocks.clone();
        let rows = world.get::<Authoring>(body).unwrap().element_rows.clone();
        let mouths = [Mouth::Disc(0.015), Mouth::Tool(Solid::new(Shape::Sphere { radius: 0.01 }, 0.0).unwrap())];
        let all = mouths.into_iter().enumerate().map(|(number, mouth)| {
            let turn = DQuat::from_scaled_axis(DVec3::new(0.1, 0.2 * number as f64, 0.3));
            let at = DVec3::new(0.011, 0.012 - 0.02 * number as f64, 0.013);
            let motion = ToolMotion {
                path: vec![(0.0, at, turn)],
                moves: Vec::new(),
                curves: Vec::new(),
                pivot: None,
                hand: None,
            };
            let mut numbers: Vec<Vec<u32>> =
                blocks.iter().map(|&block| vec![u32::MAX; world.get::<Block>(block).unwrap().count]).collect();
            for (element, &(block, row)) in rows.iter().enumerate().filter(|(element, _)| element % 7 != 3) {
                numbers[block as usize][row as usize] = element as u32;
            }
            let mut signals = world.resource_mut::<Signals>();
            let pose = signals.add(Signal::Pose { motion, reference: DVec3::ZERO });
            let rate = signals.add(Signal::Load { curve: Curve::default(), amplitude: DVec3::X * 1e-6 });
            ToolRemoval {
                tool: number.to_string(),
                mouth,
                reach: 0.012,
                pose,
                rate,
                threshold: None,
                crumb: 0.0,
                burst: 40,
                numbers,
            }
        });
        let removals = ToolRemovals { all: all.collect(), reference: DVec3::ZERO };
        let intake = Reals::F32(vec![volume as f32, 1.0, volume as f32, 0.0]);
        let list = vec![0; removals.words(rows.len())];
        world.entity_mut(body).insert((removals, ToolIntake(intake), ToolReach(list)));
    }
}

#[test]
fn tools_choose_the_same_elements() {
    let effects = Effects { removal: true, ..Effects::default() };
    // room for some twenty elements, for none, and for all that may go at a time
    for (step, volume, at_least, at_most) in [(9, 3e-6, 8, 159), (9, 0.0, 0, 0), (9, 1.0, 80, 160), (10, 3e-6, 0, 0)] {
        let Some(mut pair) = run("tool_removal", &effects, step, |world| tools(world, volume)) else { return };
        pair.identical::<RemovalStep>();
        let chosen = pair.changed::<RemovalStep>();
        assert!((at_least..=at_most).contains(&chosen), "{chosen} of {volume} m³ in step {step}");
        // a subtraction for each that is chosen, from the whole
        pair.agree::<ToolIntake>(|_, _, i| if i % 2 == 1 { 0.0 } else { 40.0 * UNIT * volume.max(1e-6) });
    }
}
