//! What tools cut off, what passes a threshold in them, what is bared.
//!
//! Volumes are whole cells of 1 m³, masses 1000 kg each: both to 1e-9 (f64) and 1e-4 (f32).

use crate::configurations::{ELEMENTS, configurations, cpu_and_long_gpu, near, scene_of};
use crate::element_turns::with_elements;
use glam::DVec3;
use sinew::components::DisplacementIncrement;
use sinew::{Options, Simulation};

/// A bar of 6 × 1 × 1 cells, held at its left end. At .05 s its fourth and fifth cells go, and the last is an island.
/// A ball stands above the gap, .3 m from what is nearest to it, and takes what its fields say.
fn cut(elements: &str, takes: &str) -> String {
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (6, 1, 1), cells: (6, 1, 1), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], integration: (step: 1e-3),
        tools: {{\"t\": (shape: Sphere(radius: 0.5), at: (4, 0.5, 1.8))}},
        removal: [(on: Box(min: (3, 0, 0), max: (5, 1, 1)), when: At(0.05)),
            (on: Not(Box(min: (3, 0, 0), max: (5, 1, 1))), when: InTool(tool: \"t\", curve: Step(start: 0.02), {takes}))],
        probes: {{\"hole\": (what: RemovedVolume)}}, output: (energies_every: 0.01))"
    )
}

fn gone(simulation: &mut Simulation) -> f64 {
    simulation.probe("hole").unwrap()[0]
}

/// An island smaller than a crumb goes in the first check after it is cut off, energies balance, and the tool has to
/// catch up with its volume; a larger one stays, and so does one that is out of reach or may not be taken.
#[test]
#[ignore = "long"]
fn islands_below_a_crumb_go_at_once_and_count_as_taken_in() {
    for (run, elements) in with_elements(&configurations(), 0) {
        let what = format!("{}, {elements}", run.name);
        let bound = run.bound(1e-9, 1e-4);
        // cells in reach: their centroids are 1.5 m beside the ball's middle and 1.3 m below, 1.48 m from its surface
        let takes = "reach: 1.9, rate: 10, crumb: 1.01";
        let mut simulation = run.start(&cut(elements, takes).replace("rate: 10", "rate: 1e-9"));
        simulation.advance(50).unwrap();
        near(&format!("{what}: cut"), gone(&mut simulation), 2.0, 1.0, bound);
        simulation.advance(11).unwrap();
        near(&format!("{what}: the island"), gone(&mut simulation), 3.0, 1.0, bound);
        let summary = simulation.summary("").unwrap();
        near(&format!("{what}: mass"), summary.removed_mass, 3000.0, 3000.0, bound);
        assert!(summary.energies.removed >= 0.0, "{what}");
        simulation.advance(300).unwrap();
        near(&format!("{what}: the rest stays"), gone(&mut simulation), 3.0, 1.0, bound);
        for stays in [
            cut(elements, "reach: 1.9, rate: 1e-9, crumb: 0.99"),
            cut(elements, "reach: 1.9, rate: 1e-9, crumb: 0"),
            cut(elements, "reach: 0.9, rate: 1e-9, crumb: 1.01"),
            cut(elements, takes)
                .replace("rate: 10", "rate: 1e-9")
                .replace("(5, 1, 1))), when: InTool", "(6, 1, 1))), when: InTool"),
        ] {
            let mut simulation = run.start(&stays);
            simulation.advance(100).unwrap();
            near(&format!("{what}: what is no crumb"), gone(&mut simulation), 2.0, 1.0, bound);
        }
    }
}

/// A rate of 10 m³/s has taken in .3 m³ when the island goes, at .05 s, and then lacks .7 m³: the next cell, of 1 m³,
/// goes at .22 s and not before.
#[test]
fn a_tool_catches_up_with_the_crumbs_it_took() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&cut("Hex8", "reach: 1.9, rate: 10, crumb: 1.01"));
        simulation.advance(208).unwrap();
        near(&format!("{}: before", run.name), gone(&mut simulation), 3.0, 1.0, 1e-4);
        simulation.advance(25).unwrap();
        near(&format!("{}: after", run.name), gone(&mut simulation), 4.0, 1.0, 1e-4);
        let taken = 10.0 * (simulation.time() - 0.02);
        assert!(gone(&mut simulation) - 2.0 <= taken, "{}: {taken}", run.name);
    }
}

/// 4 mean elements are a crumb where the scene does not say.
#[test]
fn a_crumb_is_four_mean_elements_where_nothing_is_said() {
    for run in cpu_and_long_gpu() {
        for (cells, crumb) in [("(6, 1, 1)", true), ("(6, 3, 2)", false)] {
            // an island of one cell, or of six
            let scene = cut("Hex8", "reach: 1.9, rate: 1e-9").replace("cells: (6, 1, 1)", &format!("cells: {cells}"));
            let mut simulation = run.start(&scene.replace("reach: 1.9", "reach: 2.5"));
            simulation.advance(100).unwrap();
            let expected = if crumb { 3.0 } else { 2.0 };
            near(&format!("{}, {cells}", run.name), gone(&mut simulation), expected, 1.0, 1e-4);
        }
    }
}

/// Total momentum: that of what moves and what went with elements.
#[test]
fn momentum_that_goes_with_elements_is_booked() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 1) {
        let scene = cut(elements, "reach: 1.9, rate: 1e-9, crumb: 1.01")
            .replace("constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],", "")
            .replace("material: \"m\")", "material: \"m\", velocity: (0.3, -0.1, 0.2), spin: (0, 0, 0.2))")
            .replace("reach: 1.9", "reach: 2.2");
        let mut simulation = run.start(&scene);
        simulation.advance(1).unwrap();
        let expected = momentum(&mut simulation);
        for (steps, cells) in [(48, 0), (51, 3)] {
            simulation.advance(steps).unwrap();
            let left = momentum(&mut simulation);
            let summary = simulation.summary("").unwrap();
            let what = format!("{}, {elements}, {cells} cells gone", run.name);
            near(&what, summary.removed_mass, 1000.0 * f64::from(cells), 6000.0, 1e-4);
            let size = expected.length();
            near(&what, (left + summary.removed_momentum - expected).length(), 0.0, size, run.bound(1e-9, 1e-4));
            // what went is not nothing, and not the same in all directions
            assert!(
                cells == 0 || summary.removed_momentum.length() > 0.1 * size,
                "{what}: {}",
                summary.removed_momentum
            );
        }
    }
}

fn momentum(simulation: &mut Simulation) -> DVec3 {
    let masses = simulation.masses("b").unwrap();
    let rate = 1.0 / simulation.time_step();
    masses.iter().zip(steps(simulation)).map(|(mass, step)| step * rate * *mass).sum()
}

/// Displacements of all nodes in the last step (m), in the author's order.
fn steps(simulation: &mut Simulation) -> Vec<DVec3> {
    let view = simulation.column::<DisplacementIncrement>("b").unwrap();
    view.node_rows().iter().map(|&row| view.values().vector(row as usize)).collect()
}

/// A bar is drawn out to twice its length. Where a tool is, what is stretched beyond its threshold goes, and nothing
/// before; elsewhere it may be stretched as it likes.
#[test]
fn a_threshold_takes_what_is_stretched_in_the_tool() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 2) {
        // uniaxial strain: the stretch is 1 + t, the energy density of Young(3e3, 0) with λ = 0, μ = 1500 exceeds 100
        // J/m³ at a stretch between 1.2 and 1.4
        for (threshold, before, after) in [("StretchAbove(1.3)", 0.27, 0.33), ("EnergyDensityAbove(100)", 0.2, 0.4)] {
            let scene = format!(
                "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (6, 1, 1), cells: (6, 1, 1), elements: {elements}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0))}},
                constraints: [Prescribed(on: All, gradient: ((1, 0, 0), (0, 0, 0), (0, 0, 0)), curve: Ramp(end: 1))],
                tools: {{\"t\": (shape: Sphere(radius: 0.5), path: [(t: 0, at: (4.5, 0.5, 1.5)), (t: 1, at: (9, 0.5, 1.5))])}},
                removal: [(when: InTool(tool: \"t\", reach: 0.55, threshold: {threshold}, crumb: 0))],
                integration: (step: 1e-3), probes: {{\"hole\": (what: RemovedVolume)}})"
            );
            let what = format!("{}, {elements}, {threshold}", run.name);
            let mut simulation = run.start(&scene);
            simulation.advance_to(before).unwrap();
            assert_eq!(gone(&mut simulation), 0.0, "{what}");
            simulation.advance_to(after).unwrap();
            let alive = simulation.fields("b").unwrap().alive;
            let a_cell = alive.len() / 6;
            assert!(alive[4 * a_cell..5 * a_cell].contains(&0), "{what}: nothing went");
            // the neighbours of the cell in reach are stretched as much
            for cell in [0, 1, 2, 5] {
                assert!(
                    alive[cell * a_cell..(cell + 1) * a_cell].iter().all(|alive| *alive == 1),
                    "{what}: cell {cell}"
                );
            }
        }
    }
}

/// Crumbs and thresholds know nothing that a snapshot lacks.
#[test]
fn bits_with_crumbs_do_not_depend_on_how_steps_are_taken() {
    for run in cpu_and_long_gpu() {
        let of = |threads: usize, resume: Option<u64>| {
            let scene =
                cut("Tet4", "reach: 1.9, rate: 10, crumb: 1.01").replace("cells: (6, 1, 1)", "cells: (12, 2, 2)");
            let scene = scene.replace("probes:", "loads: [Gravity(acceleration: (0, 0, -3))], probes:");
            let more = "(when: InTool(tool: \"t\", reach: 3, threshold: StretchAbove(1.01))), (on: Not";
            let scene = scene_of(&scene.replace("(on: Not", more), std::path::Path::new("."));
            let options = Options { threads, ..run.options.clone() };
            let mut simulation = Simulation::new(&scene, &options).unwrap();
            if let Some(step) = resume {
                simulation.advance(step).unwrap();
                let snapshot = simulation.snapshot().unwrap();
                simulation = Simulation::new(&scene, &options).unwrap();
                simulation.restore(&snapshot).unwrap();
            }
            simulation.advance(150 - simulation.step_count()).unwrap();
            let alive = simulation.fields("b").unwrap().alive;
            assert!(alive.contains(&0) && alive.contains(&1), "{}", run.name);
            let u = simulation.displacements("b").unwrap();
            let numbers = u.iter().flat_map(|u| u.to_array()).chain(alive.into_iter().map(f64::from));
            numbers.map(f64::to_bits).collect::<Vec<u64>>()
        };
        let first = of(1, None);
        for step in [49, 50, 57, 61] {
            assert!(first == of(1, Some(step)), "{}: resumed at {step}", run.name);
        }
        if !run.name.starts_with("GPU") {
            assert!(first == of(2, None), "{}: two threads", run.name);
        }
    }
}

/// A rod runs through a block, between its nodes; elements around it go, and their nodes come to the surface beside it.
/// Nothing moves: what is bared is in nobody's way. Then the rod goes against it, and it is pushed in that step.
#[test]
fn what_is_bared_beside_a_tool_gets_no_kick_and_is_touched_at_once() {
    // quadratic tetrahedra have nodes in the middle of faces, where the rod is
    let corners_only = || ELEMENTS.into_iter().filter(|elements| *elements != "Tet10");
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| corners_only().map(move |elements| (run, elements)))
    {
        let mut simulation = run.start(&format!(
            "(duration: 0.3, bodies: {{\"b\": (mesh: Box(size: (0.05, 0.05, 0.03), cells: (5, 5, 3), elements: {elements}), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {{\"rod\": (shape: Capsule(length: 0.06, radius: 2e-3), path: [(t: 0, at: (0.025, 0.03, 0.013)),
                (t: 0.1, at: (0.025, 0.03, 0.013)), (t: 0.2, at: (0.034, 0.03, 0.013))])}},
            contacts: [Tool(tool: \"rod\", thin: true)],
            removal: [(on: Box(min: (0.02, 0.02, 0.01), max: (0.03, 0.04, 0.03)), when: At(0.05))])"
        ));
        let what = format!("{}, {elements}", run.name);
        simulation.advance_to(0.1).unwrap();
        assert!(simulation.summary("").unwrap().removed_elements > 0, "{what}");
        let energy = simulation.energies().unwrap();
        let moved = simulation.displacements("b").unwrap().iter().map(|u| u.length()).fold(0.0, f64::max);
        let starts = simulation.tool("rod").unwrap().nodes;
        assert!(starts == 0 && energy.kinetic == 0.0 && moved == 0.0, "{what}: {starts} {energy:?} {moved}");
        // the wall is 3 mm away, the rod goes .09 m/s: it comes there at .1333 s; steps are up to 3 ms
        simulation.advance_to(0.128).unwrap();
        assert_eq!(simulation.tool("rod").unwrap().nodes, 0, "{what}");
        simulation.advance_to(0.16).unwrap();
        let felt = simulation.tool("rod").unwrap();
        assert!(felt.nodes > 0 && felt.force.x < -1e-5 && felt.penetration < 1e-8, "{what}: {felt:?}");
        // nobody goes faster than twice the rod, which is what an elastic wall may do that it hits
        let fastest = steps(&mut simulation).iter().map(|d| d.length() / simulation.time_step()).fold(0.0, f64::max);
        assert!(fastest < 0.18, "{what}: {fastest} m/s");
    }
}

/// A block stands on a pillar that was a broad block until what was around it went: between bodies that touch with
/// their old faces nothing changes, and what is bared gives no kick.
#[test]
fn what_is_bared_beside_another_body_gets_no_kick() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 0.6, bodies: {
                \"low\": (mesh: Box(size: (0.05, 0.01, 0.02), cells: (5, 1, 2), elements: Hex8), material: \"m\"),
                \"high\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1), elements: Hex8), material: \"m\", translate: (0.02, 0, 0.02)),
                \"side\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1), elements: Hex8), material: \"m\", translate: (0.05, 0, 0.01))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)},
            constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
            contacts: [Between(bodies: (\"low\", \"high\")), Between(bodies: (\"low\", \"side\"))],
            removal: [(body: \"low\", on: Box(min: (0, 0, 0.01), max: (0.02, 0.01, 0.02)), when: At(0.05)),
                (body: \"low\", on: Box(min: (0.03, 0, 0.01), max: (0.05, 0.01, 0.02)), when: At(0.05))])",
        );
        simulation.advance_to(0.2).unwrap();
        assert!(simulation.summary("").unwrap().removed_elements == 4, "{}", run.name);
        for body in ["low", "high", "side"] {
            let moved = simulation.displacements(body).unwrap().iter().map(|u| u.length()).fold(0.0, f64::max);
            assert!(moved < run.bound(1e-12, 1e-8), "{}: {body} moved {moved} m", run.name);
        }
    }
}
