//! Implicit steps beside explicit ones of the same scene: how far they are apart falls by the order of the scheme.

use crate::configurations::ELEMENTS;
use crate::implicit::{EFFECTS, cube, options};
use sinew::components::Precision;

const TIME: f64 = 0.16;

/// How far the top of a cube is at the end where explicit steps of a part of 32 of the stable one have it, and how far
/// off explicit steps are that are as long as they may be.
fn explicit(elements: &str) -> (f64, f64) {
    let f64s = options(Precision::F64, 1);
    let (_, longest) = cube("", elements, EFFECTS, 0.0, &f64s);
    let steps = (TIME / longest.time_step()).ceil();
    let by = |steps: f64| cube(&format!("integration: (step: {:?}),", TIME / steps), elements, EFFECTS, TIME, &f64s).0;
    let (exact, found) = (by(32.0 * steps), by(steps));
    println!("{elements}: {exact:e}, {:e} off in {steps} steps", found - exact);
    (exact, (found - exact).abs())
}

/// By a scheme, whose steps are a hundredth of a second over these.
fn distances(elements: &str, scheme: &str, parts: &[u32], exact: f64) -> Vec<f64> {
    let distance = |part: &u32| {
        let step = 0.01 / f64::from(*part);
        let solver = format!("solver: Implicit(scheme: {scheme}, step: {step:?}, tolerance: 1e-9),");
        (cube(&solver, elements, EFFECTS, TIME, &options(Precision::F64, 1)).0 - exact).abs()
    };
    let found = parts.iter().map(distance).collect();
    println!("{elements}, {scheme}: {found:?}");
    found
}

const ALPHA: &str = "GeneralizedAlpha(high_frequencies: 0.8)";

/// Each distance over the next is a power of two of the order, to a tenth that the next order has in it, and to what
/// explicit steps are off by that are a part of 32 of others, whose error is told.
fn fall_by(order: f64, distances: &[f64], of_explicit: f64, what: &str) {
    for pair in distances.windows(2) {
        let found = (pair[0] / pair[1]).log2();
        let allowed = 0.1 + of_explicit / 32_f64.powi(2) / pair[1] / std::f64::consts::LN_2;
        assert!((found - order).abs() < allowed, "{what}: {distances:?}, of order {found} ± {allowed}");
    }
}

/// Of first order by implicit Euler, of second by generalised-α, from 5 ms on, a sixth of the period of what swings
/// most, until generalised-α is no farther off than explicit steps are.
#[test]
fn distances_to_explicit_steps_fall_by_the_order_of_the_scheme() {
    let elements = "Tet4";
    let (exact, of_explicit) = explicit(elements);
    let euler = distances(elements, "Euler", &[2, 4, 8, 16], exact);
    fall_by(1.0, &euler, of_explicit, "Euler");
    let alpha = distances(elements, ALPHA, &[2, 4, 8, 16], exact);
    fall_by(2.0, &alpha, of_explicit, ALPHA);
    assert!(euler[0] < 0.1 * exact.abs() && alpha[3] < of_explicit, "{alpha:?}, {of_explicit:e}");
}

/// Of every element: of second order, wedges and hexahedra with one point and control of their hourglasses, too.
#[test]
#[ignore = "long"]
fn so_they_do_of_every_element() {
    for elements in ELEMENTS {
        let (exact, of_explicit) = explicit(elements);
        fall_by(1.0, &distances(elements, "Euler", &[2, 4, 8, 16], exact), of_explicit, elements);
        let alpha = distances(elements, ALPHA, &[2, 4, 8, 16, 32], exact);
        fall_by(2.0, &alpha, of_explicit, elements);
        assert!(alpha[4] < of_explicit, "{elements}: {alpha:?}, {of_explicit:e}");
    }
}
