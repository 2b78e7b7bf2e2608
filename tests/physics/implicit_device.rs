//! Implicit steps on a GPU: against closed forms, against those of the CPU in f32 and in f64, and against themselves.
//!
//! Conjugate gradients run there in f32; residuals are the host's, so that both come as near to the same state as their
//! tolerance says.

use crate::columns::{masses, velocities};
use crate::configurations::{near, scene_of};
use crate::implicit::{oscillates_as_its_closed_form, oscillator_on};
use glam::DVec3;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::Precision;
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, ImplicitSteps, Options, Simulation};
use std::path::Path;

fn on(backend: BackendChoice, precision: Precision) -> Options {
    Options { backend, precision, threads: 1, ..Options::default() }
}

fn gpu() -> Option<Options> {
    gpu_or_reason().map(|_| on(BackendChoice::Gpu, Precision::F32))
}

fn begun(text: &str, options: &Options) -> Simulation {
    Simulation::new(&scene_of(text, Path::new(".")), options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const EFFECTS: &str =
    "fibres: (eta: 2000, direction: Along(1, 2, 3)), prony: (terms: [(alpha: 0.5, tau: 0.1)]), damping: 2,";

/// A cube under its weight and a pressure that follows its faces, or what else there is.
fn cube(solver: &str, elements: &str, effects: &str, more: &str) -> String {
    format!(
        "(duration: 1, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, {effects} neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)), {more}],
        loads: [Gravity(acceleration: (0.5, 0, -2), curve: Smooth(end: 0.2)),
            Pressure(on: Surface(normal: (1, 0, 0)), pressure: 30, curve: Smooth(end: 0.1))])"
    )
}

fn moved(text: &str, options: &Options, time: f64) -> (Vec<DVec3>, ImplicitSteps) {
    let mut simulation = begun(text, options);
    simulation.advance_to(time).unwrap();
    let u = simulation.displacements("b").unwrap();
    (u, simulation.implicit_steps().unwrap())
}

/// The largest difference of nodes over the largest displacement.
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    let largest = b.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
    a.iter().zip(b).fold(0.0_f64, |apart, (a, b)| apart.max((*a - *b).length())) / largest
}

/// What steps leave of the residual is τ of all forces, of which some three times the loads R are made, and A⁻¹ makes
/// of it no more than of R, which bends the whole body: 3 τ of the displacement a step, in 20 steps 60 τ, of two runs
/// twice that.
#[test]
fn gpus_take_the_steps_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let tolerance = 1e-5;
    for (elements, scheme, effects) in [
        ("Tet4", "Euler", EFFECTS),
        ("Tet4NodalPressure", "GeneralizedAlpha()", ""),
        ("Hex8MeanDilatation", "GeneralizedAlpha()", EFFECTS),
    ] {
        let solver = |tolerance: f64| format!("Implicit(scheme: {scheme}, step: 0.01, tolerance: {tolerance})");
        let text = |tolerance: f64| cube(&solver(tolerance), elements, effects, "");
        let (found, counts) = moved(&text(tolerance), &gpu, 0.2);
        let (single, of_cpu) = moved(&text(tolerance), &on(BackendChoice::Cpu, Precision::F32), 0.2);
        let (exact, _) = moved(&text(1e-9), &on(BackendChoice::Cpu, Precision::F64), 0.2);
        let [of_single, of_exact] = [&single, &exact].map(|other| apart(&found, other));
        println!(
            "{elements}, {scheme}: {of_single:e} off the CPU's f32, {of_exact:e} off its f64; {counts:?}, {of_cpu:?}"
        );
        let bound = 60.0 * tolerance;
        assert!(of_exact < bound && of_single < 2.0 * bound, "{elements}, {scheme}: {of_single:e}, {of_exact:e}");
        assert_eq!(counts.unsolved, 0, "{counts:?}");
        assert!(counts.linear_iterations.abs_diff(of_cpu.linear_iterations) * 5 <= of_cpu.linear_iterations);
    }
}

#[test]
fn gpus_repeat_steps_to_the_bit() {
    let Some(gpu) = gpu() else { return };
    let text = cube("Implicit(scheme: GeneralizedAlpha(), step: 0.01)", "Tet4", EFFECTS, "");
    let runs = [(); 2].map(|()| {
        let (u, counts) = moved(&text, &gpu, 0.1);
        let bits: Vec<[u64; 3]> = u.iter().map(|u| u.to_array().map(f64::to_bits)).collect();
        (bits, counts)
    });
    assert!(runs[0].1.newton_iterations > 10, "{:?}", runs[0].1);
    assert!(runs[0] == runs[1]);
}

/// Of f32 a force is known to its digit, 6e-8 of the largest in a step; in 40 steps that is 2.4e-6, and half a dozen of
/// such digits are in each.
#[test]
fn one_degree_of_freedom_is_its_closed_form_on_a_gpu() {
    let Some(gpu) = gpu() else { return };
    let solver = "Implicit(scheme: Euler, step: 0.01, newton: 8, tolerance: 1e-7)";
    oscillates_as_its_closed_form(oscillator_on(solver, "", &gpu), 1.5e-5);
}

/// Iterations of conjugate gradients to the same tolerance are those of the CPU, but for rounding.
#[test]
fn every_preconditioner_takes_as_many_iterations_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut all = Vec::new();
    for name in ["TwoLevel", "BlockJacobi", "Mass", "Identity"] {
        let text =
            cube(&format!("Implicit(step: 0.05, preconditioner: {name}, newton: 1, tolerance: 0.05)"), "Tet4", "", "");
        let [on_gpu, on_cpu] = [&gpu, &on(BackendChoice::Cpu, Precision::F32)]
            .map(|options| moved(&text, options, 0.2).1.linear_iterations);
        println!("{name}: {on_gpu} and {on_cpu}");
        assert!(on_gpu.abs_diff(on_cpu) <= 2 + on_cpu / 20, "{name}: {on_gpu}, not {on_cpu}");
        all.push(on_gpu);
    }
    assert!(all[0] < all[1] && all[1] < all[3], "{all:?}");
}

/// A body that turns, in two pieces in the end, with what is moved as told: the coarse level is made anew and turned.
#[test]
fn moved_nodes_and_removed_elements_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let prescribed = "Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0.03, 0, 0.02), \
                      rotation: (0, 0, 60), center: (0.05, 0.05, 0.1), curve: Smooth(end: 0.2))";
    let removal = "Implicit(step: 0.01, tolerance: 1e-5), \
                   removal: [(on: Sphere(center: (0.1, 0.1, 0.05), radius: 0.04), when: At(0.045))]";
    let text = cube(removal, "Tet4", "prony: (terms: [(alpha: 0.5, tau: 0.1)]),", prescribed);
    let (found, counts) = moved(&text, &gpu, 0.2);
    let (expected, of_cpu) = moved(&text, &on(BackendChoice::Cpu, Precision::F32), 0.2);
    println!("{:e}; {counts:?}, {of_cpu:?}", apart(&found, &expected));
    assert!(apart(&found, &expected) < 1.2e-3, "{:e}", apart(&found, &expected));
}

/// f32 rounds the forces of elements to 6e-8 of themselves, whose sum is no more than the masses times ω² u here.
#[test]
fn momentum_is_kept_however_early_a_solve_ends_on_a_gpu() {
    let Some(gpu) = gpu() else { return };
    let mut simulation = begun(
        "(duration: 1, solver: Implicit(step: 0.01, budget: 4),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.08, 0.06), cells: (3, 3, 2), elements: Tet4), material: \"m\", velocity: (0.02, -0.01, 0.03), spin: (3, -5, 8))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))})",
        &gpu,
    );
    let momentum = |simulation: &mut Simulation| -> DVec3 {
        let (m, v) = (masses(simulation, "b"), velocities(simulation, "b"));
        (0..m.len()).map(|i| v[i] * m[i]).sum()
    };
    let before = momentum(&mut simulation);
    simulation.advance(20).unwrap();
    let lost = (momentum(&mut simulation) - before).length() / before.length();
    let counts = simulation.implicit_steps().unwrap();
    println!("momentum lost: {lost:e}, {counts:?}");
    assert!(lost < 1e-5, "{lost:e}");
    assert!(counts.most_passes <= 6, "{counts:?}");
}

#[test]
fn a_step_that_is_not_found_on_a_gpu_leaves_the_last_state() {
    let Some(gpu) = gpu() else { return };
    let mut simulation = begun(
        "(duration: 1, solver: Implicit(step: 0.01),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), prony: (terms: [(alpha: 0.5, tau: 0.1)]))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, -0.15), curve: Step(start: 0.045))])",
        &gpu,
    );
    simulation.advance(4).unwrap();
    let before = simulation.displacements("b").unwrap();
    let error = simulation.advance(1).unwrap_err().to_string();
    assert!(error.contains("implicit step") && error.contains("was not found"), "{error}");
    assert!(error.contains("no descent after"), "{error}");
    assert_eq!((simulation.displacements("b").unwrap(), simulation.step_count()), (before, 4));
}

#[test]
fn explain_says_what_an_iteration_dispatches() {
    let Some(gpu) = gpu() else { return };
    let mut simulation = begun(&cube("Implicit()", "Tet4", "", ""), &gpu);
    let page = simulation.explain(&Registry::default()).unwrap().to_string();
    assert!(page.contains("dispatches an iteration"), "{page}");
}

/// What runs on the host would have to be brought there and back for each product.
#[test]
fn systems_on_the_host_are_refused_by_name_on_a_gpu() {
    let look = System::custom("look", Phase::Removal, "looks", || {});
    let registry = Registry::default().with(look);
    let text = cube("Implicit()", "Tet4", "", "").replacen(
        "(duration: 1,",
        "(duration: 1, schedule: [\"boundary\", \"element_forces\", \"gather\", \"gravity\", \"pressure\", \"look\", \"observe\"],",
        1,
    );
    let options = on(BackendChoice::Gpu, Precision::F32);
    let told =
        Simulation::with_systems(&scene_of(&text, Path::new(".")), &options, &registry).err().unwrap().to_string();
    assert!(told.contains("`look` runs on the host") && told.contains("--backend cpu"), "{told}");
}

/// Rest by Newton's iterations to 1e-5 of all forces, which are some three times the loads: 3e-5 of the displacement,
/// and as much of rounding. Two other programs have the top of the cube at −2.6253 mm.
#[test]
fn bodies_rest_on_a_gpu_where_they_do_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let text = "(duration: 1, analysis: Static(method: Newton),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (10, 10, 10), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))])";
    let mut simulation = begun(text, &gpu);
    simulation.finish().unwrap();
    let (u, at) = (simulation.displacements("b").unwrap(), simulation.rest_positions("b").unwrap().to_vec());
    let top: Vec<f64> = u.iter().zip(&at).filter(|(_, at)| at.z > 0.0999).map(|(u, _)| u.z).collect();
    near("top", top.iter().sum::<f64>() / top.len() as f64, -2.6253e-3, 2.6253e-3, 1e-4);
    let found = simulation.equilibrium().unwrap().clone();
    println!("{found:?}, {:?}", simulation.implicit_steps());
    assert!(found.reached && found.newton_iterations > 0 && found.residual < 2e-5, "{found:?}");
    let text = cube("Explicit", "Hex8MeanDilatation", EFFECTS, "").replacen(
        "(duration: 1,",
        "(duration: 1, analysis: Static(method: Newton),",
        1,
    );
    let ends = [gpu, on(BackendChoice::Cpu, Precision::F64)].map(|options| {
        let mut simulation = begun(&text, &options);
        simulation.finish().unwrap();
        println!("{:?}", simulation.implicit_steps());
        simulation.displacements("b").unwrap()
    });
    println!("{:e} apart", apart(&ends[0], &ends[1]));
    assert!(apart(&ends[0], &ends[1]) < 6e-5, "{:e}", apart(&ends[0], &ends[1]));
}
