//! Damping proportional to stiffness: C = βK, a mode of angular frequency ω decays with ξ = βω/2.
//!
//! Bar of 20 hexahedra in 1-D strain (lateral motion held), clamped at z = 0, ν = 0: a chain of lumped masses with
//! modes sin(κ z), κ = (2n − 1)π/2L, ω = (2c/h) sin(κh/2), c² = E/ρ. Let go from u = ε z, all modes swing; mode n is
//! what the mass-weighted product with its shape leaves, exactly. From peak to peak it falls by e^(−2πξ/√(1−ξ²)). The
//! damping stress is that of the last step, so the amplitude falls by √(1 − βω²Δt) a step, not e^(−βω²Δt/2): ξ is
//! larger by a share βω²Δt/4 at most, 1e-3 here. Its stable step is Δt = (2/ω)(√(1 + ξ²) − ξ) for the largest ω.

use crate::configurations::{Configuration, ELEMENTS, configurations, cpu_and_long_gpu, near};
use crate::element_turns::with_elements;
use crate::grids::bits;
use sinew::{Simulation, Snapshot};
use std::f64::consts::PI;

const CELLS: usize = 20;
const LENGTH: f64 = 0.1;
const YOUNG: f64 = 3e3;

fn bar(elements: &str, beta: f64, further: &str) -> String {
    format!(
        "(duration: 2, {further}
        bodies: {{\"b\": (mesh: Box(size: (0.005, 0.005, {LENGTH}), cells: (1, 1, {CELLS}), elements: {elements}), material: \"m\",
            start: Affine(gradient: ((0, 0, 0), (0, 0, 0), (0, 0, 1e-3))))}},
        materials: {{\"m\": (density: 1000, linear: Young(young: {YOUNG}, poisson: 0), stiffness_damping: {beta})}},
        constraints: [Fixed(on: All, axes: [X, Y]), Fixed(on: Plane(normal: (0, 0, 1), at: 0))])"
    )
}

fn wave_number(mode: usize) -> f64 {
    (2 * mode - 1) as f64 * PI / (2.0 * LENGTH)
}

/// ω of a mode of the chain (1/s).
fn frequency(mode: usize) -> f64 {
    let (speed, h) = ((YOUNG / 1000.0).sqrt(), LENGTH / CELLS as f64);
    2.0 * speed / h * (0.5 * wave_number(mode) * h).sin()
}

/// Δt up to which the chain is stable (s).
fn limit(beta: f64) -> f64 {
    let omega = frequency(CELLS);
    let xi = 0.5 * beta * omega;
    2.0 / omega * ((1.0 + xi * xi).sqrt() - xi)
}

/// How much of a mode there is (m).
fn part(simulation: &mut Simulation, mode: usize) -> f64 {
    let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
    let mass = simulation.masses("b").unwrap();
    (0..rest.len()).map(|i| mass[i] * u[i].z * (wave_number(mode) * rest[i].z).sin()).sum::<f64>()
        / mass.iter().sum::<f64>()
}

/// The largest displacement (m); infinite where one is no number.
fn largest(simulation: &mut Simulation) -> f64 {
    let u = simulation.displacements("b").unwrap();
    u.iter()
        .map(|u| u.length())
        .fold(0.0, |most, size| if size.is_finite() { f64::max(most, size) } else { f64::INFINITY })
}

/// ξ from the heights of the peaks of a course in time, the first left out.
fn damping_of(course: &[f64]) -> f64 {
    let mut peaks = Vec::new();
    for three in course.windows(3) {
        let &[a, b, c] = three else { continue };
        if b > a && b >= c {
            // the top of the parabola through the three
            peaks.push(b + 0.125 * (a - c) * (a - c) / (2.0 * b - a - c));
        }
    }
    assert!(peaks.len() >= 3, "{} peaks", peaks.len());
    let decrement = (peaks[0] / peaks[peaks.len() - 1]).ln() / (peaks.len() - 1) as f64;
    decrement / (4.0 * PI * PI + decrement * decrement).sqrt()
}

#[test]
#[ignore = "long"]
fn modes_decay_in_proportion_to_their_frequencies() {
    let beta = 0.02 / frequency(1);
    for (run, elements) in configurations().iter().flat_map(|run| ["Hex8", "Hex8MeanDilatation"].map(|e| (run, e))) {
        let mut simulation = run.start(&bar(elements, beta, "integration: (step: 2e-4),"));
        let (mut first, mut third) = (Vec::new(), Vec::new());
        while simulation.time() < 0.75 {
            simulation.advance(4).unwrap();
            first.push(part(&mut simulation, 1));
            // later rounding counts
            if simulation.time() < 0.25 {
                third.push(part(&mut simulation, 3));
            }
        }
        let what = format!("{}, {elements}", run.name);
        for (mode, course) in [(1, &first), (3, &third)] {
            let expected = 0.5 * beta * frequency(mode);
            near(&format!("{what}: mode {mode}"), damping_of(course), expected, expected, 0.01);
        }
        let ratio = damping_of(&third) * frequency(3) / (damping_of(&first) * frequency(1));
        let expected = (frequency(3) / frequency(1)).powi(2);
        near(&format!("{what}: rates"), ratio, expected, expected, 0.015);
    }
}

#[test]
fn stable_step_is_where_the_closed_form_says() {
    for beta in [2e-4, 2e-3, 2e-2] {
        for run in cpu_and_long_gpu() {
            let step =
                |share: f64| format!("integration: (step: {:e}, beyond_stable_step: true),", share * limit(beta));
            let mut stable = run.start(&bar("Hex8", beta, &step(0.98)));
            stable.advance(3000).unwrap_or_else(|error| panic!("{}, β = {beta}: {error}", run.name));
            let held = largest(&mut stable);
            assert!(held <= 1.01e-4, "{}, β = {beta}: {held:e} m at 0.98 of the limit", run.name);
            let mut unstable = run.start(&bar("Hex8", beta, &step(1.05)));
            let runs_away = unstable.advance(3000).is_err() || largest(&mut unstable) >= 1e-2;
            assert!(runs_away, "{}, β = {beta}: stable at 1.05 of the limit", run.name);
            let known = stable.summary("").unwrap().stability.limit.unwrap() / limit(beta);
            println!("{}, β = {beta}: the limit is {:e} s, {known:.4} of it is known", run.name, limit(beta));
            assert!((0.96..=1.0 + 1e-9).contains(&known), "{}, β = {beta}: known to {known}", run.name);
        }
    }
}

/// Steps that sinew finds are stable, by any bound, also where tissue is squeezed and its frequencies rise.
#[test]
fn steps_that_are_found_are_stable_while_tissue_is_squeezed() {
    for (run, bound) in cpu_and_long_gpu().iter().flat_map(|run| ["Elements", "Auto", "Iterated"].map(|b| (run, b))) {
        let mut simulation = run.start(&format!(
            "(duration: 0.6, integration: (bound: {bound}),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8MeanDilatation), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), stiffness_damping: 5e-3)}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, -0.06), curve: Smooth(end: 0.5))])"
        ));
        simulation.finish().unwrap_or_else(|error| panic!("{}, {bound}: {error}", run.name));
        let guards = simulation.guards();
        assert!(guards.warnings.is_empty(), "{}, {bound}: {:?}", run.name, guards.warnings);
        let limit = simulation.stable_limit().unwrap().unwrap();
        let step = simulation.time_step();
        println!("{}, {bound}: a step of {step:e} s at a limit of {limit:e} s", run.name);
        assert!(step <= limit / 0.97, "{}, {bound}: {step:e} s at a limit of {limit:e} s", run.name);
    }
}

#[test]
#[ignore = "long"]
fn rigid_rotation_is_not_damped() {
    for (run, elements) in with_elements(&configurations(), 2) {
        let forces = |motion: &str| {
            let mut simulation = run.start(&format!(
                "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: {elements}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), stiffness_damping: 0.01)}},
                constraints: [Prescribed(on: All, {motion}, curve: Ramp(end: 0.1))])"
            ));
            simulation.advance_to(0.09).unwrap();
            let forces = simulation.internal_forces("b").unwrap();
            forces.iter().map(|force| force.length()).fold(0.0, |most, f| if f <= most { most } else { f })
        };
        let (turned, stretched) =
            (forces("rotation: (20, 50, 70)"), forces("gradient: ((0.1, 0, 0), (0, 0, 0), (0, 0, 0))"));
        println!("{}, {elements}: {turned:e} N turned, {stretched:e} N stretched", run.name);
        assert!(turned <= run.bound(1e-11, 1e-3) * stretched, "{}, {elements}: {turned:e} N", run.name);
    }
}

/// All the work that elements have not kept is what damping has taken: nothing comes from nothing.
#[test]
fn energy_that_is_gone_has_been_spent() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&bar("Hex8", 1e-3, "output: (energies_every: 0.01),"));
        let start = simulation.energies().unwrap().strain;
        for part in 1..=8 {
            simulation.advance_to(0.25 * f64::from(part)).unwrap();
            let now = simulation.energies().unwrap();
            let done = now.internal_work.unwrap();
            // what the elements gave became motion
            near(
                &format!("{}: t = {}", run.name, 0.25 * f64::from(part)),
                now.kinetic,
                -done,
                start,
                run.bound(1e-3, 1e-3),
            );
            assert!(now.kinetic + now.strain <= (1.0 + 1e-6) * start, "{}: {now:?}", run.name);
        }
        let end = simulation.energies().unwrap();
        assert!(end.kinetic + end.strain < 0.2 * start, "{}: {end:?} of {start}", run.name);
        assert!(simulation.guards().warnings.is_empty(), "{}: {:?}", run.name, simulation.guards().warnings);
    }
}

/// With all that has a memory beside it, in all elements, on all backends.
fn everything(elements: &str) -> String {
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 1, stiffness_damping: 2e-3,
            fibres: (eta: 500, direction: Along(1, 0, 1)),
            prony: (terms: [(alpha: 0.3, tau: 0.05)], volumetric: [(alpha: 0.1, tau: 0.1)]))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: (0, 0, -9.81)), Pressure(on: Surface(normal: (1, 0, 0)), pressure: 300)],
        integration: (step: 5e-4))"
    )
}

#[test]
fn all_backends_agree_and_snapshots_are_gone_on_from() {
    let runs: Vec<Configuration> = cpu_and_long_gpu();
    for elements in ELEMENTS {
        let mut reference: Option<Vec<glam::DVec3>> = None;
        for run in &runs {
            let mut whole = run.start(&everything(elements));
            whole.advance(80).unwrap();
            let kept = Snapshot::from_bytes(&whole.snapshot().unwrap().to_bytes().unwrap()).unwrap();
            whole.advance(80).unwrap();
            let end = bits(&mut whole, "b");
            let mut other = run.start(&everything(elements));
            other.restore(&kept).unwrap();
            other.advance(80).unwrap();
            assert!(bits(&mut other, "b") == end, "{}, {elements}: another way", run.name);
            // half way in steps of half the length: the same motion
            let mut finer = run.start(&everything(elements));
            finer.restore(&kept).unwrap();
            finer.set_time_step(2.5e-4).unwrap();
            finer.advance_to(whole.time()).unwrap();
            let (found, finer) = (whole.displacements("b").unwrap(), finer.displacements("b").unwrap());
            let size = found.iter().map(|u| u.length()).fold(0.0, f64::max);
            let apart = |a: &[glam::DVec3], b: &[glam::DVec3]| {
                a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, |most, d| if d <= most { most } else { d })
                    / size
            };
            println!("{}, {elements}: {:.1e} from finer steps", run.name, apart(&found, &finer));
            assert!(
                size > 5e-3 && apart(&found, &finer) <= 0.02,
                "{}, {elements}: {:e}",
                run.name,
                apart(&found, &finer)
            );
            let reference = reference.get_or_insert(found.clone());
            println!("{}, {elements}: {:.1e} from CPU f64", run.name, apart(&found, reference));
            assert!(apart(&found, reference) <= 2e-5, "{}, {elements}: {:e}", run.name, apart(&found, reference));
        }
    }
}
