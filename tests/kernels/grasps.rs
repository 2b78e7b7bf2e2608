//! `grasp`: the same nodes are taken along, by the same forces.

use super::kernel_worlds::Effects;
use super::pair::{Pair, UNIT, entities, run};
use bevy_ecs::prelude::*;
use glam::{DQuat, DVec3};
use sinew::components::*;
use sinew::scene::schema::Curve;
use sinew::tools::{Geometry, Shape, Solid};

fn size_of(world: &World, body: Entity) -> (DVec3, f64) {
    let rest = &world.get::<RestPosition>(body).unwrap().0;
    let (low, high) =
        (rest.iter().copied().reduce(DVec3::min).unwrap(), rest.iter().copied().reduce(DVec3::max).unwrap());
    (0.5 * (low + high), (high - low).length())
}

/// Of each body a ball that is closed, one that is open and one from which nodes slip; of their nodes some are held
/// already, some are not, and some have been left behind.
fn hold(world: &mut World, felt: bool) {
    for body in entities::<Displacement>(world) {
        let (middle, size) = size_of(world, body);
        let count = world.get::<RestPosition>(body).unwrap().0.len() as u32;
        let grasps = [(0.0, f64::INFINITY), (2.0, f64::INFINITY), (0.0, 1e-2)].into_iter().enumerate();
        let grasps = grasps.map(|(number, (start, strength))| {
            let turn = DQuat::from_scaled_axis(DVec3::new(0.1, 0.2 * number as f64, 0.3));
            let further = turn * DQuat::from_rotation_x(0.2);
            let motion = ToolMotion {
                path: vec![(0.0, middle, turn), (1.0, middle + DVec3::new(1e-2, 2e-2, -1e-2), further)],
                moves: Vec::new(),
                curves: Vec::new(),
                pivot: None,
                hand: None,
            };
            let mut signals = world.resource_mut::<Signals>();
            let signal = signals.add(Signal::Pose { motion, reference: middle });
            let closed = signals.add(Signal::Factor { curve: Curve::Step { start, end: None } });
            let geometry = Geometry::Analytic(Solid::new(Shape::Sphere { radius: 0.2 * size }, 0.0).unwrap());
            let tool = ToolContact {
                tool: number.to_string(),
                geometry,
                signal,
                friction: [0.0; 2],
                spring: None,
                swept: 0.0,
            };
            let reach = (number == 0).then_some(0.1 * size);
            Grasp { number, tool, closed, reach, strength }
        });
        let grasps: Vec<Grasp> = grasps.collect();
        let rows: Vec<u32> = (0..count).filter(|row| row % 7 != 3).collect();
        let masks: Vec<u32> = rows.iter().map(|row| 1 + row % 7).collect();
        let grasps = Grasps { grasps, reference: middle, rows, masks, felt };
        let numbers = grasps.numbers_a_grasp();
        let mut values = vec![0.0; grasps.numbers() * grasps.rows.len()];
        for (i, of_grasp) in values.chunks_exact_mut(numbers).enumerate() {
            let row = grasps.rows[i / grasps.grasps.len()] as usize;
            let at = world.get::<RestPosition>(body).unwrap().0[row] - middle;
            let state = [0.0, 1.0, 2.0][i % 5 % 3];
            // about where it is, in a frame that is hardly turned
            let place = if state == 0.0 { [0.0; 3] } else { (1.1 * at).to_array() };
            of_grasp[..9].copy_from_slice(&[0.1, -0.2, 0.3, state, 0.5, 0.25, place[0], place[1], place[2]]);
        }
        let hold = Reals::from_f64(Precision::F32, values.into_iter());
        world.entity_mut(body).insert((grasps, ToolHold(hold)));
    }
}

#[test]
fn tools_hold_the_same_nodes_with_the_same_forces() {
    for bits in 0..8 {
        let (damping, moved, felt) = (bits & 1 == 1, bits & 2 == 2, bits & 4 == 4);
        let effects = Effects { damping, moved, loads: true, ..Effects::default() };
        for step in [0, 3] {
            let Some(mut pair) = run("grasp", &effects, step, |world| hold(world, felt)) else { return };
            // the force is to_force times a way that is found in some thirty roundings of lengths up to the body's
            // size, to which the forces of three grasps are added one after the other
            let rounding = 300.0 * UNIT;
            let bound = |pair: &Pair, body: Entity, node: usize| {
                let world = pair.before();
                let clock = world.resource::<Clock>();
                let mass = world.get::<Mass>(body).unwrap().get(node);
                let factor = clock.time_step * clock.half_step_interval();
                let force = pair.host().get::<ExternalForce>(body).unwrap().vector(node).length();
                (mass / factor) * size_of(world, body).1 + force
            };
            pair.agree::<ExternalForce>(|pair, body, i| rounding * bound(pair, body, i / 3));
            assert!(pair.changed::<ExternalForce>() > 50, "few are held");
            pair.agree::<ToolHold>(|pair, body, i| {
                let grasps = pair.before().get::<Grasps>(body).unwrap();
                let node = grasps.rows[i / grasps.numbers()] as usize;
                let (force, size) = (bound(pair, body, node), size_of(pair.before(), body).1);
                match i % grasps.numbers_a_grasp() {
                    0..3 | 9.. => rounding * force,
                    3 => 0.0,
                    6..9 => rounding * size,
                    _ => 2.0 * rounding * (force * size + 1.0),
                }
            });
        }
    }
}
