//! `bound: Auto`: the highest frequency where that saves more than it costs, else what all elements together allow.

use crate::configurations::{configurations, cpu_and_long_gpu};

/// A block of hexahedra whose middle layer is thin, under its weight, for so long (s).
fn block(duration: f64, more: &str) -> String {
    format!(
        r#"(duration: {duration}, bodies: {{"b": (mesh: Hexahedron(corners: ((0, 0, 0), (0.1, 0, 0), (0.1, 0.1, 0), (0, 0.1, 0),
        (0, 0, 0.01), (0.1, 0, 0.1), (0.1, 0.1, 0.1), (0, 0.1, 0.01)), cells: (6, 3, 3), elements: Tet4), material: "m")}},
        materials: {{"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0.1))], loads: [Gravity(acceleration: (0, 0, -2))], {more})"#
    )
}

const AUTO: &str = "integration: (bound: Auto)";

fn found(text: &str) -> sinew::Stability {
    configurations()[0].start(text).summary("").unwrap().stability
}

#[test]
fn the_highest_frequency_is_sought_where_that_saves_more_than_it_costs() {
    let elements = found(&block(10.0, "integration: (bound: Elements)"));
    let iterated = found(&block(10.0, "integration: (bound: Iterated)"));
    let (long, short) = (found(&block(10.0, AUTO)), found(&block(0.006, AUTO)));
    assert_eq!((elements.found_from, iterated.found_from), ("elements", "iterated"));
    assert_eq!((long.found_from, long.stable_step), ("iterated", iterated.stable_step), "{}", long.because);
    // a run of some steps takes what costs nothing: certain all the same
    assert_eq!((short.found_from, short.products), ("nodes", 0), "{}", short.because);
    assert!(short.stable_step > elements.stable_step && short.stable_step <= iterated.stable_step, "{short:?}");
    // in between as many products as are worth it
    let between = found(&block(0.5, AUTO));
    assert!(between.products > 0 && between.products < iterated.products, "{between:?}");
    assert!(between.stable_step >= short.stable_step && between.stable_step < iterated.stable_step, "{between:?}");
}

#[test]
fn what_needs_the_room_below_the_true_limit_keeps_it() {
    let removal = "integration: (bound: Auto), removal: [(on: Sphere(center: (0, 0, 0), radius: 0.03), when: During(start: 0.1, end: 1))]";
    let policies =
        ["Watch", "ScaleMass()", "Remove"].map(|policy| format!("integration: (bound: Auto, when_unstable: {policy})"));
    for more in policies.iter().map(String::as_str).chain([removal]) {
        let found = found(&block(10.0, more));
        assert_eq!(found.found_from, "elements", "{more}: {}", found.because);
        assert!(found.limit.unwrap() > found.stable_step, "{more}: {} of {:?}", found.stable_step, found.limit);
    }
}

/// Elements that leave take their mass with them, and the highest frequency rises above that of the whole.
#[test]
fn a_body_that_is_taken_apart_stays_stable() {
    for run in cpu_and_long_gpu() {
        let more = r#"integration: (bound: Auto), removal: [(on: Sphere(center: (0, 0, 0), radius: 0.05), when: During(start: 0.05, end: 0.8))], output: (energies_every: 0.1)"#;
        let mut simulation = run.start(&block(1.0, more));
        simulation.finish().unwrap_or_else(|error| panic!("{}: {error}", run.name));
        assert!(simulation.summary("").unwrap().removed_elements > 20);
    }
}
