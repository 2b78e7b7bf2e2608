//! Orders of implicit schemes on the axial mode of a bar, and laws that are no numbers.
//!
//! A bar of n cells, held sideways, whose velocity at the start is that of its first mode, v₀ sin(kx), k = π/2L: of
//! lumped masses and linear elements that is a mode to the digit, with ω = (2c/d) sin(kd/2), c = √(E/ρ) at ν = 0, d a
//! cell. Its end is at v₀/ω sin ωt.

use crate::configurations::{near, scene_of};
use crate::implicit::options;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::{Authoring, DisplacementIncrement, Precision};
use sinew::{BackendChoice, Options, Simulation};
use std::f64::consts::PI;
use std::path::Path;

const CELLS: f64 = 10.0;
const LENGTH: f64 = 0.1;
const SPEED: f64 = 1e-3;
/// An eighth of a period and half of one: no extremum of the sine or of its slope.
const PERIODS: f64 = 0.625;

fn omega() -> f64 {
    let (cell, speed) = (LENGTH / CELLS, 3f64.sqrt());
    2.0 * speed / cell * (PI / (2.0 * LENGTH) * cell / 2.0).sin()
}

/// How far the end of the bar is off in some steps, over v₀/ω.
fn off(solver: &str, steps: u32) -> f64 {
    let time = PERIODS * 2.0 * PI / omega();
    let h = time / f64::from(steps);
    let scene = format!(
        "(duration: 10, solver: Implicit({solver}, step: {h:?}),
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: (10, 1, 1), elements: Hex8MeanDilatation), material: \"m\")}},
        materials: {{\"m\": (density: 1000, linear: Young(young: 3e3, poisson: 0))}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0)), Fixed(on: All, axes: [Y, Z])])"
    );
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(Precision::F64, 1)).unwrap();
    let rest = simulation.rest_positions("b").unwrap().to_vec();
    let entity = simulation.body("b").unwrap();
    let rows = simulation.world().get::<Authoring>(entity).unwrap().node_rows.clone();
    let mut increments = simulation.world_mut().get_mut::<DisplacementIncrement>(entity).unwrap();
    for (x, row) in rest.iter().zip(&rows) {
        increments.set(3 * *row as usize, h * SPEED * (PI * x.x / (2.0 * LENGTH)).sin());
    }
    simulation.advance(u64::from(steps)).unwrap();
    let end = (0..rest.len()).find(|&node| rest[node].x > 0.099).unwrap();
    let exact = SPEED / omega() * (omega() * time).sin();
    (simulation.displacements("b").unwrap()[end].x - exact).abs() * omega() / SPEED
}

/// Of the linearised step its one solve is that of the linear bar.
#[test]
fn errors_halve_or_quarter_with_the_step_by_the_order_of_the_scheme() {
    for (solver, order) in [
        ("scheme: Euler, tolerance: 1e-12", 1),
        ("scheme: Euler, newton: 1, tolerance: 1e-12", 1),
        ("scheme: GeneralizedAlpha(), tolerance: 1e-12", 2),
        ("scheme: GeneralizedAlpha(high_frequencies: 0.2), tolerance: 1e-12", 2),
        ("scheme: GeneralizedAlpha(high_frequencies: 1), newton: 1, tolerance: 1e-12", 2),
    ] {
        let errors = [100, 200, 400].map(|steps| off(solver, steps));
        println!("{solver}: {errors:?}");
        // what is left of the next order is a part of ωh
        for pair in errors.windows(2) {
            near(solver, (pair[0] / pair[1]).log2(), f64::from(order), 1.0, 0.05);
        }
    }
}

/// Gent's law has no stress where I₁ − 3 is beyond its limit, here at a stretch of about 1.35: a bar that is pulled
/// farther ends with what was wrong, and its last state.
#[test]
fn a_law_that_is_no_number_ends_with_the_last_good_state() {
    let mut all = vec![options(Precision::F64, 1), options(Precision::F32, 1)];
    if gpu_or_reason().is_some() {
        all.push(Options { backend: BackendChoice::Gpu, ..options(Precision::F32, 1) });
    }
    for scheme in ["Euler", "GeneralizedAlpha()"] {
        for options in &all {
            let scene = format!(
                r#"(duration: 1, solver: Implicit(scheme: {scheme}, step: 0.01),
                bodies: {{"b": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (4, 1, 1), elements: Tet4), material: "m")}},
                materials: {{"m": (density: 1000, law: (energy: "-mu * Jm / 2 * log(1 - I1bar_minus_3 / Jm) + kappa / 2 * J_minus_1 * J_minus_1",
                    parameters: {{"mu": 2000, "kappa": 4e4, "Jm": 0.3}}), damping: 50)}},
                constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0)),
                    Prescribed(on: Plane(normal: (1, 0, 0), at: 0.04), displacement: (0.08, 0, 0), curve: Ramp(end: 0.4))])"#
            );
            let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), options).unwrap();
            let mut before = simulation.displacements("b").unwrap();
            let error = loop {
                match simulation.advance(1) {
                    Ok(()) => before = simulation.displacements("b").unwrap(),
                    Err(error) => break error.to_string(),
                }
                assert!(simulation.step_count() < 40, "there is no bar of that length");
            };
            println!("{error}");
            assert!(error.contains("implicit step") && error.contains("no numbers"), "{error}");
            assert!(simulation.step_count() > 2, "it ends where the law does: {error}");
            let left = simulation.displacements("b").unwrap();
            assert!(left == before && left.iter().all(|u| u.is_finite()), "another state than the last good one");
        }
    }
}
