//! Loads against their formulas, as kernels hand them to the integrator.
//!
//! Σ forces: n f (`Each`), f (`Total`), m g, t A; pressure −p ∮ n da with n da = J F⁻ᵀ N dA for homogeneous F.
//! Bounds: sums of 50 to 100 terms: 1e-13 in f64, 1e-5 in f32 of the largest force.

use crate::columns::{external_forces, positions};
use crate::configurations::{Configuration, configurations, cpu_and_long_gpu};
use crate::element_turns::with_elements;
use crate::random::{Random, rows};
use glam::{DMat3, DVec3};
use sinew::Simulation;
use sinew::scene::schema::Curve;

fn start(run: &Configuration, elements: &str, constraints: &str, load: &str) -> Simulation {
    run.start(&format!(
        "(duration: 0.01, bodies: {{\"b\": (mesh: Box(size: (0.3, 0.2, 0.4), cells: (3, 2, 4), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [{constraints}], loads: [{load}], integration: (step: 1e-4))"
    ))
}

fn forces(run: &Configuration, elements: &str, constraints: &str, load: &str) -> (Vec<DVec3>, Vec<DVec3>) {
    let mut simulation = start(run, elements, constraints, load);
    // the first step brings prescribed nodes to their places, the second sees them there
    simulation.advance(2).unwrap();
    (external_forces(&mut simulation, "b"), positions(&mut simulation, "b"))
}

#[track_caller]
fn is(run: &Configuration, what: &str, found: DVec3, expected: DVec3, scale: f64) {
    let error = (found - expected).length() / scale;
    assert!(error < run.bound(1e-12, 1e-5), "{}, {what}: {found} instead of {expected}: {error:e}", run.name);
}

/// More than a kernel has room for parameters of: 1 + 2 + … + 40 thousandths of a newton a node.
#[test]
fn there_may_be_any_number_of_loads() {
    let on = "on: Plane(normal: (0, 0, 1), at: 0.4)";
    let loads: Vec<String> =
        (1..=40).map(|i| format!("NodalForce({on}, force: (0, {}, 0))", 1e-3 * f64::from(i))).collect();
    for run in &configurations() {
        let (forces, _) = forces(run, "Tet4", "Fixed(on: Plane(normal: (0, 0, 1), at: 0))", &loads.join(", "));
        let sum: DVec3 = forces.iter().sum();
        is(run, "sum", sum, DVec3::new(0.0, 0.82 * 12.0, 0.0), 0.82 * 12.0);
    }
}

#[test]
fn nodal_forces_are_each_or_in_total_what_the_scene_says() {
    for run in &configurations() {
        let force = DVec3::new(0.1, -0.2, 0.3);
        let of = |share: &str| {
            let load =
                format!("NodalForce(on: Plane(normal: (0, 0, 1), at: 0.4), force: (0.1, -0.2, 0.3), share: {share})");
            forces(run, "Hex8", "", &load).0
        };
        // 4 × 3 nodes on top
        is(run, "Each", of("Each").iter().sum(), force * 12.0, 12.0 * force.length());
        is(run, "Total", of("Total").iter().sum(), force, force.length());
        assert_eq!(of("Each").iter().filter(|f| **f != DVec3::ZERO).count(), 12);
    }
}

#[test]
fn gravity_is_mass_times_acceleration() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 0) {
        let (forces, _) = forces(run, elements, "", "Gravity(acceleration: (1, 2, -9.81))");
        let expected = DVec3::new(1.0, 2.0, -9.81) * 24.0;
        is(run, elements, forces.iter().sum(), expected, expected.length());
    }
}

#[test]
fn pressure_all_around_exerts_no_net_force_and_no_moment_at_any_deformation() {
    let mut random = Random(51);
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 1) {
        for _ in 0..4 {
            let f = random.rotation() * random.deformation();
            let told = format!("Prescribed(on: All, gradient: {})", rows(f - DMat3::IDENTITY));
            let (forces, positions) = forces(run, elements, &told, "Pressure(on: Surface(), pressure: 700)");
            let scale = forces.iter().map(|f| f.length()).sum::<f64>();
            assert!(scale > 1.0);
            is(run, "net force", forces.iter().sum(), DVec3::ZERO, scale);
            is(run, "moment", forces.iter().zip(&positions).map(|(f, x)| x.cross(*f)).sum(), DVec3::ZERO, scale);
        }
    }
}

/// A warped surface too: free nodes of a body in motion.
#[test]
fn pressure_all_around_a_body_in_motion_exerts_no_net_force() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 2) {
        let load = "NodalForce(on: Nodes([0, 7]), force: (3, 5, -4)), NodalForce(on: Nodes([59]), force: (-6, -10, 8)), Pressure(on: Surface(), pressure: 50)";
        let mut simulation = start(run, elements, "", load);
        simulation.advance(100).unwrap();
        let mut net: DVec3 = external_forces(&mut simulation, "b").iter().sum();
        net -= DVec3::new(3.0, 5.0, -4.0) * 2.0 + DVec3::new(-6.0, -10.0, 8.0);
        is(run, elements, net, DVec3::ZERO, 50.0 * 0.52);
    }
}

#[test]
#[ignore = "long"]
fn pressure_follows_the_surface_and_traction_does_not() {
    let mut random = Random(52);
    for (run, elements) in with_elements(&configurations(), 0) {
        for _ in 0..4 {
            let f = random.rotation() * random.deformation();
            let told = format!("Prescribed(on: All, gradient: {})", rows(f - DMat3::IDENTITY));
            let (pushed, _) =
                forces(run, elements, &told, "Pressure(on: Plane(normal: (1, 0, 0), at: 0.3), pressure: 700)");
            let area = f.determinant() * (f.inverse().transpose() * DVec3::X) * 0.08;
            is(run, "pressure", pushed.iter().sum(), area * -700.0, 700.0 * area.length());
            let (pulled, _) =
                forces(run, elements, &told, "Traction(on: Plane(normal: (1, 0, 0), at: 0.3), traction: (10, 20, 30))");
            let expected = DVec3::new(10.0, 20.0, 30.0) * 0.08;
            is(run, "traction", pulled.iter().sum(), expected, expected.length());
        }
    }
}

fn smooth(s: f64) -> f64 {
    10.0 * s.powi(3) - 15.0 * s.powi(4) + 6.0 * s.powi(5)
}

#[test]
fn curves_are_their_formulas() {
    let share = |t: f64, start: f64, end: f64| ((t - start) / (end - start)).clamp(0.0, 1.0);
    for n in -10..60 {
        let t = f64::from(n) * 0.05;
        let factor = |on: bool| if on { 1.0 } else { 0.0 };
        let cases = [
            (Curve::Step { start: 0.5, end: None }, factor(t >= 0.5)),
            (Curve::Step { start: 0.5, end: Some(1.0) }, factor((0.5..1.0).contains(&t))),
            (Curve::Ramp { start: 0.5, end: 1.5 }, share(t, 0.5, 1.5)),
            (Curve::Smooth { start: 0.5, end: 1.5 }, smooth(share(t, 0.5, 1.5))),
            (
                Curve::Table(vec![(0.5, 1.0), (1.0, -2.0), (2.0, 3.0)]),
                match t {
                    t if t < 0.5 => 1.0,
                    t if t < 1.0 => 1.0 - 6.0 * (t - 0.5),
                    t if t < 2.0 => -2.0 + 5.0 * (t - 1.0),
                    _ => 3.0,
                },
            ),
        ];
        for (curve, expected) in cases {
            assert!(
                (curve.value(t) - expected).abs() < 1e-14,
                "{curve:?} at {t}: {} instead of {expected}",
                curve.value(t)
            );
        }
    }
}

/// Forces in step n are those of the curve at its beginning, n Δt.
/// Of many values in a window of a step of 1e-4 s about the step's beginning; the first window begins there.
fn mean_over_the_step(formula: fn(f64) -> f64, step: u64) -> f64 {
    const COUNT: u32 = 20_000;
    let middle = step as f64 * 1e-4;
    let (from, to) = (if step == 0 { 0.0 } else { middle - 0.5e-4 }, middle + 0.5e-4);
    (0..COUNT).map(|i| formula(from + (to - from) * (f64::from(i) + 0.5) / f64::from(COUNT))).sum::<f64>()
        / f64::from(COUNT)
}

#[test]
fn loads_follow_their_curves() {
    let curves = [
        (
            "Step(start: 0.002, end: 0.004)",
            (|t| f64::from((0.002 - 1e-9..0.004 - 1e-9).contains(&t))) as fn(f64) -> f64,
        ),
        ("Ramp(start: 0.001, end: 0.003)", |t| ((t - 0.001) / 0.002).clamp(0.0, 1.0)),
        ("Smooth(end: 0.004)", |t| smooth((t / 0.004).min(1.0))),
        ("Table([(0, 2), (0.002, -1)])", |t| 2.0 - 3.0 * (t / 0.002).min(1.0)),
    ];
    for run in &cpu_and_long_gpu() {
        for (curve, formula) in curves {
            let load = format!("Gravity(acceleration: (0, 0, -1), curve: {curve})");
            let mut simulation = start(run, "Hex8", "", &load);
            for step in [0, 9, 10, 15, 20, 25, 39, 40, 50] {
                simulation.advance(step + 1 - simulation.step_count()).unwrap();
                let net: DVec3 = external_forces(&mut simulation, "b").iter().sum();
                let mean = mean_over_the_step(formula, step);
                is(run, &format!("{curve}, step {step}"), net, DVec3::NEG_Z * 24.0 * mean, 24.0);
            }
        }
    }
}
