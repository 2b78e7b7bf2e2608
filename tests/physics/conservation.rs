//! What must stay the same: momentum, angular momentum, energy; and free fall.
//!
//! Central differences keep Σ m v and Σ m x × v (x at the end, v in the middle of a step) exactly when elements exert
//! no net force and no net moment: what is left is rounding, 1e-10 in f64 and 1e-4 in f32 (gate G4). The balance of
//! energy (gate G2) uses accumulated work: |KE + IE + HG + losses − W − E₀| below 1 % in f64, 2 % in f32 of the largest
//! term.

use crate::columns::{masses, positions, velocities};
use crate::configurations::{configurations, cpu_and_long_gpu, near};
use crate::element_turns::with_elements;
use glam::DVec3;
use sinew::Simulation;

/// u = g t²/2 from rest, v₀ t + g t²/2 with a start: exact, because the first half step is started with half.
/// n steps round by n eps at most: 1e3·1e-16 in f64; f32 sums displacements with compensation but steps without: n eps.
#[test]
fn free_fall_is_exact() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 1) {
        let mut simulation = run.start(&format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2), elements: {elements}), material: \"m\", velocity: (0.5, 0, 2))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            loads: [Gravity(acceleration: (0, 0, -9.81))], integration: (step: 0.01))"
        ));
        simulation.advance(100).unwrap();
        assert_eq!(simulation.time(), 100.0 * 0.01, "time is a number of steps");
        for u in simulation.displacements("b").unwrap() {
            let expected = DVec3::new(0.5, 0.0, 2.0 - 4.905);
            let error = (u - expected).length() / expected.length();
            assert!(error < run.bound(1e-12, 1e-5), "{}, {elements}: {u}, error {error:e}", run.name);
        }
    }
}

fn momenta(simulation: &mut Simulation) -> (DVec3, DVec3) {
    let (m, x, v) = (masses(simulation, "b"), positions(simulation, "b"), velocities(simulation, "b"));
    let momentum = (0..m.len()).map(|i| v[i] * m[i]).sum();
    (momentum, (0..m.len()).map(|i| x[i].cross(v[i]) * m[i]).sum())
}

#[test]
#[ignore = "long"]
fn free_body_keeps_its_momentum_and_angular_momentum() {
    for (run, elements) in with_elements(&configurations(), 2) {
        for effects in ["", "fibres: (eta: 2000, direction: Along(1, 2, 3)), prony: (terms: [(alpha: 0.5, tau: 0.1)])"]
        {
            let mut simulation = run.start(&format!(
                "(duration: 2, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.08, 0.06), cells: (3, 3, 2), elements: {elements}), material: \"m\", velocity: (0.02, -0.01, 0.03), spin: (3, -5, 8))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), {effects})}}, integration: (safety: 0.5))"
            ));
            simulation.advance(1).unwrap();
            let before = momenta(&mut simulation);
            simulation.advance(800).unwrap();
            let after = momenta(&mut simulation);
            let stretch =
                simulation.fields("b").unwrap().stress.iter().fold(0.0_f64, |largest, s| largest.max(s[0].abs()));
            assert!(stretch > 1.0, "the body must be deformed for this to say something: {stretch} Pa");
            let errors =
                [(after.0 - before.0).length() / before.0.length(), (after.1 - before.1).length() / before.1.length()];
            println!("{}, {elements}: momentum {:.1e}, angular {:.1e}", run.name, errors[0], errors[1]);
            assert!(errors.iter().all(|&error| error < run.bound(1e-10, 1e-4)), "{}, {elements}: {errors:?}", run.name);
        }
    }
}

/// Relative imbalance of energy by accumulated work; elastic energy as the laws have it, or with viscosity as counted.
fn imbalance(simulation: &mut Simulation, start: f64, viscous: bool) -> f64 {
    let e = simulation.energies().unwrap();
    println!("{e:?}");
    let stored = if viscous { e.internal_work.unwrap() } else { e.strain + e.hourglass };
    let (loads, constraints) = (e.load_work.unwrap(), e.constraint_work.unwrap());
    let sum = e.kinetic + stored + e.damping_loss.unwrap() - loads - constraints - start;
    let scale = (e.kinetic + stored).max(loads.abs()).max(constraints.abs()).max(start);
    assert!(scale > 0.0);
    sum.abs() / scale
}

#[test]
fn energy_balances() {
    let cases = [
        ("gravity", "Fixed(on: Plane(normal: (0, 0, 1), at: 0))", "Gravity(acceleration: (3, 0, -9.81))", ""),
        (
            "pressure",
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0))",
            "Pressure(on: Surface(normal: (1, 0, 0)), pressure: 300, curve: Ramp(end: 0.1))",
            "",
        ),
        (
            "traction",
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0))",
            "Traction(on: Surface(normal: (0, 0, 1)), traction: (100, 0, 100))",
            "",
        ),
        (
            "nodal force",
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0))",
            "NodalForce(on: Plane(normal: (0, 0, 1), at: 0.1), force: (0.3, 0, 0), share: Total)",
            "",
        ),
        (
            "prescribed motion",
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0.02, 0, 0.02), rotation: (0, 0, 30), center: (0.05, 0.05, 0.1), curve: Smooth(end: 0.2))",
            "",
            "",
        ),
        (
            "damping",
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0))",
            "Gravity(acceleration: (3, 0, -9.81))",
            "damping: 20,",
        ),
        (
            "viscosity",
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0))",
            "Gravity(acceleration: (3, 0, -9.81))",
            "prony: (terms: [(alpha: 0.5, tau: 0.1)]),",
        ),
        ("fibres", "", "", "fibres: (eta: 2000, direction: Along(1, 1, 0), tension_only: true),"),
    ];
    for (turn, (name, constraints, loads, effects)) in cases.into_iter().enumerate() {
        for (run, elements) in with_elements(&cpu_and_long_gpu(), turn) {
            let spin = if name == "fibres" { "velocity: (0.1, 0, 0), spin: (0, 3, 8)" } else { "" };
            let mut simulation = run.start(&format!(
                "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: {elements}), material: \"m\", {spin})}},
                materials: {{\"m\": (density: 1000, {effects} neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                constraints: [{constraints}], loads: [{loads}], output: (energies_every: 0.01), integration: (bound: Elements, safety: 0.6))"
            ));
            let start = {
                // ½ m v² of the start, lumped as the engine has it
                let (m, x) = (masses(&mut simulation, "b"), simulation.rest_positions("b").unwrap());
                let center: DVec3 = (0..m.len()).map(|i| x[i] * m[i]).sum::<DVec3>() / m.iter().sum::<f64>();
                let v = |x: DVec3| DVec3::new(0.1, 0.0, 0.0) + DVec3::new(0.0, 3.0, 8.0).cross(x - center);
                if spin.is_empty() { 0.0 } else { (0..m.len()).map(|i| 0.5 * m[i] * v(x[i]).length_squared()).sum() }
            };
            let mut worst: f64 = 0.0;
            for part in 1..=6 {
                simulation.advance_to(0.2 * f64::from(part) / 6.0).unwrap();
                worst = worst.max(imbalance(&mut simulation, start, name == "viscosity"));
            }
            near("the end", simulation.time(), 0.2, 0.2, 1e-12);
            println!("{name}, {}, {elements}: {worst:.2e}", run.name);
            assert!(worst < run.bound(0.01, 0.02), "{name}, {}, {elements}: {worst:e}", run.name);
        }
    }
}

/// What viscosity takes is what internal forces were given and do not store, and is never negative in the end.
#[test]
fn viscosity_takes_energy() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: \"m\", spin: (0, 3, 8))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), prony: (terms: [(alpha: 0.5, tau: 0.05)]))},
            output: (energies_every: 0.1))",
        );
        simulation.advance(5).unwrap();
        let start = simulation.energies().unwrap();
        simulation.advance_to(1.0).unwrap();
        let end = simulation.energies().unwrap();
        let total = |e: &sinew::components::Energies| e.kinetic + e.internal_work.unwrap();
        near(&format!("{}: total", run.name), total(&end), total(&start), start.kinetic, run.bound(1e-6, 1e-4));
        assert!(end.kinetic < start.kinetic, "{}: {start:?} {end:?}", run.name);
    }
}
