//! `tool_removal`: the same elements are chosen.

use super::kernel_worlds::Effects;
use super::pair::{UNIT, entities, run};
use bevy_ecs::prelude::*;
use glam::{DQuat, DVec3};
use sinew::components::*;
use sinew::scene::schema::Curve;
use sinew::tools::{Shape, Solid};

/// A disc and a ball in each body, turned and off its middle, that take what is near, by a rate (m³/s) and so many at a
/// time; each element may go but every seventh. They have taken in a volume (m³).
fn tools(world: &mut World, volume: f64, rate: f64, burst: u32) {
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
            let rate = signals.add(Signal::Load { curve: Curve::default(), amplitude: DVec3::X * rate });
            ToolRemoval {
                tool: number.to_string(),
                mouth,
                reach: 0.012,
                pose,
                rate,
                fastest: 0.0,
                threshold: None,
                crumb: 0.0,
                burst,
                largest: 1e-5,
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
    // room for some twenty elements, for none, for all that may go at a time, and for all in reach; tools that are off,
    // by 0 and by a rate below
    for (step, volume, rate, burst, at_least, at_most) in [
        (9, 3e-6, 1e-6, 40, 8, 159),
        (9, 0.0, 1e-6, 40, 0, 0),
        (9, 1.0, 1e-6, 40, 80, 160),
        (10, 3e-6, 1e-6, 40, 0, 0),
        (9, 1.0, 1e-6, 1024, 80, 2000),
        (9, 1.0, 0.0, 40, 0, 0),
        (9, 1.0, -1e3, 40, 0, 0),
    ] {
        let tools = |world: &mut World| tools(world, volume, rate, burst);
        let Some(mut pair) = run("tool_removal", &effects, step, tools) else { return };
        pair.identical::<RemovalStep>();
        let chosen = pair.changed::<RemovalStep>();
        assert!((at_least..=at_most).contains(&chosen), "{chosen} of {volume} m³ at {rate} m³/s in step {step}");
        // a subtraction for each that is chosen, from the whole
        let bound = f64::from(burst) * UNIT * volume.max(1e-6);
        pair.agree::<ToolIntake>(|_, _, i| if i % 2 == 1 { 0.0 } else { bound });
        if burst == 1024 {
            // all in reach has gone, and what is left was no tissue
            for body in entities::<ToolIntake>(pair.device.world_mut()) {
                let intake = pair.device.world().get::<ToolIntake>(body).unwrap();
                assert!([0, 2].iter().all(|&i| intake.get(i) > 9e-6 && intake.get(i) < 1.1e-5), "{intake:?}");
            }
        }
    }
}
