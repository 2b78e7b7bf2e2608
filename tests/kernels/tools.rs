//! `tool_contact`: the same nodes are pushed, and by the same forces.

use super::kernel_worlds::Effects;
use super::pair::{Pair, UNIT, entities, run};
use bevy_ecs::prelude::*;
use glam::{DQuat, DVec3};
use sinew::components::*;
use sinew::mesh::Triangles;
use sinew::tools::{DistanceGrid, Geometry, Shape, Solid};
use std::sync::Arc;

/// A box as triangles.
fn grid() -> Geometry {
    let (points, triangles) = Solid::new(Shape::Box { size: DVec3::splat(0.04) }, 0.0).unwrap().surface(4, 1.0);
    Geometry::Grid(Arc::new(DistanceGrid::new(&Triangles { points, triangles, ..Triangles::default() }, 2e-3).unwrap()))
}

/// Tools that touch about half of a body's nodes; each body meets all of them, each node one or two, or one that is a
/// grid.
fn touch(world: &mut World, (of_grid, several, springs, is_swept): (bool, bool, bool, bool)) {
    for body in entities::<Displacement>(world) {
        let rest = world.get::<RestPosition>(body).unwrap().0.clone();
        let (low, high) =
            (rest.iter().copied().reduce(DVec3::min).unwrap(), rest.iter().copied().reduce(DVec3::max).unwrap());
        let (middle, size) = (0.5 * (low + high), (high - low).length());
        let shapes = [
            Geometry::Analytic(Solid::new(Shape::Plane {}, 0.0).unwrap()),
            Geometry::Analytic(Solid::new(Shape::Sphere { radius: 0.3 * size }, 0.0).unwrap()),
            if of_grid {
                grid()
            } else {
                Geometry::Analytic(Solid::new(Shape::Box { size: DVec3::splat(0.5 * size) }, 0.05 * size).unwrap())
            },
        ];
        let tools = shapes.into_iter().enumerate().map(|(number, geometry)| {
            let turn = DQuat::from_scaled_axis(DVec3::new(0.1, 0.2 * number as f64, 0.3));
            let motion = ToolMotion {
                path: vec![
                    (0.0, middle, turn),
                    (1.0, middle + DVec3::new(1e-2, 2e-2, -1e-2), turn * DQuat::from_rotation_x(0.2)),
                ],
                moves: Vec::new(),
                curves: Vec::new(),
                pivot: None,
                hand: None,
            };
            let signal = world.resource_mut::<Signals>().add(Signal::Pose { motion, reference: middle });
            let spring = springs.then_some(ContactSpring { share: 0.2, damping: 0.3 });
            let swept = if is_swept { 1e-3 * size } else { 0.0 };
            ToolContact { tool: number.to_string(), geometry, signal, friction: [0.4, 0.3], spring, swept }
        });
        let tools: Vec<ToolContact> = tools.collect();
        let rows: Vec<u32> = (0..rest.len() as u32).filter(|row| row % 7 != 3).collect();
        let mask = |row: u32| {
            if of_grid {
                4
            } else if several {
                1 + row % 6
            } else {
                1 << (row % 3)
            }
        };
        let masks = rows.iter().map(|row| mask(*row)).collect();
        // a hand wants the sum of forces, too
        let (edge, felt) = (0.2 * size, several);
        let boxes = ToolContacts::boxes_of(&rows, &rest, middle);
        let contacts = ToolContacts { tools, reference: middle, rows, masks, boxes, edge, settling: 1.0, felt };
        let touch = Reals::from_f64(
            Precision::F32,
            (0..contacts.numbers() * contacts.rows.len()).map(|i| f64::from(u8::from(i % 3 == 0))),
        );
        world.entity_mut(body).insert((contacts, ToolTouch(touch)));
    }
}

/// All combinations of what a tool can be and how nodes move.
#[test]
#[ignore = "long"]
fn tools_of_all_kinds_push_the_same_nodes_with_the_same_forces() {
    push_the_same_nodes(0..32);
}

#[test]
fn tools_push_the_same_nodes_with_the_same_forces() {
    push_the_same_nodes([0, 5, 10, 15, 18, 31]);
}

fn push_the_same_nodes(combinations: impl IntoIterator<Item = u32>) {
    for bits in combinations {
        let (of_grid, several, springs) = (bits & 4 == 4, bits & 8 == 8, bits & 16 == 16);
        // whole ways are looked at where nodes go far enough
        let is_swept = bits & 1 == 1 && !springs;
        let effects = Effects { damping: bits & 1 == 1, moved: bits & 2 == 2, loads: true, ..Effects::default() };
        for step in [0, 3] {
            let Some(mut pair) =
                run("tool_contact", &effects, step, |world| touch(world, (of_grid, several, springs, is_swept)))
            else {
                return;
            };
            // directions that a grid gives are those of differences of distances; what several tools hand on to each
            // other as deep as here has not settled after twelve turns; a node that is held along some axes is pushed
            // along the others, as much farther as its normal leans
            let rounding = match (of_grid || several, effects.moved) {
                (true, _) => 1e-3,
                (false, true) => 1e-4,
                (false, false) => 300.0 * UNIT,
            };
            // the force is to_force times a depth, on whose longest way are some thirty roundings, and some six in each
            // of twelve turns, and three times that for the direction of a short slip, of lengths up to the body's size
            // or to the step itself, whichever is longer
            let bound = |pair: &Pair, body: Entity, node: usize| {
                let world = pair.before();
                let clock = world.resource::<Clock>();
                let mass = world.get::<Mass>(body).unwrap().get(node);
                let factor = clock.time_step * clock.half_step_interval();
                let size = world.get::<ToolContacts>(body).unwrap().edge * 5.0;
                (mass / factor) * size + pair.host().get::<ExternalForce>(body).unwrap().vector(node).length()
            };
            pair.agree::<ExternalForce>(|pair, body, i| rounding * bound(pair, body, i / 3));
            assert!(pair.changed::<ExternalForce>() > 50, "few were touched");
            pair.agree::<ToolTouch>(|pair, body, i| {
                let contacts = pair.before().get::<ToolContacts>(body).unwrap();
                let node = contacts.rows[i / contacts.numbers()] as usize;
                let force = bound(pair, body, node);
                match i % contacts.numbers_a_tool() {
                    0..3 | 7.. => rounding * force,
                    3 => 0.0,
                    _ => 2.0 * rounding * (force * contacts.edge * 5.0 + contacts.edge * 5.0 + 1.0),
                }
            });
        }
    }
}
