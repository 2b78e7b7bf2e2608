//! `gather` and what adds to the external forces.

use super::kernel_worlds::Effects;
use super::pair::{UNIT, entities, run};
use bevy_ecs::prelude::*;
use sinew::components::*;

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
        let (row, body) = (world.get::<NodalForce>(load).unwrap().rows[1], world.get::<OfBody>(load).unwrap().0);
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
    for load in entities::<OfBody>(world) {
        let body = world.get::<OfBody>(load).unwrap().0;
        if let Some(faces) = world.get::<Pressure>(load).map(|p| p.faces.elements.clone()) {
            let alive = faces.iter().map(|&e| removed(world, body, e)).collect();
            world.get_mut::<Pressure>(load).unwrap().faces.alive = alive;
        }
        if let Some(faces) = world.get::<Traction>(load).map(|t| t.faces.elements.clone()) {
            let alive = faces.iter().map(|&e| removed(world, body, e)).collect();
            world.get_mut::<Traction>(load).unwrap().faces.alive = alive;
        }
    }
}
