//! The viscous recursions against the convolution that they stand for.
//!
//! Υ(t) = α (S(t) − H(t)), H = ∫ e^(−(t−s)/τ) Ṡ ds. S jumps within the step before the first, so that after a jump H =
//! φ S e^(−nh) with h = Δt/τ, φ = (1 − e^(−h))/h, exactly; for S = r t: H = r τ (1 − e^(−t/τ)). Bounds: `Exact` makes
//! only rounding: n steps of contraction e^(−h) keep it below eps/h: 1e-13 for h ≥ .01 in f64. In f32 an increment
//! below one ulp is lost: with h = 1.7e-4 that is half an ulp/h = 3.5e-4 at worst, 1e-4 in the middle.

use crate::configurations::configurations;
use crate::grids::bits;
use sinew::materials::PronyTerm;
use sinew::math::{Real, Sym3};

/// Υ at each step, for a stress history of one component.
fn relaxed<R: Real>(term: PronyTerm<R>, stress: impl Iterator<Item = R>) -> Vec<R> {
    let mut memory = Sym3([term.rate.constant(0.0); 6]);
    stress
        .map(|s| {
            let isochoric = Sym3([s; 6]);
            let relaxed = term.relaxed(&isochoric, &memory);
            memory = term.carried_on(&isochoric, &memory);
            relaxed.0[3]
        })
        .collect()
}

#[test]
fn exact_recursion_follows_relaxation_and_ramp_to_rounding() {
    let (alpha, tau) = (0.5, 0.58);
    for time_step in [0.005_f64, 0.05, 1.0] {
        let (h, term) = (time_step / tau, PronyTerm::exact(alpha, tau, time_step));
        let phi = -(-h).exp_m1() / h;
        let jump = relaxed(term, (0..1000).map(|_| 1.0));
        let ramp = relaxed(term, (0..1000).map(|n| n as f64 * time_step));
        for n in 0..1000 {
            let time = n as f64 * time_step;
            let expected = alpha * (1.0 - phi * (-(n as f64) * h).exp());
            assert!((jump[n] - expected).abs() < 1e-13, "jump, step {n}: {} instead of {expected}", jump[n]);
            let expected = alpha * (time + tau * (-time / tau).exp_m1());
            assert!(
                (ramp[n] - expected).abs() < 1e-13 * (1.0 + time),
                "ramp, step {n}: {} instead of {expected}",
                ramp[n]
            );
        }
    }
}

#[test]
fn exact_recursion_in_f32_stalls_no_earlier_than_stated() {
    let (alpha, tau, time_step) = (0.5, 0.58, 1e-4);
    let term = PronyTerm::exact(alpha, tau, time_step);
    let rounded = PronyTerm {
        stress: term.stress as f32,
        memory: term.memory as f32,
        rate: term.rate as f32,
        aim: term.aim as f32,
    };
    let found = relaxed(rounded, (0..40_000).map(|_| 1.0_f32));
    let exact = relaxed(term, (0..40_000).map(|_| 1.0_f64));
    let worst = found.iter().zip(&exact).fold(0.0_f64, |worst, (a, b)| worst.max((f64::from(*a) - b).abs()));
    println!("f32 relaxation: {worst:.2e} of the stress");
    assert!(worst < 1e-4, "{worst:e}");
}

/// Largest error for S = sin ωt, whose H is ωτ (cos ωt + ωτ sin ωt − e^(−t/τ))/(1 + ω²τ²).
fn error(make: fn(f64, f64, f64) -> PronyTerm<f64>, steps: usize) -> f64 {
    let (alpha, tau, omega, duration) = (0.5, 0.58, 3.0, 4.0);
    let time_step = duration / steps as f64;
    let found = relaxed(make(alpha, tau, time_step), (0..steps).map(|n| (omega * n as f64 * time_step).sin()));
    let mut worst: f64 = 0.0;
    for (n, found) in found.iter().enumerate() {
        let (time, product) = (n as f64 * time_step, omega * tau);
        let (sin, cos) = (omega * time).sin_cos();
        let history = product * (cos + product * sin - (-time / tau).exp()) / (1.0 + product * product);
        worst = worst.max((found - alpha * (sin - history)).abs());
    }
    worst
}

#[test]
fn orders_of_convergence_are_two_and_one() {
    for (name, make, expected) in [
        ("Exact", PronyTerm::exact as fn(f64, f64, f64) -> PronyTerm<f64>, 2.0),
        ("BackwardEuler", PronyTerm::backward_euler, 1.0),
    ] {
        let order = (error(make, 4000) / error(make, 8000)).log2();
        println!("{name}: order {order:.4}");
        assert!((order - expected).abs() < 0.05, "{name}: order {order}");
    }
}

/// |(1 + h)^(−m) − e^(−mh)| is at most h/(2e) = .184 h.
#[test]
fn backward_euler_errs_by_at_most_its_bound_after_a_step_strain() {
    let (alpha, tau) = (0.5, 0.58);
    for time_step in [0.001, 0.01, 0.1] {
        let found = relaxed(PronyTerm::backward_euler(alpha, tau, time_step), (0..5000).map(|_| 1.0));
        let exact = |n: usize| alpha * -(-((n + 1) as f64) * time_step / tau).exp_m1();
        let worst = found.iter().enumerate().fold(0.0_f64, |worst, (n, found)| worst.max((found - exact(n)).abs()));
        let bound = 0.184 * alpha * time_step / tau;
        println!("Δt {time_step}: {worst:.3e}, bound {bound:.3e}");
        assert!(worst <= bound * 1.001 && worst > 0.8 * bound, "Δt {time_step}: {worst:e}, bound {bound:e}");
    }
}

/// H14: τ = Δt/100 has relaxed within 5 steps. H15: τ = 1e6 s has not begun to.
#[test]
fn tiny_and_huge_times_reach_the_long_term_and_keep_the_instantaneous_modulus() {
    let time_step = 1e-3;
    for make in [PronyTerm::exact, PronyTerm::backward_euler] {
        let quick = relaxed(make(0.5, time_step / 100.0, time_step), (0..6).map(|_| 1.0));
        assert!(((1.0 - quick[5]) / 0.5 - 1.0).abs() < 0.01, "{quick:?}");
        let slow = relaxed(make(0.99, 1e6, time_step), (0..1000).map(|_| 1.0));
        assert!(slow[999].abs() < 1e-4 && slow[999] >= 0.0, "{}", slow[999]);
    }
}

/// H16, H34: a term of no weight changes no bit.
#[test]
fn terms_of_no_weight_change_no_bit() {
    for integrator in ["Exact", "BackwardEuler"] {
        for run in configurations() {
            let of = |prony: &str| {
                let mut simulation = run.start(&format!(
                    "(duration: 0.02, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\", spin: (3, 1, 9))}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), {prony})}})"
                ));
                simulation.advance(15).unwrap();
                bits(&mut simulation, "b")
            };
            let with = of(&format!("prony: (terms: [(alpha: 0, tau: 0.1)], integrator: {integrator})"));
            assert_eq!(with, of(""), "{}, {integrator}", run.name);
        }
    }
}
