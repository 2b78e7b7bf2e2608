//! Implicit steps that are chosen by an estimate of their error.
//!
//! One degree of freedom (see `implicit.rs`): u = v₀/ω sin ωt. Errors of steps add up to τ of the amplitude within each
//! frame, and turn with the motion without growing: after N frames they are 2 N τ at most, of displacement and of
//! velocity over ω together.

use crate::configurations::{cpu_and_long_gpu, near, scene_of};
use crate::implicit::{SQUARE, options, oscillator, oscillator_on, refused, top};
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::Precision;
use sinew::snapshot::Snapshot;
use sinew::systems::Registry;
use sinew::{BackendChoice, ImplicitSteps, Options, Simulation};
use std::path::Path;

/// v₀/ω (m).
fn amplitude() -> f64 {
    1e-3 / SQUARE.sqrt()
}

/// What the displacement of one degree of freedom is off at most at the ends of frames of 10 ms, over its amplitude;
/// and what steps took.
fn off(mut simulation: Simulation) -> (f64, ImplicitSteps) {
    let (mut worst, omega) = (0.0_f64, SQUARE.sqrt());
    for frame in 1..=FRAMES {
        let time = 0.01 * f64::from(frame);
        simulation.advance_to(time).unwrap();
        near("the end of a frame", simulation.time(), time, time, 1e-9);
        let exact = amplitude() * (omega * time).sin();
        worst = worst.max((top(&mut simulation)[0] - exact).abs());
    }
    (worst / amplitude(), simulation.implicit_steps().unwrap())
}

const FRAMES: u32 = 13;

fn chosen(scheme: &str, tolerance: f64) -> String {
    format!(
        "Implicit(scheme: {scheme}, step: 0.01, newton: 8, tolerance: 1e-10,
            adaptive: (tolerance: {tolerance}, displacement: {}))",
        amplitude()
    )
}

/// A decade of the tolerance is one of the error, to what the controller leaves: it holds estimates between a half of
/// the tolerance and all of it, so that of two errors each may be twice too small. (Of implicit Euler where little of
/// the amplitude is damped: what is gone cannot be off.)
#[test]
fn errors_fall_in_proportion_to_the_tolerance() {
    for (scheme, tolerances) in [("Euler", [4e-3, 4e-4]), ("GeneralizedAlpha()", [1e-4, 1e-5])] {
        let found = tolerances.map(|tolerance| off(oscillator(&chosen(scheme, tolerance), "")));
        println!("{scheme}: {found:?}");
        for ((error, took), tolerance) in found.iter().zip(tolerances) {
            assert!(*error < 2.0 * f64::from(FRAMES) * tolerance, "{scheme} at {tolerance}: {error}, {took:?}");
            assert!(took.smallest_step < took.largest_step, "{took:?}");
        }
        let ratio = found[0].0 / found[1].0;
        assert!(ratio > 5.0 && ratio < 20.0, "{scheme}: {ratio}");
    }
}

#[test]
fn errors_are_those_of_the_tolerance_on_a_gpu() {
    if gpu_or_reason().is_none() {
        return;
    }
    let gpu = Options { backend: BackendChoice::Gpu, precision: Precision::F32, threads: 1, ..Options::default() };
    let solver = chosen("GeneralizedAlpha()", 1e-2).replace("1e-10", "1e-5");
    let (of_gpu, took) = off(oscillator_on(&solver, "", &gpu));
    let (of_cpu, _) = off(oscillator_on(&solver, "", &options(Precision::F32, 1)));
    println!("{of_gpu}, {of_cpu} on the CPU, {took:?}");
    assert!(of_gpu < 2.0 * f64::from(FRAMES) * 1e-2, "{of_gpu}");
    // f32 leaves digits of which each decides about lengths of steps: both are within the tolerance of one another
    assert!((of_gpu - of_cpu).abs() < 1e-2 * f64::from(FRAMES), "{of_gpu}, {of_cpu}");
}

#[test]
fn a_tolerance_that_does_not_bind_leaves_all_bits() {
    for scheme in ["Euler", "GeneralizedAlpha()"] {
        let fixed = format!("Implicit(scheme: {scheme}, step: 0.01)");
        let loose = format!("Implicit(scheme: {scheme}, step: 0.01, adaptive: (tolerance: 0.9, displacement: 1))");
        let [one, other] = [fixed, loose].map(|solver| {
            let mut simulation = cube(&solver, &options(Precision::F32, 1));
            simulation.advance_to(0.2).unwrap();
            (simulation.displacements("b").unwrap(), simulation.step_count())
        });
        assert_eq!(one, other, "{scheme}");
    }
}

/// A cube with memory that is pressed slowly, and from .3 s on all at once.
fn cube(solver: &str, options: &Options) -> Simulation {
    let scene = format!(
        "(duration: 1.005, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Tet4), material: \"m\")}},
        materials: {{\"m\": (density: 1000, damping: 20, neo_hookean: Young(young: 3e3, poisson: 0.45),
            prony: (terms: [(alpha: 0.5, tau: 0.1)]))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Pressure(on: Plane(normal: (0, 0, 1), at: 0.1), pressure: 20, curve: Smooth(end: 0.25)),
            Pressure(on: Plane(normal: (0, 0, 1), at: 0.1), pressure: 200, curve: Step(start: 0.3037))],
        output: (energies_every: 0.01))"
    );
    Simulation::new(&scene_of(&scene, Path::new(".")), options).unwrap()
}

const CHOSEN: &str = "Implicit(scheme: GeneralizedAlpha(), step: 0.02, tolerance: 1e-6, adaptive: (tolerance: 3e-3))";

/// Times at the ends of all steps up to the end of the scene.
fn ends(simulation: &mut Simulation) -> Vec<f64> {
    let mut ends = vec![0.0];
    while !simulation.is_finished() {
        simulation.advance_towards_end(1).unwrap();
        ends.push(simulation.time());
    }
    ends
}

#[test]
fn steps_are_short_where_a_load_is_sudden() {
    for run in cpu_and_long_gpu() {
        let mut simulation = cube(CHOSEN, &run.options);
        let ends = ends(&mut simulation);
        let lengths = |from: f64, to: f64| -> Vec<f64> {
            let pairs = ends.windows(2).filter(|pair| pair[0] > from - 1e-9 && pair[1] < to + 1e-9);
            pairs.map(|pair| pair[1] - pair[0]).collect()
        };
        let longest = |from, to| lengths(from, to).into_iter().fold(0.0, f64::max);
        let shortest = |from, to| lengths(from, to).into_iter().fold(f64::INFINITY, f64::min);
        println!("{}: {:?}\n{:?}", run.name, lengths(0.0, 2.0), simulation.implicit_steps());
        near("slow steps", longest(0.1, 0.29), 0.02, 0.02, 1e-6);
        assert!(shortest(0.3, 0.32) < 0.25 * shortest(0.1, 0.29), "{:?}", lengths(0.3, 0.32));
        assert!(longest(0.8, 1.0) > 2.0 * shortest(0.3, 0.32), "{:?}", lengths(0.8, 1.0));
        for wanted in [0.3037, 0.32, 1.0, 1.005] {
            assert!(ends.iter().any(|end| (end - wanted).abs() < 1e-8), "{wanted} s is no end of a step: {ends:?}");
        }
        assert!(simulation.implicit_steps().unwrap().steps_rejected > 0);
        assert_eq!((simulation.step_count(), simulation.time() > 1.00499), (simulation.planned_steps(), true));
    }
}

/// Digits of the clock and of the state, and what was taken.
fn told(simulation: &mut Simulation) -> (Vec<[u64; 3]>, u64, u64, ImplicitSteps) {
    let bits = simulation.displacements("b").unwrap().iter().map(|u| u.to_array().map(f64::to_bits)).collect();
    (bits, simulation.step_count(), simulation.time().to_bits(), simulation.implicit_steps().unwrap())
}

#[test]
fn chosen_steps_are_the_same_for_any_number_of_threads_and_from_run_to_run() {
    let runs = [1, 2, 3, 1].map(|threads| {
        let mut simulation = cube(CHOSEN, &options(Precision::F32, threads));
        simulation.advance_to(0.4).unwrap();
        told(&mut simulation)
    });
    assert!(runs[0].3.steps_rejected > 0, "{:?}", runs[0].3);
    assert!(runs.iter().all(|run| *run == runs[0]));
}

#[test]
fn chosen_steps_go_on_from_a_snapshot_and_after_going_back() {
    for run in cpu_and_long_gpu() {
        let mut whole = cube(CHOSEN, &run.options);
        let mut pieces = cube(CHOSEN, &run.options);
        pieces.advance_to(0.306).unwrap();
        let kept = Snapshot::from_bytes(&pieces.snapshot().unwrap().to_bytes().unwrap()).unwrap();
        whole.advance_to(0.4).unwrap();
        let expected = told(&mut whole);
        let mut other = cube(CHOSEN, &run.options);
        other.restore(&kept).unwrap();
        for simulation in [&mut pieces, &mut other] {
            simulation.advance_to(0.4).unwrap();
            let (bits, step, time, _) = told(simulation);
            assert!((&bits, step, time) == (&expected.0, expected.1, expected.2), "{}", run.name);
        }
        whole.reset().unwrap();
        whole.advance_to(0.4).unwrap();
        let (bits, step, time, _) = told(&mut whole);
        assert!((bits, step, time) == (expected.0, expected.1, expected.2), "{}: from the start again", run.name);
    }
}

/// Steps that are as long from the beginning as those that were chosen come to the same: what is taken back leaves
/// nothing. Velocities are scaled once more where a step was taken back, which rounds them.
#[test]
fn steps_that_are_taken_back_leave_nothing() {
    let f64s = options(Precision::F64, 1);
    let mut chosen = cube(CHOSEN, &f64s);
    let mut told = cube("Implicit(scheme: GeneralizedAlpha(), step: 0.02, tolerance: 1e-6)", &f64s);
    while chosen.time() < 0.35 {
        let before = chosen.time();
        chosen.advance(1).unwrap();
        told.set_time_step(chosen.time() - before).unwrap();
        told.advance(1).unwrap();
    }
    assert!(chosen.implicit_steps().unwrap().steps_rejected > 1, "{:?}", chosen.implicit_steps());
    let [a, b] = [&mut chosen, &mut told].map(|simulation| simulation.displacements("b").unwrap());
    let largest = b.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
    for (a, b) in a.iter().zip(&b) {
        near("a displacement", (*a - *b).length(), 0.0, largest, 1e-9);
    }
    let [a, b] = [&mut chosen, &mut told].map(|simulation| simulation.energies().unwrap());
    let work = b.load_work.unwrap();
    near("work of loads", a.load_work.unwrap(), work, work, 1e-9);
    near("what the scheme took", a.scheme_loss.unwrap(), b.scheme_loss.unwrap(), work, 1e-9);
}

/// A step of the scene's own length is not found: see `a_step_that_is_not_found_is_told_and_leaves_the_last_state`.
#[test]
fn a_step_that_is_not_found_is_tried_again_shorter() {
    let scene = |adaptive: &str| {
        format!(
            "(duration: 1, solver: Implicit(step: 0.01{adaptive}),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Tet4), material: \"m\")}},
            materials: {{\"m\": (density: 1000, damping: 50, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0.0, 0, -0.08), curve: Ramp(end: 0.01))])"
        )
    };
    let start = |text: &str| Simulation::new(&scene_of(text, Path::new(".")), &options(Precision::F64, 1)).unwrap();
    let mut fixed = start(&scene(", newton: 4"));
    let told = fixed.advance_to(0.02).err().map(|error| error.to_string());
    let unsolved = fixed.implicit_steps().unwrap().unsolved;
    assert!(told.is_some() || unsolved > 0, "a whole step is no test: {:?}", fixed.implicit_steps());
    let mut chosen = start(&scene(", newton: 4, adaptive: (tolerance: 0.9, displacement: 1)"));
    chosen.advance_to(0.02).unwrap();
    let took = chosen.implicit_steps().unwrap();
    println!("{told:?} {unsolved}; {took:?}");
    assert!(took.steps_rejected > 0 && took.unsolved == 0, "{took:?}");
}

#[test]
fn bad_numbers_of_chosen_steps_are_refused_by_name() {
    let cases = [
        ("tolerance: 0", "`tolerance` must be above 0 and below 1"),
        ("tolerance: -1e-3", "`tolerance` must be above 0 and below 1"),
        ("tolerance: 1", "`tolerance` must be above 0 and below 1"),
        ("tolerance: NaN", "`tolerance` must be finite"),
        ("displacement: 0", "`displacement` must be above 0"),
        ("smallest: 0", "`smallest` must be above 0"),
        ("smallest: 0.1", "`smallest` must be at most"),
        ("tolerence: 1e-3", "tolerence"),
    ];
    for (field, expected) in cases {
        let told = refused(&format!("Implicit(step: 0.01, adaptive: ({field}))"), "");
        assert!(told.contains(expected), "{field}: {told}");
    }
    assert_eq!(refused("Implicit(adaptive: ())", ""), "nothing");
}

/// The shortest step is taken whatever its error, with a word.
#[test]
fn the_shortest_step_is_taken_and_warned_of() {
    let solver = "Implicit(step: 0.02, adaptive: (tolerance: 1e-6, smallest: 0.01))";
    let mut simulation = cube(solver, &options(Precision::F64, 1));
    simulation.advance_to(0.1).unwrap();
    let warnings = simulation.summary("finished").unwrap().guards.warnings;
    assert!(warnings.iter().any(|notice| notice.criterion == "implicit_step_error"), "{warnings:?}");
    near("the shortest step", simulation.implicit_steps().unwrap().smallest_step, 0.01, 0.01, 1e-9);
    let told = simulation.explain(&Registry::default()).unwrap().to_string();
    assert!(told.contains("steps are chosen so that the errors within 0.02 s add up to 0.000001"), "{told}");
}

/// Each 10 ms of life is a frame, or each step that is longer, whoever asks for how many steps; rest has none, and
/// explicit steps on a GPU, which are not waited for.
#[test]
fn frames_of_a_run_are_counted() {
    let cpu = options(Precision::F32, 1);
    for solver in ["Explicit", "Implicit(step: 2e-3)", "Implicit(step: 0.02)"] {
        let [one, other] = [false, true].map(|by_steps| {
            let mut simulation = cube(solver, &cpu);
            while by_steps && simulation.time() < 0.0996 {
                simulation.advance(1).unwrap();
            }
            simulation.advance_to(0.3).unwrap();
            let summary = simulation.summary("finished").unwrap();
            let frames = summary.frames.unwrap();
            assert!(0.0 < frames.percentile_99 && frames.percentile_99 <= frames.longest, "{solver}: {frames:?}");
            assert!(frames.longest * frames.count as f64 >= 0.9 * summary.solving_seconds, "{solver}: {frames:?}");
            assert!(frames.longest <= summary.solving_seconds, "{solver}: {frames:?}");
            let of_a_frame = (0.01 / simulation.time_step() - 1e-6).ceil() as u64;
            assert_eq!(frames.count, simulation.step_count() / of_a_frame, "{solver}: {frames:?}");
            frames.count
        });
        assert!(one == other && one >= 10, "{solver}: {one} and {other}");
    }
    if gpu_or_reason().is_some() {
        let gpu = Options { backend: BackendChoice::Gpu, precision: Precision::F32, threads: 1, ..Options::default() };
        let mut simulation = cube("Explicit", &gpu);
        simulation.advance_to(0.05).unwrap();
        assert_eq!(simulation.summary("finished").unwrap().frames, None);
    }
}
