//! `gather` and what adds to the external forces.

use super::kernel_worlds::Effects;
use super::pair::{UNIT, entities, run};
use bevy_ecs::prelude::*;
use sinew::components::*;
use sinew::glam::DVec3;
use sinew::systems::NodalForce;

#[test]
fn nodes_gather_the_same_bits() {
    for loads in [false, true] {
        let effects = Effects { loads, ..Effects::default() };
        let Some(mut pair) = run("gather", &effects, 3, |_| {}) else { return };
        pair.identical::<InternalForce>();
        pair.identical::<ExternalForce>();
        assert!(pair.changed::<InternalForce>() > 1000);
    }
}

#[test]
fn loads_add_the_same_forces() {
    for (removal, copies) in [(false, false), (true, false), (false, true)] {
        // with removal: some elements behind the faces are gone
        let effects = Effects { loads: true, removal, copies, ..Effects::default() };
        for (system, factors) in [("gravity", 2.0), ("nodal_force", 3.0), ("pressure", 60.0), ("traction", 20.0)] {
            let Some(mut pair) = run(system, &effects, 3, remove_some) else { return };
            // 0.01 N were there; a load on a node adds less than 0.05 N, of a pressure by products of edges and sums of
            // up to eight faces
            let largest = 0.06;
            pair.agree::<ExternalForce>(|_, _, _| factors * UNIT * largest);
            assert!(pair.changed::<ExternalForce>() > 20, "{system}");
        }
    }
}

/// A loaded node without mass, and every third element of each block gone, also in what loads know of their faces.
fn remove_some(world: &mut World) {
    for load in entities::<NodalForce>(world) {
        let (row, body) = (world.get::<NodalForce>(load).unwrap().on.rows[1], world.get::<OfBody>(load).unwrap().0);
        world.get_mut::<Mass>(body).unwrap().set(row as usize, 0.0);
    }
    for block in entities::<Alive>(world) {
        let mut alive = world.get_mut::<Alive>(block).unwrap();
        alive.iter_mut().step_by(3).for_each(|alive| *alive = 0);
    }
    let removed = |world: &World, body: Entity, (place, row): (u32, u32)| {
        let block = world.get::<Authoring>(body).unwrap().blocks[place as usize];
        world.get::<Alive>(block).map_or(1, |alive| alive[row as usize])
    };
    for load in entities::<SceneLoad>(world) {
        let body = world.get::<OfBody>(load).unwrap().0;
        if let Some(faces) = world.get::<SceneLoad>(load).unwrap().on.faces() {
            faces.mark(|element| Some(removed(world, body, element)));
        }
    }
}

/// Held nodes of each body, one of them twice, one without mass, some pulled with all that their hand has, some lighter
/// than when they were grabbed.
#[test]
fn held_nodes_are_pulled_alike() {
    let hold = |world: &mut World| {
        for grabs in entities::<Grabs>(world) {
            let body = world.get::<OfBody>(grabs).unwrap().0;
            let rows = world.get::<Mass>(body).unwrap().len() as u32;
            let masses = world.get::<Mass>(body).unwrap().clone();
            let held = |number: u32| HeldNode {
                row: (number / 2) * 5 % rows,
                stiffness: 2.0 + f64::from(number),
                damping: 1e-3 * f64::from(number % 4),
                // to half the spring and half the damper
                stiffness_over_mass: match number % 5 {
                    0 => 0.5 * (2.0 + f64::from(number)) / masses.get(((number / 2) * 5 % rows) as usize),
                    _ => f64::INFINITY,
                },
                damping_over_mass: match number % 5 {
                    1 => 5e-4 * f64::from(number % 4) / masses.get(((number / 2) * 5 % rows) as usize),
                    _ => f64::INFINITY,
                },
                most: if number.is_multiple_of(3) { 0.01 } else { f64::INFINITY },
                goal: DVec3::new(0.001, -0.002, 0.0005 * f64::from(number)),
            };
            let mut all: Vec<HeldNode> = (0..30).map(held).collect();
            all.sort_by_key(|held| held.row);
            world.get_mut::<Mass>(body).unwrap().set(all[4].row as usize, 0.0);
            world.get_mut::<Grabs>(grabs).unwrap().held = all;
        }
    };
    let effects = Effects { grabs: true, ..Effects::default() };
    let Some(mut pair) = run("grab", &effects, 3, hold) else { return };
    // k = 31 N/m at a difference of two lengths below 0.02 m, velocities likewise, and two of them in a sum: some ten
    // roundings of numbers below 2 N
    pair.agree::<ExternalForce>(|_, _, _| 10.0 * UNIT * 2.0);
    let changed = pair.changed::<ExternalForce>();
    assert!((60..=90).contains(&changed), "{changed} numbers");
}
