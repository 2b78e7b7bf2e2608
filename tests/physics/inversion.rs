//! Tissue under the stable neo-Hookean law squeezed to almost nothing (H07). What is turned inside out, H08 to H10, is
//! in `crates/studies/tests/hard.rs`.
//!
//! A cube of .1 m, damped at 40/s: its slowest motion, of some 15 rad/s, dies in a second to 1e-6 of itself. What is
//! farther than 1e-3 of the cube from its place after that is held there by a false equilibrium.

use crate::configurations::{configurations, cpu_and_long_gpu, near};
use crate::element_turns::with_elements;

const SIZE: f64 = 0.1;

fn squeezed(elements: &str, cells: u32, sides: &str) -> String {
    format!(
        "(duration: 3, bodies: {{\"b\": (mesh: Box(size: ({SIZE}, {SIZE}, {SIZE}), cells: ({cells}, {cells}, {cells}), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, damping: 40, stable_neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [Z]), Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]),
        Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y]), {sides}
        Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), axes: [Z], displacement: (0, 0, -0.095), curve: Table([(0, 0), (1, 1), (1.5, 1), (2, 0)]))],
        integration: (safety: 0.5))"
    )
}

/// P = m I₁/(I₁ + 1) F + l (J − a) cof F along the only stretch.
fn confined_stress(stretch: f64) -> f64 {
    let (shear, bulk) = (3000.0 / 2.9, 1e4);
    let (m, l) = (4.0 / 3.0 * shear, bulk - 2.0 / 3.0 * shear + 5.0 / 6.0 * shear);
    let square = stretch * stretch + 2.0;
    m * square / (square + 1.0) * stretch + l * (stretch - 1.0 - 0.75 * m / l)
}

/// Confined the bound of 1 % is the case's. Free the homogeneous state is not the only one: a block squeezed by more
/// than half wrinkles, so all that is asked is that it comes back. (Of 2×2×2 cells of Tet4 it does not: a corner ends
/// on the wrong side of its neighbours, with J > 0 in all of them. Nothing here knows that tissue cannot pass through
/// tissue.)
#[test]
fn cube_squeezed_by_95_percent_pushes_as_the_law_says_and_comes_back() {
    let sides = "Fixed(on: Plane(normal: (1, 0, 0), at: 0.1), axes: [X]), Fixed(on: Plane(normal: (0, 1, 0), at: 0.1), axes: [Y]),";
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 2) {
        for confined in [true, false] {
            // software devices are slow; elements of second order tangle, as coarse Tet4 do
            if !confined && (run.name.starts_with("GPU") || elements == "Tet10") {
                continue;
            }
            let mut simulation =
                run.start(&squeezed(elements, if confined { 2 } else { 3 }, if confined { sides } else { "" }));
            // at a whole step before it is let go
            simulation.advance_to(1.5 - 2.0 * simulation.time_step()).unwrap();
            let what = format!("{}, {elements}, {}", run.name, if confined { "confined" } else { "free" });
            if confined {
                let (rest, forces) =
                    (simulation.rest_positions("b").unwrap(), simulation.internal_forces("b").unwrap());
                let top: f64 = (0..rest.len()).filter(|&i| rest[i].z > 0.099).map(|i| forces[i].z).sum();
                let expected = confined_stress(0.05);
                near(&what, top / (SIZE * SIZE), expected, expected, 1e-2);
            }
            simulation.advance_to(3.0).unwrap();
            let apart = simulation.displacements("b").unwrap().iter().map(|u| u.length() / SIZE).fold(0.0, f64::max);
            let inverted = simulation.fields("b").unwrap().volume_ratio.iter().filter(|&&j| j <= 0.0).count();
            println!("{what}: {apart:.1e} of the cube from its place");
            assert!(apart < 1e-3 && inverted == 0, "{what}: {apart:e} from its place, {inverted} inside out");
        }
    }
}

/// The top face is pulled through the bottom by half the height (J = −0.5 everywhere) and back.
const PULLED: &str = "Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, -0.15),
    curve: Table([(0, 0), (0.25, 1), (0.3, 1), (0.5, 0)]))";

/// A cube of a material that stands on its bottom.
fn standing(elements: &str, material: &str, start: &str, moved: &str, safety: f64) -> String {
    format!(
        "(duration: 1.2, bodies: {{\"b\": (mesh: Box(size: ({SIZE}, {SIZE}, {SIZE}), cells: (2, 2, 2), elements: {elements}), material: \"m\", {start})}},
        materials: {{\"m\": (density: 1000, damping: 40, {material})}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)), {moved}],
        integration: (safety: {safety}))"
    )
}

/// H08 with a face instead of a node: every element is inside out.
#[test]
#[ignore = "long"]
fn cube_pulled_through_itself_recovers_is_lost_or_stops_the_run_as_its_material_says() {
    let (stable, usual) = (
        "stable_neo_hookean: Young(young: 3e3, poisson: 0.45)",
        "neo_hookean: Young(young: 3e3, poisson: 0.45), inversion: ",
    );
    for (run, elements) in with_elements(&configurations(), 0) {
        let what = format!("{}, {elements}", run.name);
        let mut simulation = run.start(&standing(elements, stable, "", PULLED, 0.4));
        simulation.advance_to(1.2).unwrap();
        let summary = simulation.summary("finished").unwrap();
        println!("{what}: {:?}", summary.inversions);
        assert!(summary.inversions.len() == 1 && summary.inversions[0].left == 0, "{what}: {:?}", summary.inversions);
        let apart = simulation.displacements("b").unwrap().iter().map(|u| u.length() / SIZE).fold(0.0, f64::max);
        assert!(apart < 1e-3, "{what}: {apart:e} from its place");

        let mut simulation = run.start(&standing(elements, &format!("{usual}Stop"), "", PULLED, 0.4));
        let error = simulation.advance_to(1.2).unwrap_err().to_string();
        // or the step has gone to nothing on the way there
        let honest = ["is turned inside out", "the stable step has shrunk"];
        assert!(honest.iter().any(|words| error.contains(words)), "{what}: {error}");

        // what stiffens without bound before it goes needs small steps; software devices are slow
        if !run.name.starts_with("GPU") {
            // and on its way through J = 0 makes energy, which the guards would end the run for
            let scene = standing(elements, &format!("{usual}Remove"), "", PULLED, 0.1);
            let mut simulation = run.start(&scene.replacen('(', "(guards: (off: [Energy]), ", 1));
            simulation.advance_to(1.2).unwrap_or_else(|error| panic!("{what}: {error}"));
            let summary = simulation.summary("finished").unwrap();
            println!("{what}: {} elements removed", summary.removed_elements);
            assert!(summary.removed_elements > 0 && summary.removed_mass > 0.0 && summary.inversions.is_empty());
            assert!(simulation.displacements("b").unwrap().iter().all(|u| u.is_finite()));
        }
    }
}

/// A cube that starts mirrored in its bottom and half as high passes through that and stands up.
#[test]
fn mirrored_cube_stands_up_again() {
    let start = "start: Affine(gradient: ((0, 0, 0), (0, 0, 0), (0, 0, -1.5)))";
    for (run, elements) in with_elements(&configurations(), 1) {
        // elements of second order tangle on the way
        if run.name.starts_with("GPU") && elements != "Tet4" || elements == "Tet10" {
            continue;
        }
        let stable = "stable_neo_hookean: Young(young: 3e3, poisson: 0.45)";
        let mut simulation = run.start(&standing(elements, stable, start, "", 0.4));
        let least = |simulation: &mut sinew::Simulation| {
            simulation.fields("b").unwrap().volume_ratio.into_iter().fold(f64::INFINITY, f64::min)
        };
        assert!((least(&mut simulation) + 0.5).abs() < 1e-6, "it starts so");
        simulation.advance_to(1.2).unwrap();
        let apart = simulation.displacements("b").unwrap().iter().map(|u| u.length() / SIZE).fold(0.0, f64::max);
        println!("{}, {elements}: {apart:.1e} of the cube from its place", run.name);
        assert!(apart < 1e-3 && least(&mut simulation) > 0.9, "{}, {elements}: {apart:e}", run.name);
    }
}

/// The linear theory does not see it: 1 + tr ∇u is .4 where det F is −.95. Guards and removal look at det F, for every
/// law.
#[test]
#[ignore = "long"]
fn elements_of_the_linear_law_are_inside_out_where_their_volume_is() {
    let linear = "linear: Young(young: 3e3, poisson: 0.45)";
    let moved = |gradient: &str| format!("Prescribed(on: All, gradient: {gradient}, curve: Ramp(end: 0.5))");
    let (inverted, squeezed) = ("((0.9, 0, 0), (0, 0, 0), (0, 0, -1.5))", "((0.3, 0, 0), (0, 0, 0), (0, 0, -0.5))");
    for (run, elements) in with_elements(&configurations(), 2) {
        let what = format!("{}, {elements}", run.name);
        let mut simulation = run.start(
            &standing(elements, linear, "", &moved(inverted), 0.4)
                .replace("Fixed(on: Plane(normal: (0, 0, 1), at: 0)), ", ""),
        );
        let error = simulation.advance_to(0.6).unwrap_err().to_string();
        assert!(error.contains("is turned inside out"), "{what}: {error}");

        // J = 1.3 · .5, which the trace calls .8
        for (limit, goes) in [(0.7, true), (0.6, false)] {
            let scene = standing(elements, linear, "", &moved(squeezed), 0.4);
            let scene = scene.replace("Fixed(on: Plane(normal: (0, 0, 1), at: 0)), ", "");
            let removal = format!("(removal: [(when: VolumeRatioBelow({limit}))], ");
            let mut simulation = run.start(&scene.replacen('(', &removal, 1));
            simulation.advance_to(0.6).unwrap_or_else(|error| panic!("{what}: {error}"));
            let summary = simulation.summary("finished").unwrap();
            assert_eq!(summary.removed_elements > 0, goes, "{what}, {limit}");
        }
    }
}
