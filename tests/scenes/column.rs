//! The twisted column.

use super::{near, reference, scene};
use sinew::Simulation;

/// Volume ratio of each element, the smallest and the mean of all, ten times on the way.
fn volumes(sets: &[&str]) -> Vec<(f64, f64)> {
    let mut simulation = Simulation::new(&scene("twisted_column", sets), &reference()).unwrap();
    let end = simulation.planned_steps() as f64 * simulation.time_step();
    let mut seen = Vec::new();
    for part in 1..=10 {
        simulation.advance_to(end * f64::from(part) / 10.0).unwrap();
        let ratios = simulation.fields("column").unwrap().volume_ratio;
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        seen.push((ratios.into_iter().fold(f64::INFINITY, f64::min), mean));
    }
    seen
}

#[test]
fn a_whole_turn_keeps_the_volume_and_turns_no_element_inside_out() {
    for (smallest, mean) in volumes(&[]) {
        assert!(smallest > 0.9, "J = {smallest}");
        assert!((0.97..=1.03).contains(&mean), "mean J = {mean}");
    }
}

#[test]
#[ignore = "long"]
fn so_do_two_turns() {
    let twice = ["constraints[1].rotation=(0, 0, 720)", "duration=3", "constraints[1].curve=Smooth(end: 2.5)"];
    for (smallest, mean) in volumes(&twice) {
        assert!(smallest > 0.5, "J = {smallest}");
        assert!((0.97..=1.03).contains(&mean), "mean J = {mean}");
    }
}

#[test]
fn the_top_is_back_where_it_was_after_a_whole_turn() {
    let mut simulation = Simulation::new(&scene("twisted_column", &[]), &reference()).unwrap();
    let rest = simulation.rest_positions("column").unwrap();
    let top: Vec<usize> = (0..rest.len()).filter(|&node| rest[node].z > 0.16 - 1e-9).collect();
    simulation.advance_to(0.6).unwrap();
    let half = simulation.displacements("column").unwrap();
    // half way round a corner is opposite to where it was
    let farthest = top.iter().map(|&node| half[node].length()).fold(0.0, f64::max);
    assert!(near(farthest, 0.04 * 2.0_f64.sqrt(), 1e-3), "{farthest} m");
    simulation.advance_to(1.3).unwrap();
    let end = simulation.displacements("column").unwrap();
    assert!(top.iter().all(|&node| end[node].length() < 1e-9));
}
