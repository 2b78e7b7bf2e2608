//! What the formulas of implicit steps do in closed form: damping by mass and stiffness, how far generalised-α damps
//! what is much faster than its step, the linearised step of a body that turns, and energy without loads.

use crate::columns::{masses, positions, velocities};
use crate::configurations::{near, scene_of};
use crate::implicit::{SQUARE, options, oscillator, top};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::Precision;
use std::path::Path;

#[test]
fn damping_by_mass_and_stiffness_is_that_of_the_end() {
    let (h, mass, beta) = (0.01, 3.0, 0.02);
    let solver = "Implicit(scheme: Euler, step: 0.01, newton: 8, tolerance: 1e-9)";
    let mut simulation = oscillator(solver, &format!("damping: {mass}, stiffness_damping: {beta},"));
    // v⁺ D = v − h ω² x, D = 1 + h r_M + h (h + r_K) ω²
    let d = 1.0 + h * mass + h * (h + beta) * SQUARE;
    let [mut x, mut v] = [0.0, 1e-3];
    for _ in 0..30 {
        simulation.advance(1).unwrap();
        v = (v - h * SQUARE * x) / d;
        x += h * v;
        let found = top(&mut simulation);
        near("displacement", found[0], x, 1e-3 / SQUARE.sqrt(), 1e-8);
        near("velocity", found[1], v, 1e-3, 1e-8);
    }
}

/// At ω h = 2.4e3 all three eigenvalues of a step are −ρ∞, but for what 1/(ωh)² leaves: (z + ρ∞)³ takes every motion to
/// nothing.
#[test]
fn generalised_alpha_leaves_the_share_of_high_frequencies_that_it_is_told() {
    for share in [0.0, 0.5, 0.8, 1.0_f64] {
        let solver = format!(
            "Implicit(scheme: GeneralizedAlpha(high_frequencies: {share}), step: 100, newton: 8, tolerance: 1e-14)"
        );
        let mut simulation = oscillator(&solver, "");
        let mut x = vec![0.0];
        for _ in 0..10 {
            simulation.advance(1).unwrap();
            x.push(top(&mut simulation)[0]);
        }
        println!("{share}: {x:?}");
        let largest = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(largest > 0.0, "it must move for this to say something");
        for x in x.windows(4) {
            let left = x[3] + 3.0 * share * x[2] + 3.0 * share.powi(2) * x[1] + share.powi(3) * x[0];
            near("(z + ρ∞)³ x", left, 0.0, largest, 1e-5);
        }
    }
}

/// The one iteration of a linearised step is taken about where a body flies on to, not about where it stands: a stiff
/// body is not swollen by √(1 + θ²), θ = hω, but turned by atan θ as by all iterations, and 1/√(1 + θ²) of its angular
/// momentum is left, but for squares of ½ θ².
#[test]
fn the_linearised_step_of_a_body_that_turns_is_that_about_where_it_flies_to() {
    let (h, spin) = (0.01, 10.0_f64);
    for law in ["neo_hookean", "corotational"] {
        let scene = format!(
            "(duration: 1, solver: Implicit(step: {h}, newton: 1, tolerance: 1e-10),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8MeanDilatation), material: \"m\", spin: (0, 0, {spin}))}},
            materials: {{\"m\": (density: 1000, {law}: Young(young: 1e8, poisson: 0.3))}})"
        );
        let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(Precision::F64, 1)).unwrap();
        let moment = |simulation: &mut Simulation| -> DVec3 {
            let (x, v, m) = (positions(simulation, "b"), velocities(simulation, "b"), masses(simulation, "b"));
            (0..x.len()).map(|i| m[i] * (x[i] - DVec3::splat(0.05)).cross(v[i])).sum()
        };
        let before = moment(&mut simulation);
        simulation.advance(1).unwrap();
        let after = moment(&mut simulation);
        println!("{law}: {before} {after}");
        let swollen = (1.0 + (h * spin).powi(2)).sqrt();
        near("angular momentum", after.z, before.z / swollen, before.z, 5e-5);
        let (rest, x) = (simulation.rest_positions("b").unwrap().to_vec(), positions(&mut simulation, "b"));
        let radius = |at: DVec3| (at - DVec3::splat(0.05)).truncate().length();
        for (rest, x) in rest.iter().zip(&x).filter(|(rest, _)| radius(**rest) > 0.01) {
            near("radius", radius(*x), radius(*rest), radius(*rest), 5e-5);
        }
    }
}

/// Implicit Euler of a body that is let go bent and twisted, without loads: kinetic and elastic energy only fall.
#[test]
fn without_loads_implicit_euler_only_takes_energy() {
    for law in ["neo_hookean", "corotational", "linear"] {
        let scene = format!(
            "(duration: 1, solver: Implicit(step: 0.01, tolerance: 1e-10),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.03, 0.03), cells: (8, 2, 2), elements: Tet4), material: \"m\",
                start: Affine(gradient: ((0.1, 0.05, 0), (0, -0.05, 0.1), (0.2, 0, -0.05))))}},
            materials: {{\"m\": (density: 1000, {law}: Young(young: 3e3, poisson: 0.3))}},
            constraints: [Fixed(on: Set(\"x0\"))], output: (energies_every: 0.01))"
        );
        let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(Precision::F64, 1)).unwrap();
        let energy = |simulation: &mut Simulation| {
            let e = simulation.energies().unwrap();
            e.kinetic + e.strain + e.hourglass
        };
        let start = energy(&mut simulation);
        let mut before = start;
        for step in 0..60 {
            simulation.advance(1).unwrap();
            let now = energy(&mut simulation);
            assert!(now <= before + 1e-9 * start, "{law}, step {step}: {now:e} after {before:e} of {start:e}");
            before = now;
        }
        println!("{law}: {start:e}, {before:e}");
        assert!(before < 0.5 * start, "{law}: {before:e} of {start:e}");
    }
}
