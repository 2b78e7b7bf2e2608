//! Implicit steps against closed forms, explicit steps and themselves.
//!
//! One degree of freedom: a tetrahedron with three nodes held and the fourth free along z, linear law. Its frequency is
//! found from the force of a displacement; what is left is rounding and the tolerance of steps, 1e-12 of an amplitude.

use crate::columns::{masses, positions, velocities};
use crate::configurations::{near, scene_of};
use glam::DVec3;
use sinew::components::Precision;
use sinew::{BackendChoice, Options, Simulation};
use std::path::Path;

pub fn options(precision: Precision, threads: usize) -> Options {
    Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() }
}

pub fn start(scene: &str) -> Simulation {
    Simulation::new(&scene_of(scene, Path::new(".")), &options(Precision::F64, 1)).unwrap()
}

/// A single cell whose top can move along z only, at 1 m/s: one degree of freedom four times over.
pub fn oscillator(solver: &str, damping: &str) -> Simulation {
    oscillator_on(solver, damping, &options(Precision::F64, 1))
}

/// The same with other options.
pub fn oscillator_on(solver: &str, damping: &str, options: &Options) -> Simulation {
    let scene = format!(
        "(duration: 1e5, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1), elements: Hex8MeanDilatation), material: \"m\", velocity: (0, 0, 1e-3))}},
        materials: {{\"m\": (density: 1000, {damping} linear: Young(young: 3e3, poisson: 0))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Fixed(on: Plane(normal: (0, 0, 1), at: 0.1), axes: [X, Y])],
        output: (energies_every: 1000))"
    );
    Simulation::new(&scene_of(&scene, Path::new(".")), options).unwrap()
}

/// ω² = K/m of it: E A/l over a half of its mass, as a quarter of each belongs to a node.
pub const SQUARE: f64 = 3e3 * 0.01 / 0.1 / 0.5;

const EULER: &str = "Implicit(scheme: Euler, step: 0.01, newton: 8, tolerance: 1e-14)";

/// The displacement and velocity of a node of the top.
pub fn top(simulation: &mut Simulation) -> [f64; 2] {
    let (x, v) = (simulation.displacements("b").unwrap(), velocities(simulation, "b"));
    let rest = simulation.rest_positions("b").unwrap();
    let node = (0..rest.len()).find(|&i| rest[i].z > 0.09).unwrap();
    [x[node].z, v[node].z]
}

/// x_n = Im z^n / ω · v₀, v_n = Re z^n v₀ with z = 1/(1 − iωh), for 40 steps of implicit Euler.
pub fn oscillates_as_its_closed_form(mut simulation: Simulation, tolerance: f64) {
    let (h, omega) = (0.01, SQUARE.sqrt());
    let (modulus, phase) = ((1.0 + SQUARE * h * h).powf(-0.5), (omega * h).atan());
    for n in 1..=40 {
        simulation.advance(1).unwrap();
        let (size, [x, v]) = (1e-3 * modulus.powi(n), top(&mut simulation));
        near("displacement", x, size * (phase * f64::from(n)).sin() / omega, 1e-3 / omega, tolerance);
        near("velocity", v, size * (phase * f64::from(n)).cos(), 1e-3, tolerance);
    }
}

#[test]
fn implicit_euler_of_one_degree_of_freedom_is_its_closed_form() {
    oscillates_as_its_closed_form(oscillator(EULER, ""), 1e-12);
}

#[test]
fn the_trapezoidal_rule_keeps_amplitude_and_shifts_frequency_as_told() {
    let solver = "Implicit(scheme: GeneralizedAlpha(high_frequencies: 1), step: 0.01, newton: 8, tolerance: 1e-14)";
    let mut simulation = oscillator(solver, "");
    let (h, omega) = (0.01, SQUARE.sqrt());
    let phase = 2.0 * (0.5 * omega * h).atan();
    for n in 1..=40 {
        simulation.advance(1).unwrap();
        let [x, v] = top(&mut simulation);
        near("displacement", x, 1e-3 * (phase * f64::from(n)).sin() / omega, 1e-3 / omega, 1e-11);
        near("velocity", v, 1e-3 * (phase * f64::from(n)).cos(), 1e-3, 1e-11);
    }
}

#[test]
fn what_euler_takes_is_booked() {
    let mut simulation = oscillator(EULER, "");
    let mass = 4.0 * 0.125;
    let before = 0.5 * mass * 1e-6;
    let (mut lost, [mut u, mut v]) = (0.0, [0.0, 1e-3]);
    for _ in 0..30 {
        simulation.advance(1).unwrap();
        let [x, w] = top(&mut simulation);
        lost += 0.5 * mass * (w - v).powi(2) + 0.5 * mass * SQUARE * (x - u).powi(2);
        [u, v] = [x, w];
    }
    let found = simulation.energies().unwrap();
    assert!(lost > 0.5 * before, "it must be damped for this to say something: {lost} of {before}");
    near("loss of the scheme", found.scheme_loss.unwrap(), lost, before, 1e-12);
    let balance = found.kinetic + found.strain + found.scheme_loss.unwrap();
    near("energy", balance, before, before, 1e-12);
}

/// A cube under its weight; the mean displacement of its top after some time, and the simulation.
pub fn cube(solver: &str, elements: &str, effects: &str, time: f64, options: &Options) -> (f64, Simulation) {
    let scene = format!(
        "(duration: 1, {solver}
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, {effects} neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: (0.5, 0, -2), curve: Smooth(end: 0.2)), Pressure(on: Surface(normal: (1, 0, 0)), pressure: 30, curve: Smooth(end: 0.1))])"
    );
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), options).unwrap();
    simulation.advance_to(time).unwrap();
    let rest = simulation.rest_positions("b").unwrap().to_vec();
    let u = simulation.displacements("b").unwrap();
    let top: Vec<f64> = (0..u.len()).filter(|&i| rest[i].z > 0.0999).map(|i| u[i].z).collect();
    (top.iter().sum::<f64>() / top.len() as f64, simulation)
}

pub const EFFECTS: &str =
    "fibres: (eta: 2000, direction: Along(1, 2, 3)), prony: (terms: [(alpha: 0.5, tau: 0.1)]), damping: 2,";

#[test]
fn any_number_of_threads_gives_the_same_bits_and_counts() {
    let solver = "solver: Implicit(scheme: GeneralizedAlpha(), step: 0.01),";
    let runs: Vec<_> = [1, 2, 3]
        .map(|threads| {
            let (_, mut simulation) = cube(solver, "Tet4", EFFECTS, 0.2, &options(Precision::F32, threads));
            let bits: Vec<[u64; 3]> =
                simulation.displacements("b").unwrap().iter().map(|u| u.to_array().map(f64::to_bits)).collect();
            (bits, simulation.implicit_steps().unwrap())
        })
        .into();
    println!("{:?}", runs[0].1);
    assert!(runs[0].1.newton_iterations > 10, "{:?}", runs[0].1);
    assert!(runs.iter().all(|run| *run == runs[0]));
}

#[test]
fn a_run_resumed_goes_on_with_the_same_bits() {
    for scheme in ["Euler", "GeneralizedAlpha()"] {
        let solver = format!(
            "solver: Implicit(scheme: {scheme}, step: 0.01),
            removal: [(on: Sphere(center: (0.1, 0.1, 0.1), radius: 0.05), when: At(0.045))],"
        );
        let f32s = options(Precision::F32, 1);
        let (_, mut whole) = cube(&solver, "Tet4", EFFECTS, 0.2, &f32s);
        let (_, mut first) = cube(&solver, "Tet4", EFFECTS, 0.1, &f32s);
        let state = first.snapshot().unwrap();
        let (_, mut second) = cube(&solver, "Tet4", EFFECTS, 0.0, &f32s);
        second.restore(&state).unwrap();
        second.advance_to(0.2).unwrap();
        assert_eq!(whole.displacements("b").unwrap(), second.displacements("b").unwrap(), "{scheme}");
        first.reset().unwrap();
        first.advance_to(0.2).unwrap();
        assert_eq!(whole.displacements("b").unwrap(), first.displacements("b").unwrap(), "{scheme}, reset");
    }
}

#[test]
fn masses_and_two_levels_keep_momentum_however_early_a_solve_ends() {
    let run = |preconditioner: &str| {
        let mut simulation = start(&format!(
            "(duration: 1, solver: Implicit(step: 0.01, preconditioner: {preconditioner}, budget: 4),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.08, 0.06), cells: (3, 3, 2), elements: Tet4), material: \"m\", velocity: (0.02, -0.01, 0.03), spin: (3, -5, 8))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}})"
        ));
        let momentum = |simulation: &mut Simulation| -> DVec3 {
            let (m, v) = (masses(simulation, "b"), velocities(simulation, "b"));
            (0..m.len()).map(|i| v[i] * m[i]).sum()
        };
        let before = momentum(&mut simulation);
        simulation.advance(20).unwrap();
        let most = simulation.implicit_steps().unwrap().most_passes;
        assert!(most <= 6, "{most} passes, where budget + 2 are allowed");
        (momentum(&mut simulation) - before).length() / before.length()
    };
    let (mass, two, none) = (run("Mass"), run("TwoLevel"), run("Identity"));
    println!("momentum lost: {mass:e} with masses, {two:e} with two levels, {none:e} without");
    // differences of forces round to eps over their strain, 2.2e-16/1e-7
    assert!(mass.max(two) < 2.2e-9 && none > 10.0 * mass.max(two), "{mass:e}, {two:e}, {none:e}");
}

/// θ⁺ = atan2(sin θ, 2 − cos θ) of a body that is stiff against its spin.
#[test]
fn a_stiff_body_that_turns_slows_down_as_told() {
    let (h, spin) = (0.01, 10.0_f64);
    let mut simulation = start(&format!(
        "(duration: 1, solver: Implicit(step: {h}, newton: 30, tolerance: 1e-9),
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1), elements: Hex8MeanDilatation), material: \"m\", spin: (0, 0, {spin}))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e8, poisson: 0.3))}})"
    ));
    let angle = |simulation: &mut Simulation| {
        let (rest, x) = (simulation.rest_positions("b").unwrap().to_vec(), positions(simulation, "b"));
        let centre = x.iter().sum::<DVec3>() / 8.0 - rest.iter().sum::<DVec3>() / 8.0;
        let at = (0..8).find(|&i| rest[i].x > 0.04 && rest[i].y > 0.04).unwrap();
        let middle = rest.iter().sum::<DVec3>() / 8.0;
        let (a, b) = (rest[at] - middle, x[at] - centre - middle);
        (a.x * b.y - a.y * b.x).atan2(a.x * b.x + a.y * b.y)
    };
    simulation.advance(1).unwrap();
    // the first step begins on the tangent: θ = atan(h ω)
    let mut expected = (h * spin).atan();
    let mut before = angle(&mut simulation);
    near("first angle", before, expected, expected, 1e-4);
    for _ in 0..20 {
        expected = expected.sin().atan2(2.0 - expected.cos());
        simulation.advance(1).unwrap();
        let now = angle(&mut simulation);
        near("angle", now - before, expected, expected, 1e-3);
        before = now;
    }
}

#[test]
fn a_step_that_is_not_found_is_told_and_leaves_the_last_state() {
    let mut simulation = start(
        "(duration: 1, solver: Implicit(step: 0.01),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), prony: (terms: [(alpha: 0.5, tau: 0.1)]))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, -0.15), curve: Step(start: 0.045))])",
    );
    simulation.advance(4).unwrap();
    let before = simulation.displacements("b").unwrap();
    let error = simulation.advance(1).unwrap_err().to_string();
    println!("{error}");
    assert!(error.contains("implicit step") && error.contains("was not found"), "{error}");
    assert!(error.contains("no descent after"), "{error}");
    assert_eq!((simulation.displacements("b").unwrap(), simulation.step_count()), (before, 4));
}

/// Steps of bodies that have come to rest begin within the tolerance, and leave nothing that needs a word.
#[test]
fn steps_at_rest_leave_no_residual_to_speak_of() {
    let mut simulation = start(
        "(duration: 2, solver: Implicit(step: 0.02),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 60)},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Pressure(on: Plane(normal: (0, 0, 1), at: 0.1), pressure: 100, curve: Smooth(end: 0.1))])",
    );
    simulation.finish().unwrap();
    let counts = simulation.implicit_steps().unwrap();
    assert!(counts.newton_iterations < counts.steps, "none is needed at rest: {counts:?}");
    assert_eq!((counts.unsolved, counts.largest_residual_left), (0, 0.0), "{counts:?}");
    assert!(simulation.summary("finished").unwrap().guards.warnings.is_empty());
}

#[test]
fn prescribed_motion_goes_where_it_should_and_gives_its_work() {
    let mut simulation = start(
        "(duration: 0.4, solver: Implicit(scheme: GeneralizedAlpha(), step: 0.01, tolerance: 1e-8),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0.02, 0, 0.02), rotation: (0, 0, 30), center: (0.05, 0.05, 0.1), curve: Smooth(end: 0.3))],
        output: (energies_every: 0.1))",
    );
    // on the way, where a share that is left behind would show, and at the end
    for (time, share) in [(0.1, 17.0 / 81.0), (0.4, 1.0)] {
        simulation.advance_to(time).unwrap();
        let (rest, x) = (simulation.rest_positions("b").unwrap().to_vec(), positions(&mut simulation, "b"));
        let (sin, cos) = (30.0_f64.to_radians() * share).sin_cos();
        for (rest, x) in rest.iter().zip(&x).filter(|(rest, _)| rest.z > 0.0999) {
            let arm = *rest - DVec3::new(0.05, 0.05, 0.1);
            let turned = DVec3::new(cos * arm.x - sin * arm.y, sin * arm.x + cos * arm.y, arm.z);
            let expected = DVec3::new(0.05, 0.05, 0.1) + DVec3::new(0.02, 0.0, 0.02) * share + turned;
            assert!((*x - expected).length() < 1e-9, "{x}, expected {expected}");
        }
    }
    let e = simulation.energies().unwrap();
    let sum = e.kinetic + e.strain + e.hourglass + e.scheme_loss.unwrap() - e.constraint_work.unwrap();
    near("energy", sum, 0.0, e.strain, 0.01);
    assert!(e.strain > 1e-3 && e.scheme_loss.unwrap().abs() < 0.05 * e.strain, "{e:?}");
}

/// Of a body that is moved evenly no forces are left to compare a residual with: what is moved as told leads there.
#[test]
fn a_body_that_is_moved_evenly_goes_along() {
    for (law, step) in [("corotational", 0.005), ("neo_hookean", 0.02), ("neo_hookean", 0.001)] {
        for curve in ["Ramp(end: 0.3)", "Ramp(end: 0.05)", "Smooth(end: 0.3)"] {
            let mut simulation = start(&format!(
                "(duration: 0.3, solver: Implicit(step: {step}),
                bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (2, 2, 1), elements: Hex8MeanDilatation), material: \"m\")}},
                materials: {{\"m\": (density: 1000, {law}: Young(young: 5e4, poisson: 0.3), stiffness_damping: 1e-3)}},
                constraints: [Prescribed(on: Set(\"z0\"), displacement: (0.03, 0, 0), curve: {curve})])"
            ));
            simulation.finish().unwrap();
            let far =
                simulation.displacements("b").unwrap().iter().map(|u| u.distance(0.03 * DVec3::X)).fold(0.0, f64::max);
            near(&format!("{law}, {step} s, {curve}"), far, 0.0, 0.03, 2e-3);
            let counts = simulation.implicit_steps().unwrap();
            assert_eq!(counts.unsolved, 0, "{counts:?}");
        }
    }
}

/// What is told of a scene with a solver and something else in it.
pub fn refused(solver: &str, more: &str) -> String {
    let text = format!(
        "(duration: 0.1, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, {more})"
    );
    let scene = match sinew::SceneFile::from_text("test", &text, Path::new("."), &[]) {
        Ok(scene) => scene,
        Err(wrong) => return wrong.render(false),
    };
    match Simulation::new(&scene, &options(Precision::F64, 1)) {
        Ok(_) => "nothing".into(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn what_implicit_steps_cannot_do_is_refused_by_name() {
    let cases = [
        ("Implicit(step: 0)", "", "`step` must be above 0"),
        ("Implicit(newton: 0)", "", "`newton` must be at least 1"),
        ("Implicit(budget: 0)", "", "`budget` must be at least 3"),
        ("Implicit(budget: 2)", "", "`budget` must be at least 3"),
        ("Implicit(tolerance: 1)", "", "`tolerance` must be above 0 and below 1"),
        ("Implicit(scheme: GeneralizedAlpha(high_frequencies: 1.5))", "", "`high_frequencies` must be from 0 to 1"),
        ("Implicit(preconditioner: Best)", "", "Best"),
        ("Implicit(step: 0.01)", "integration: (step: 0.001)", "this is the step of explicit steps"),
        (
            "Implicit(step: 0.01)",
            "integration: (when_unstable: ScaleMass())",
            "implicit steps are stable at any length",
        ),
        (
            "Implicit(step: 0.01)",
            "schedule: [\"element_forces\", \"gather\", \"integrate\", \"observe\"]",
            "`integrate` takes no part in implicit steps",
        ),
        (
            "Implicit(step: 0.01)",
            "tools: {\"t\": (shape: Sphere(radius: 0.01), at: (0, 0, 1))}, contacts: [Tool(tool: \"t\", body: \"b\")]",
            "the kinematic law corrects explicit steps, and there are none",
        ),
    ];
    for (solver, more, expected) in cases {
        let told = refused(solver, more);
        assert!(told.contains(expected), "{solver} {more}: {told}");
    }
    assert_eq!(refused("Implicit()", ""), "nothing");
}

/// Two other finite element programs and dynamic relaxation have its top at −2.625 mm.
#[test]
fn a_cube_comes_to_rest_where_other_programs_have_it() {
    let mut simulation = Simulation::new(
        &scene_of(
            "(duration: 4, solver: Implicit(step: 0.2),
            bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (10, 10, 10), elements: Tet4), material: \"m\")},
            materials: {\"m\": (density: 1000, damping: 20, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))])",
            Path::new("."),
        ),
        &options(Precision::F32, 1),
    )
    .unwrap();
    simulation.finish().unwrap();
    println!("{:?}", simulation.implicit_steps());
    let rest = simulation.rest_positions("b").unwrap().to_vec();
    let u = simulation.displacements("b").unwrap();
    let top: Vec<f64> = (0..u.len()).filter(|&i| rest[i].z > 0.0999).map(|i| u[i].z).collect();
    near("top", top.iter().sum::<f64>() / top.len() as f64, -2.625e-3, 2.625e-3, 2e-3);
}
