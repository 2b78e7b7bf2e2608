//! Natural frequencies against closed forms of a bar of .1 × .01 × .01 m (E = 3000 Pa, ν = .45, ρ = 1000 kg/m³).

use crate::configurations::{configurations, near};

fn scene(cells: &str, elements: &str, constraints: &str) -> String {
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: {cells}, elements: {elements}), material: \"m\")}},
         materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}}, constraints: [{constraints}])"
    )
}

/// Lateral motion held, the bar is a column in one-dimensional strain: f_k = (2k − 1)/(4 L) √((λ + 2μ)/ρ), 8.4333 Hz.
/// With n linear elements and lumped masses f_h = (c/(π h)) sin(ω h/(2c)), too low by (ω h/c)²/24.
#[test]
fn axial_frequencies_of_a_held_bar_are_those_of_the_wave_equation() {
    let held = "Fixed(on: Plane(normal: (1, 0, 0), at: 0)), Fixed(on: All, axes: [Y, Z])";
    let text = scene("(20, 1, 1)", "Hex8", held);
    for configuration in configurations() {
        let mut simulation = configuration.start(&text);
        // the third would be one in which the corners of a section move apart
        let modes = simulation.modes(2).unwrap();
        let (speed, h) = ((11379.310344827587_f64 / 1000.0).sqrt(), 0.1 / 20.0);
        for (number, mode) in modes.iter().enumerate() {
            let wave_number = (2.0 * number as f64 + 1.0) * std::f64::consts::FRAC_PI_2 / 0.1;
            let lumped = speed / (std::f64::consts::PI * h) * (0.5 * wave_number * h).sin();
            near("frequency", mode.frequency, lumped, lumped, configuration.bound(1e-6, 1e-4));
        }
        near("the wave equation's", modes[0].frequency, 8.4333, 8.4333, 1e-3);
        // a quarter of a sine moves 8/π² of the mass, of which the clamped layer has a fortieth
        near("effective mass", modes[0].effective_mass[0], 8.0 / std::f64::consts::PI.powi(2) / 0.975, 1.0, 2e-3);
    }
}

/// Bending: .27980 and 1.75345 Hz, each twice; Euler and Bernoulli's, which a bar ten times longer than thick misses by
/// 1 and 8 %.
#[test]
fn bending_frequencies_come_in_pairs() {
    let text = scene("(30, 3, 3)", "Hex8", "Fixed(on: Plane(normal: (1, 0, 0), at: 0))");
    let mut simulation = configurations()[0].start(&text);
    let modes = simulation.modes(4).unwrap();
    let frequency = |number: usize| modes[number].frequency;
    for pair in [0, 2] {
        near("the second of a pair", frequency(pair + 1), frequency(pair), frequency(pair), 1e-4);
    }
    near("first bending", frequency(0), 0.27980, 0.27980, 0.03);
    near("second bending", frequency(2), 1.75345, 1.75345, 0.12);
    let tip = modes[0].shapes["b"].iter().map(|u| u.length()).fold(0.0, f64::max);
    near("the largest", tip, 1.0, 1.0, 1e-12);
}

#[test]
fn a_free_body_has_six_rigid_motions() {
    for configuration in configurations() {
        let mut simulation = configuration.start(&scene("(6, 2, 2)", "Tet4", ""));
        let modes = simulation.modes(8).unwrap();
        let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
        assert!(frequencies[..6].iter().all(|frequency| *frequency == 0.0), "{}: {frequencies:?}", configuration.name);
        assert!(frequencies[6] > 0.1, "{}: {frequencies:?}", configuration.name);
    }
}
