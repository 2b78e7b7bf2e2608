//! `suction_mouth` and `suction`: the same faces are sucked, and by the same forces.

use super::kernel_worlds::Effects;
use super::pair::{UNIT, entities, run};
use bevy_ecs::prelude::*;
use sinew::components::*;

/// Every third element of each block gone.
fn remove_some(world: &mut World) {
    for block in entities::<Alive>(world) {
        let mut alive = world.get_mut::<Alive>(block).unwrap();
        alive.iter_mut().step_by(3).for_each(|alive| *alive = 0);
    }
}

/// How many faces a body has.
fn faces(world: &mut World, body: Entity) -> usize {
    let mut all = world.query::<(&Suction, &OfBody)>();
    all.iter(world).find(|(_, of)| of.0 == body).map(|(suction, _)| suction.faces.len()).unwrap()
}

#[test]
fn mouths_mark_the_same_faces() {
    for (removal, step) in [(false, 0), (true, 10), (true, 3)] {
        let effects = Effects { sucks: true, removal, ..Effects::default() };
        let Some(mut pair) = run("suction_mouth", &effects, step, remove_some) else { return };
        let mut shares = 0;
        for body in entities::<SuctionMarks>(pair.host.world_mut()) {
            let count = faces(pair.host.world_mut(), body);
            let [host, device] = [&pair.host, &pair.device].map(|of| of.world().get::<SuctionMarks>(body).unwrap());
            let words = host.len() / 2;
            for (i, (&a, &b)) in host.iter().zip(device.iter()).enumerate() {
                // of nodes they are marks
                if i % words >= count {
                    assert_eq!(a, b, "node {i} of {body}");
                    continue;
                }
                // areas of faces and parts of them are sums over four sides of triangles with the middle of the mouth,
                // which are up to twelve times as large as a face, with a rounding of two units each, and their ratio
                let difference = (share(a) - share(b)).abs();
                assert!(difference <= 200.0 * UNIT, "face {i} of {body}: {} and {}", share(a), share(b));
                shares += usize::from(share(a) > 0.0 && share(a) < 1.0);
            }
        }
        assert_eq!(shares > 40, step != 3, "{shares} faces at the edge of a mouth in step {step}");
        // a sum over some hundred faces
        pair.agree::<SuctionPressure>(|_, _, i| if i % 2 == 0 { 90.0 * 1e3 * UNIT } else { 1e3 * UNIT });
    }
}

#[test]
fn what_is_sucked_feels_the_same() {
    for removal in [false, true] {
        let effects = Effects { sucks: true, removal, ..Effects::default() };
        let change = |world: &mut World| {
            for body in entities::<SuctionMarks>(world) {
                let count = faces(world, body);
                let mut marks = world.get_mut::<SuctionMarks>(body).unwrap();
                let words = marks.len() / 2;
                for (i, mark) in marks.iter_mut().enumerate() {
                    let share: f32 = if (i % words).is_multiple_of(3) { 0.75 } else { 0.0 };
                    *mark = if i % words < count { share.to_bits() } else { 1 };
                }
                world.get_mut::<SuctionPressure>(body).unwrap().set(0, 120.0);
            }
            for suction in entities::<Suction>(world) {
                let body = world.get::<OfBody>(suction).unwrap().0;
                let (marks, pressure) = (
                    world.get::<SuctionMarks>(body).unwrap().clone(),
                    world.get::<SuctionPressure>(body).unwrap().clone(),
                );
                world.get_mut::<Suction>(suction).unwrap().renew(&marks, &pressure);
            }
        };
        let Some(mut pair) = run("suction", &effects, 3, change) else { return };
        // as of a pressure in loads.rs, with inner faces up to seventy
        pair.agree::<ExternalForce>(|_, _, _| 240.0 * UNIT * 0.06);
        assert!(pair.changed::<ExternalForce>() > 20);
    }
}
