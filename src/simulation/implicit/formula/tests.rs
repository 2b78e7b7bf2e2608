use super::*;

/// The matrix that takes (u, h v, h² a) of one undamped axis of frequency ω a step on.
fn step(formula: &Formula, product: f64, [u, v, a]: [f64; 3]) -> [f64; 3] {
    // unit mass and step: stiffness (ωh)²
    let k = product * product;
    let y = u + v;
    let constant =
        formula.inertial_force(1.0, 0.0, [v, 0.0], [a, formula.acceleration(1.0, 0.0, a)]) + formula.alpha_f * k * u;
    let operator = formula.inertia(1.0, 1.0, 0.0) + formula.stiffness() * k;
    let w = y - (constant + formula.stiffness() * k * y) / operator;
    let after = formula.acceleration(1.0, w - y, a);
    [w, formula.velocity(1.0, v, [a, after]), after]
}

/// The largest modulus of an eigenvalue, by a power of the matrix.
fn spectral_radius(formula: &Formula, product: f64) -> f64 {
    let (steps, mut growth) = (4000, 0.0_f64);
    // of a size of 1 in units of its motion, whose logarithm over the steps is what the start adds to the answer
    let mut state = [1.0, 0.3 * product, -0.7 * product * product];
    for _ in 0..steps {
        state = step(formula, product, state);
        let size = state[0].abs().max(state[1].abs() / (1.0 + product)).max(state[2].abs() / (1.0 + product * product));
        growth += size.ln();
        state = state.map(|x| x / size);
    }
    (growth / f64::from(steps)).exp()
}

#[test]
fn high_frequencies_keep_the_share_that_is_asked_for() {
    for rho in [0.0, 0.5, 0.8, 1.0] {
        let formula = Formula::of(ImplicitScheme::GeneralizedAlpha { high_frequencies: rho });
        let found = spectral_radius(&formula, 1e5);
        // a double eigenvalue: powers of it grow by their number once
        let bound = 8.0 * (4000.0_f64).ln() / 4000.0;
        assert!((found - rho).abs() < bound, "{rho}: {found}");
        let slow = spectral_radius(&formula, 1e-3);
        assert!((slow - 1.0).abs() < 1e-3, "{rho}, slow: {slow}");
    }
}

#[test]
fn euler_damps_by_its_modulus_and_the_trapezoidal_rule_by_nothing() {
    let euler = Formula::of(ImplicitScheme::Euler);
    let trapezoidal = Formula::of(ImplicitScheme::GeneralizedAlpha { high_frequencies: 1.0 });
    for product in [0.01, 0.3, 1.0, 4.0] {
        // whole turns, so that the phase has no part: of the modulus n steps leave its n-th power
        let found = spectral_radius(&euler, product);
        let expected = (1.0 + product * product).powf(-0.5);
        assert!((found / expected - 1.0).abs() < 1e-3, "{product}: {found}, not {expected}");
        let kept = spectral_radius(&trapezoidal, product);
        assert!((kept - 1.0).abs() < 2e-3, "{product}: {kept}");
    }
}
