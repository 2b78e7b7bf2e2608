//! Bars in motion: closed forms 4, 6 and 7. L = .1 m, section .01 × .01 m.
//!
//! Clamped-free, frequencies: axial √((λ+2μ)/ρ)/(4L) = 8.4333 Hz with lateral motion held, √(E/ρ)/(4L) = 4.3301 Hz
//! slender; bending .5596 √(E I/(ρ A))/L² = .27980 Hz. They are counted from zeros of the motion's projection on the
//! mode. What discretisation changes: lumped masses ω h²k²/24 = (π/80)²/6 = 2.6e-4 at 20 cells, less what the time step
//! gives back; a bar of finite width ½(νπ/(2L))² (b² + h²)/12 = 4e-4; Timoshenko's beam ½ (1.8751/L)² (I/A)(1 + E/(kG))
//! = .66 %. Spinning at ω = 2π rad/s about its middle: σ = ½ρω²(L/2)² = 49.348 Pa there. Hitting at v = .01 m/s with
//! lateral motion held: σ = −ρ c v = −33.7332 Pa, at the other end after L/c = .0296444 s.

use crate::columns::{masses, velocities};
use crate::configurations::{configurations, cpu_and_long_gpu, near};
use crate::element_turns::with_elements;
use sinew::Simulation;
use std::f64::consts::PI;

/// Mean frequency between the first zero and the last of Σ m φ(x) u_axis, φ the mode's shape.
fn frequency(simulation: &mut Simulation, axis: usize, every: u64, shape: impl Fn(f64) -> f64) -> f64 {
    let (mass, rest) = (masses(simulation, "b"), simulation.rest_positions("b").unwrap());
    let weights: Vec<f64> = mass.iter().zip(&rest).map(|(m, x)| m * shape(x.x)).collect();
    let (mut zeros, mut last) = (Vec::new(), (0.0_f64, 0.0_f64));
    while simulation.step_count() < simulation.planned_steps() {
        simulation.advance(every).unwrap();
        let u = simulation.displacements("b").unwrap();
        let now = (simulation.time(), u.iter().zip(&weights).map(|(u, w)| u[axis] * w).sum::<f64>());
        if last.1 != 0.0 && now.1.signum() != last.1.signum() {
            zeros.push(last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1));
        }
        last = now;
    }
    assert!(zeros.len() > 1, "no oscillation: {zeros:?}");
    0.5 * (zeros.len() - 1) as f64 / (zeros[zeros.len() - 1] - zeros[0])
}

fn bar(run: &crate::configurations::Configuration, mesh: &str, constraints: &str, rest: &str) -> Simulation {
    run.start(&format!(
        "(bodies: {{\"b\": (mesh: Box({mesh}), material: \"m\", velocity: (1e-4, 0, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]), {constraints}], {rest})"
    ))
}

#[test]
#[ignore = "long"]
fn bar_held_sideways_sounds_at_8_4333_hertz() {
    for (run, elements) in with_elements(&configurations(), 1) {
        let mesh = format!("size: (0.1, 0.01, 0.01), cells: (20, 2, 2), elements: {elements}");
        let mut simulation = bar(run, &mesh, "Fixed(on: All, axes: [Y, Z])", "duration: 0.7");
        let found = frequency(&mut simulation, 0, 2, |x| (PI * x / 0.2).sin());
        near(&format!("{}, {elements}", run.name), found, 8.4333, 8.4333, 1e-3);
    }
}

/// A quarter of the bar, with planes of symmetry.
#[test]
#[ignore = "long"]
fn slender_bar_sounds_at_4_3301_hertz() {
    let planes =
        "Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y]), Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [Z])";
    for (run, elements) in with_elements(&configurations(), 2) {
        let mesh = format!("size: (0.1, 0.005, 0.005), cells: (20, 1, 1), elements: {elements}");
        let mut simulation = bar(run, &mesh, planes, "duration: 0.7");
        let found = frequency(&mut simulation, 0, 2, |x| (PI * x / 0.2).sin());
        near(&format!("{}, {elements}", run.name), found, 4.3301 * (1.0 - 4.2e-4), 4.3301, 2e-3);
    }
}

/// The mode cosh κx − cos κx − .7341 (sinh κx − sin κx), κL = 1.8751.
#[test]
fn clamped_beam_swings_at_0_2798_hertz() {
    let shape = |x: f64| {
        let k = 18.751 * x;
        k.cosh() - k.cos() - 0.7341 * (k.sinh() - k.sin())
    };
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 4.5, bodies: {\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: (10, 1, 1), elements: Hex8), material: \"m\", velocity: (0, 0, 1e-4))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))])",
        );
        let found = frequency(&mut simulation, 2, 10, shape);
        near(run.name, found, 0.2798 * (1.0 - 0.0066), 0.2798, 0.01);
    }
}

/// Stiff (E = 3e4 Pa), so that it hardly lengthens (.1 %: the spin falls by that), and viscous, so that it comes to
/// rest within its own length. Across, the load of its own width is ρω² b²/12 = .33 Pa. f32: u is rounded by up to
/// 3.7e-9 m (half of its last place, .06 to .13 m), two nodes at worst against each other over h = .005 m: with κ = 1e5
/// Pa .15 Pa from each of three strains, .45 Pa or .9 % together, beside what f64 is allowed.
#[test]
fn spinning_bar_bears_its_centrifugal_load() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: (20, 2, 2), elements: Hex8), material: \"m\", spin: (0, 0, 6.283185307))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), prony: (terms: [(alpha: 0.5, tau: 0.006)]))},
            probes: {\"stress\": (what: Stress, on: Box(min: (0.045, 0, 0), max: (0.055, 0.01, 0.01)))})",
        );
        let steps = simulation.planned_steps();
        simulation.advance(steps).unwrap();
        // after a full turn; linear elements have the exact stress of lumped masses, the middle ones that of the middle
        let stress = simulation.probe("stress").unwrap();
        near(&format!("{}: σ along", run.name), stress[0], 49.348, 49.348, run.bound(0.01, 0.019));
        near(&format!("{}: σ across", run.name), stress[1], 0.33, 49.348, run.bound(0.01, 0.019));
    }
}

/// The front rings in the wake of a jump, by 1-D dispersion; means over the plateau do not.
#[test]
fn impact_runs_through_the_bar_at_the_speed_of_sound() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 0) {
        let cells = if elements == "Hex8" { "(80, 1, 1)" } else { "(40, 1, 1)" };
        let mut simulation = run.start(&format!(
            "(duration: 0.05, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.005, 0.005), cells: {cells}, elements: {elements}), material: \"m\", velocity: (-0.01, 0, 0))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: All, axes: [Y, Z]), Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X])],
            probes: {{\"stress\": (what: Stress, on: Box(min: (0.02, 0, 0), max: (0.04, 0.005, 0.005)))}})"
        ));
        let (arrival, mut found) = (0.0296444, None);
        let (mut sum, mut count, mut before) = (0.0, 0.0, (0.0, -0.01));
        while simulation.time() < 0.045 {
            simulation.advance(2).unwrap();
            let time = simulation.time();
            // the wake has passed .04 m by .4 of L/c, the echo is back there at 1.6
            if (0.6..1.4).contains(&(time / arrival)) {
                sum += simulation.probe("stress").unwrap()[0];
                count += 1.0;
            }
            let rest = simulation.rest_positions("b").unwrap();
            let tip = velocities(&mut simulation, "b")
                .iter()
                .zip(&rest)
                .filter(|(_, x)| x.x > 0.0999)
                .map(|(v, _)| v.x)
                .fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
            let tip = tip.0 / tip.1;
            // a free end goes from −v to +v as the front arrives
            if found.is_none() && tip > 0.0 {
                let half = simulation.time_step() / 2.0;
                found = Some(before.0 + (time - half - before.0) * -before.1 / (tip - before.1));
            }
            before = (time - simulation.time_step() / 2.0, tip);
        }
        let what = format!("{}, {elements}", run.name);
        near(&format!("{what}: σ"), sum / count, -33.7332, 33.7332, 0.01);
        // light corners run ahead of heavy middles: 3.0, 2.2 and 1.6 % with 1, 2 and 4 cells of Tet10 across
        let late = if elements == "Tet10" { 0.035 } else { 0.02 };
        near(&format!("{what}: arrival"), found.unwrap(), arrival, arrival, late);
    }
}
