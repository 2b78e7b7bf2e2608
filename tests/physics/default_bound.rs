//! What the step is found from by default: the highest frequency where that saves more than it costs, and a step that follows in time.

use crate::configurations::{configurations, near};
use sinew::{Error, Simulation};

/// A block of hexahedra whose middle layer is thin, under its weight, for so long (s).
fn block(duration: f64, more: &str) -> String {
    format!(
        r#"(duration: {duration}, bodies: {{"b": (mesh: Hexahedron(corners: ((0, 0, 0), (0.1, 0, 0), (0.1, 0.1, 0), (0, 0.1, 0),
        (0, 0, 0.01), (0.1, 0, 0.1), (0.1, 0.1, 0.1), (0, 0.1, 0.01)), cells: (6, 3, 3), elements: Tet4), material: "m")}},
        materials: {{"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0.1))], loads: [Gravity(acceleration: (0, 0, -2))], {more})"#
    )
}

fn found(text: &str) -> sinew::Stability {
    configurations()[0].start(text).summary("").unwrap().stability
}

#[test]
fn the_highest_frequency_is_sought_where_that_saves_more_than_it_costs() {
    let elements = found(&block(10.0, "integration: (bound: Elements)"));
    let iterated = found(&block(10.0, "integration: (bound: Iterated)"));
    let (long, short) = (found(&block(10.0, "")), found(&block(0.006, "")));
    assert_eq!((elements.found_from, iterated.found_from), ("elements", "iterated"));
    assert_eq!((long.found_from, long.stable_step), ("iterated", iterated.stable_step), "{}", long.because);
    // a run of some steps takes what costs nothing: certain all the same
    assert_eq!((short.found_from, short.products), ("nodes", 0), "{}", short.because);
    assert!(short.stable_step > elements.stable_step && short.stable_step <= iterated.stable_step, "{short:?}");
    // in between as many products as are worth it
    let between = found(&block(0.5, ""));
    assert!(between.products > 0 && between.products < iterated.products, "{between:?}");
    assert!(between.stable_step >= short.stable_step && between.stable_step < iterated.stable_step, "{between:?}");
}

#[test]
fn what_needs_the_room_below_the_true_limit_keeps_it() {
    let removal = "removal: [(on: Sphere(center: (0, 0, 0), radius: 0.03), when: During(start: 0.1, end: 1))]";
    let policies = ["Watch", "ScaleMass()", "Remove"].map(|policy| format!("integration: (when_unstable: {policy})"));
    for more in policies.iter().map(String::as_str).chain([removal]) {
        let found = found(&block(10.0, more));
        assert_eq!(found.found_from, "elements", "{more}: {}", found.because);
        assert!(found.limit.unwrap() > found.stable_step, "{more}: {} of {:?}", found.stable_step, found.limit);
    }
}

/// Elements that leave take their mass with them, and the highest frequency rises above that of the whole.
#[test]
fn a_body_that_is_taken_apart_stays_stable() {
    for run in configurations() {
        let more = r#"removal: [(on: Sphere(center: (0, 0, 0), radius: 0.05), when: During(start: 0.05, end: 0.8))], output: (energies_every: 0.1)"#;
        let mut simulation = run.start(&block(1.0, more));
        simulation.finish().unwrap_or_else(|error| panic!("{}: {error}", run.name));
        assert!(simulation.summary("").unwrap().removed_elements > 20);
    }
}

/// README's rod in a material a thousand times too soft: it falls by its own length before anything holds it.
const ROD: &str = r#"(duration: 1, bodies: {"rod": (mesh: Box(size: (0.1, 0.02, 0.02), cells: (20, 4, 4), elements: Hex8), material: "tissue")},
    materials: {"tissue": (density: 1000, neo_hookean: Young(young: 100, poisson: 0.45), damping: 10)},
    constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
    probes: {"tip": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.1), every: 0.01)}, INTEGRATION)"#;

/// Where load outweighs stiffness the step follows before the run breaks down.
#[test]
fn a_rod_that_cannot_bear_its_weight_falls_and_does_not_break_down() {
    let end = |run: usize, integration: &str| {
        let mut simulation = configurations()[run].start(&ROD.replace("INTEGRATION", integration));
        let ended = simulation.finish();
        println!("{}: {integration}: {:?}", configurations()[run].name, simulation.step_history());
        ended.unwrap_or_else(|error| panic!("{}, {integration}: {error}", configurations()[run].name));
        simulation.summary("").unwrap().probes["tip"].1[2]
    };
    let fine = end(0, "integration: (safety: 0.05)");
    for run in 0..2 {
        for integration in ["", "integration: (bound: Iterated)", "integration: (bound: Elements)"] {
            near("the tip", end(run, integration), fine, fine, 0.02);
        }
    }
}

/// At rest for thousands of steps, then squeezed within a few hundred: looks come when the motion begins, which is known beforehand.
#[test]
fn a_motion_that_begins_late_and_fast_is_followed() {
    for run in configurations() {
        let text = r#"(duration: 3, bodies: {"b": (mesh: Box(size: (0.04, 0.04, 0.04), cells: (3, 3, 3), elements: Tet4), material: "m")},
            materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 40)},
            constraints: [Fixed(on: All, axes: [X, Y]), Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                Prescribed(on: Plane(normal: (0, 0, 1), at: 0.04), axes: [Z], displacement: (0, 0, -0.026), curve: Ramp(start: 2.203, end: 2.403))])"#;
        let mut simulation = run.start(text);
        let mut least = f64::INFINITY;
        for look in 1..=60 {
            simulation.advance_to(2.19 + 0.005 * f64::from(look)).unwrap();
            // 3 % is how far the limit may be underestimated
            least = least.min(simulation.stable_limit().unwrap().unwrap() / 0.97 / simulation.time_step());
        }
        println!("{}: limit over step at least {least}, {:?}", run.name, simulation.step_history());
        assert!(least > 1.0, "{}: {least}", run.name);
        simulation.finish().unwrap();
        assert!(simulation.step_history().unwrap().smallest < 0.8 * simulation.step_history().unwrap().largest);
    }
}

/// Findings are paid for by what they save: an oscillation that never stiffens much is not asked about again and again.
#[test]
fn the_highest_frequency_is_not_sought_for_nothing() {
    let mut simulation: Simulation = configurations()[0].start(&block(10.0, ""));
    let ended: Result<(), Error> = simulation.finish();
    ended.unwrap();
    let history = *simulation.step_history().unwrap();
    let steps = simulation.step_count();
    println!("{steps} steps, {history:?}");
    // 96 steps each: a tenth of the run at most
    assert!(960 * history.sharp_looks <= steps, "{history:?}, {steps}");
}
