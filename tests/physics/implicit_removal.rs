//! Removal in implicit steps: what goes is looked at in each of them, and no work is counted of forces that are gone.

use crate::configurations::near;
use crate::implicit::start;
use sinew::Simulation;

/// Solvers, with how many of their steps there are from one look at what may go to the next.
const SOLVERS: [(&str, u64); 3] = [("Explicit", 10), ("Implicit(step: 2e-3)", 1), ("Implicit(step: 1e-2)", 1)];

/// Volume at rest of a cell of the block (m³).
const CELL: f64 = 1.5625e-8;

/// How many cells go at most at a time.
const BURST: f64 = 64.0;

/// A block whose stretch is told, 1 + t/.2 s along x.
fn stretched(solver: &str, rest: &str) -> Simulation {
    start(&format!(
        "(duration: 0.2, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.04, 0.02, 0.02), cells: (16, 8, 8), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
        constraints: [Prescribed(on: All, gradient: ((1, 0, 0), (0, 0, 0), (0, 0, 0)), curve: Ramp(end: 0.2))],
        tools: {{\"ball\": (shape: Sphere(radius: 0.01),
            path: [(t: 0, at: (0.02, 0.01, 0.02)), (t: 0.2, at: (0.03, 0.01, 0.01))])}},
        removal: [{rest}], probes: {{\"hole\": (what: RemovedVolume)}})"
    ))
}

fn gone(simulation: &mut Simulation) -> f64 {
    simulation.probe("hole").unwrap()[0]
}

/// A stretch of 1.523 is passed at .1046 s: the next step of 2 and 10 ms ends at .106 and .11 s.
#[test]
fn criteria_are_looked_at_in_every_implicit_step() {
    for (solver, _) in SOLVERS {
        let mut simulation =
            stretched(solver, "(on: Box(min: (0.01, 0, 0), max: (0.02, 1, 1)), when: StretchAbove(1.523))");
        simulation.advance_to(0.104).unwrap();
        assert!(simulation.time() > 0.11 - 1e-9 || gone(&mut simulation) == 0.0, "{solver}");
        simulation.advance_to(0.11).unwrap();
        near(solver, gone(&mut simulation), 4e-6, 4e-6, 1e-9);
    }
}

/// What is gone is the integral of the rate, but for an element that is not whole yet and the time until it is looked.
#[test]
fn tools_take_their_rate_in_implicit_steps() {
    for (solver, looks) in SOLVERS {
        let mut simulation = stretched(solver, "(when: InTool(tool: \"ball\", reach: 8e-3, rate: 2e-5, crumb: 0))");
        for time in [0.05, 0.1, 0.15, 0.2] {
            simulation.advance_to(time).unwrap();
            let (volume, taken) = (gone(&mut simulation), 2e-5 * simulation.time());
            let late = 2e-5 * 2.0 * looks as f64 * simulation.time_step();
            println!("{solver}, {time} s: {volume:e} of {taken:e}");
            assert!(volume <= taken * (1.0 + 1e-9), "{solver}: {volume:e} of {taken:e}");
            assert!(volume >= taken - late - 1.001 * CELL, "{solver}: {volume:e} of {taken:e}");
        }
    }
}

/// A stretch of 1.2 is passed after .04 s: at .05 s there were one look of steps of 10 ms, at least three of 2 ms.
#[test]
fn tools_with_thresholds_look_in_every_implicit_step() {
    for (solver, looks) in [("Implicit(step: 2e-3)", 3.0), ("Implicit(step: 1e-2)", 1.0)] {
        let mut simulation =
            stretched(solver, "(when: InTool(tool: \"ball\", reach: 8e-3, threshold: StretchAbove(1.2), crumb: 0))");
        simulation.advance_to(0.05).unwrap();
        let (volume, least) = (gone(&mut simulation), looks * BURST * CELL);
        println!("{solver}: {volume:e}, at least {least:e}");
        assert!(volume >= least * (1.0 - 1e-9), "{solver}: {volume:e} is gone, and not {least:e}");
    }
}

/// What is held but for what was given (J), and all that is held.
fn unbalanced(simulation: &mut Simulation) -> (f64, f64) {
    let e = simulation.energies().unwrap();
    let held = e.kinetic + e.strain + e.hourglass + e.removed;
    let given = e.load_work.unwrap() + e.constraint_work.unwrap();
    (held - given + e.damping_loss.unwrap() + e.scheme_loss.unwrap_or(0.0), held)
}

/// Of a bar that has been drawn out by a third half of the middle goes after 50 ms. Work is that of the mean of the
/// forces at both ends of a step: what it is off by is of the third order of how far nodes go, and at most 1.6e-4 of
/// what is held in the ten steps after the removal. With the forces of what is gone it was 1.4e-2 in the first of them,
/// by generalised-α 2.4e-3.
#[test]
fn no_work_is_counted_of_forces_that_are_gone() {
    for scheme in ["Euler", "GeneralizedAlpha()"] {
        let mut simulation = start(&format!(
            "(duration: 0.06, solver: Implicit(step: 1e-3, tolerance: 1e-8, scheme: {scheme}),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.02, 0.02), cells: (10, 2, 3), elements: Hex8), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 100)}},
            constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0)), Prescribed(on: Plane(normal: (1, 0, 0), at: 0.1),
                displacement: (0.03, 0, 0), curve: Smooth(end: 0.04))],
            loads: [Gravity(acceleration: (0, 0, -2))],
            removal: [(on: Box(min: (0.04, 0, 0), max: (0.06, 1, 0.012)), when: At(0.05))],
            output: (energies_every: 1e-3))"
        ));
        simulation.advance(49).unwrap();
        let (mut before, _) = unbalanced(&mut simulation);
        for step in 50..60 {
            simulation.advance(1).unwrap();
            let (now, held) = unbalanced(&mut simulation);
            near(&format!("{scheme}, step {step}"), now - before, 0.0, held, 3e-4);
            before = now;
        }
        assert!(simulation.summary("").unwrap().removed_elements > 0, "{scheme}");
    }
}
