//! The scene in which a tip sculpts a groove into a block of gel.

use super::cataract::intake;
use super::{near, reference, scene};
use glam::DVec3;
use sinew::Simulation;

const RATE: f64 = 2e-8; // m³/s
const BORE: f64 = 3.5e-4; // m
const REACH: f64 = 4e-4; // m

/// The block (m); the middle of its upper side is at the origin.
const SIZE: DVec3 = DVec3::new(6e-3, 3e-3, 1.5e-3);

/// The middle at rest of each cell (m), in the mesh's order.
fn middles((nx, ny, nz): (usize, usize, usize)) -> impl Iterator<Item = DVec3> {
    let corner = DVec3::new(-0.5 * SIZE.x, -0.5 * SIZE.y, -SIZE.z);
    let cell = SIZE / DVec3::new(nx as f64, ny as f64, nz as f64);
    (0..nx * ny * nz).map(move |number| {
        let (x, y, z) = (number % nx, number / nx % ny, number / (nx * ny));
        corner + cell * (DVec3::new(x as f64, y as f64, z as f64) + DVec3::splat(0.5))
    })
}

/// What is gone is what came in reach of the mouth on its way, and what the rate says of the time in which something
/// was in reach.
///
/// The rate is more than there is in the tip's way, so the way alone says what goes: all cells whose middles come as
/// near as `REACH` to a disc of `BORE`. They may be off by 20 µm: 10 that the tip goes between two looks (10 steps of
/// 48 µs at 20 mm/s, on the coarser mesh) and 10 by which the gel is drawn into the mouth. At the ends of the groove,
/// where the tip goes down, stops and leans on the gel, some in reach are still waiting.
fn sculpts(cells: (usize, usize, usize)) {
    let file = scene("groove", &[&format!("bodies.gel.mesh.cells={cells:?}")]);
    let mut simulation = Simulation::new(&file, &reference()).unwrap();
    let end = file.scene.duration;
    let cell = SIZE.x * SIZE.y * SIZE.z / (cells.0 * cells.1 * cells.2) as f64;
    let (mut time, mut taken, mut was_in_reach) = (0.0, 0.0, false);
    while simulation.time() + 20.0 * simulation.time_step() < end {
        // each look follows one of the tip's
        let step = simulation.step_count();
        simulation.advance(10 - step % 10).unwrap();
        let gone = simulation.probe("hole").unwrap()[0];
        let (waiting, in_reach) = intake(simulation.world_mut());
        let expected = if was_in_reach { RATE * (simulation.time() - time) } else { 0.0 };
        (time, was_in_reach) = (simulation.time(), in_reach);
        let now = gone + waiting;
        assert!((now - taken - expected).abs() < 1e-9 * cell, "at {time} s: {now} m³ after {taken} and {expected}");
        taken = now;
        // no more than a cell waits to go, and no more than a crumb of four is ahead
        assert!(waiting <= cell + 20.0 * RATE * simulation.time_step(), "at {time} s {waiting} m³ wait");
        assert!(waiting >= -4.0 * cell, "at {time} s {waiting} m³ are ahead");
        let tip = simulation.tool("phaco.tip").unwrap();
        // a mouth that is closed sucks by as much, and nothing else is felt in the groove
        let closed = 2e3 * std::f64::consts::PI * BORE * BORE;
        assert!(tip.penetration < 1e-9 && (time > 0.4 || tip.force.length() < closed), "at {time} s: {tip:?}");
    }
    simulation.finish().unwrap();
    let alive = simulation.fields("gel").unwrap().alive;
    let way = sinew::assembly::motion(&file.scene.tools["phaco.tip"]);
    let poses: Vec<_> = (0..=2000).map(|part| way.pose(end * f64::from(part) / 2000.0, |_| 0.0)).collect();
    let (mut of_groove, mut gone) = (0, 0);
    for (middle, alive) in middles(cells).zip(alive) {
        let distances = poses.iter().map(|pose| {
            let of_tip = pose.inverse(middle);
            (of_tip.truncate().length() - BORE).max(0.0).hypot(of_tip.z)
        });
        let nearest = distances.fold(f64::INFINITY, f64::min);
        let is_there = alive != 0;
        assert!(is_there || nearest < REACH + 2e-5, "{middle} is gone, {nearest} m from the mouth");
        if middle.x.abs() < 1.5e-3 {
            assert!(!is_there || nearest > REACH - 2e-5, "{middle} is there, {nearest} m from the mouth");
            of_groove += usize::from(!is_there);
        }
        gone += usize::from(!is_there);
    }
    let summary = simulation.summary("").unwrap();
    let volume = simulation.probe("hole").unwrap()[0];
    println!("{cells:?}: {gone} cells, {of_groove} of them in the groove, {volume} m³");
    assert!(near(volume, gone as f64 * cell, 1e-9) && near(summary.removed_mass, 1e3 * volume, 1e-9), "{volume} m³");
    assert!(gone == summary.removed_elements && of_groove > 0, "{gone} of {}", summary.removed_elements);
    // the shaft leans on the end of the groove, which pushes it back
    let tip = &summary.tools["phaco.tip"];
    assert!(tip.nodes > 2 && tip.force.x > 0.0 && tip.force.z > 0.0 && tip.loss.unwrap() > 0.0, "{tip:?}");
}

#[test]
fn a_groove_is_what_came_in_reach_of_the_tip() {
    sculpts((16, 8, 4));
}

#[test]
#[ignore = "long"]
fn a_groove_is_what_came_in_reach_of_the_tip_on_finer_meshes() {
    sculpts((20, 10, 5));
    sculpts((24, 12, 6));
}
