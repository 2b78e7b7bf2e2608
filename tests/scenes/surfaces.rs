//! The scenes whose bodies meet.

use super::{near, reference, scene};
use sinew::Simulation;

#[test]
fn the_table_bears_the_whole_stack_and_each_block_those_above_it() {
    let sets = ["low", "middle", "high"].map(|body| format!("bodies.{body}.mesh.cells=(4, 4, 4)"));
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let mut simulation = Simulation::new(&scene("stacked_blocks", &sets), &reference()).unwrap();
    simulation.finish().unwrap();
    let weight = 1050.0 * 8e-6 * 9.81;
    assert!(near(-simulation.tool("table").unwrap().force.z, 3.0 * weight, 1e-2));
    let [low, middle, high] = ["low", "middle", "high"].map(|body| simulation.contact(body).unwrap());
    assert!(near(high.force.z, weight, 1e-2), "{high:?}");
    assert!(near(middle.force.z, weight, 1e-2), "two above its foot, one on its head: {middle:?}");
    assert!(near(-low.force.z, 2.0 * weight, 1e-2), "{low:?}");
    assert!((low.force + middle.force + high.force).length() < 1e-9 * weight);
    // a twentieth of an edge
    for reading in [low, middle, high] {
        assert!(reading.points > 3 && reading.penetration < 2.5e-4, "{reading:?}");
    }
    // it takes of who comes down what others are pressed with, and keeps some
    assert!(high.loss.unwrap() > 0.0 && low.loss.unwrap() < 0.0, "{high:?}, {low:?}");
    assert!([low, middle, high].iter().map(|reading| reading.loss.unwrap()).sum::<f64>() > 0.0);
}

#[test]
fn the_strip_lies_on_itself_and_does_not_pass() {
    let sets = ["bodies.strip.mesh.cells=(32, 4, 2)"];
    let mut simulation = Simulation::new(&scene("folded_strip", &sets), &reference()).unwrap();
    simulation.finish().unwrap();
    let reading = simulation.contact("strip").unwrap();
    // a tenth of an edge
    assert!(reading.points > 10 && reading.penetration < 2e-4, "{reading:?}");
    assert!(reading.force.length() < 1e-12, "what it does to itself is nothing in sum: {reading:?}");
    // the lower side of what was carried over is above the upper side of what stayed
    let rest = simulation.rest_positions("strip").unwrap();
    let u = simulation.displacements("strip").unwrap();
    let places: Vec<_> = rest.iter().zip(&u).map(|(place, u)| (*place, *place + *u)).collect();
    let over = places.iter().filter(|(rest, _)| rest.x > 0.045 && rest.z > 0.0029);
    for (_, above) in over {
        let below = places.iter().filter(|(rest, now)| {
            rest.x < 0.025 && rest.z > 0.0029 && (now.truncate() - above.truncate()).length() < 1.5e-3
        });
        let highest = below.map(|(_, now)| now.z).fold(f64::NEG_INFINITY, f64::max);
        assert!(above.z > highest - 4e-4, "{above} and {highest}");
    }
}
