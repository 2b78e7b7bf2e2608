use super::*;

/// Both roots of z² − (2 − κΔt² − γΔt) z + 1 − γΔt lie within the unit circle just below the step, and not above:
/// there z = −1.
#[test]
fn a_spring_and_a_damper_are_stable_up_to_the_step_and_not_beyond() {
    for (square, rate, own) in [(4.0, 0.0, 0.0), (0.0, 3.0, 0.0), (9.0, 3.0, 25.0), (0.0, 0.0, 16.0), (1e-3, 1e3, 1.0)]
    {
        let loads = LoadRates(ForceSlopes { stiffness: square, damping: rate });
        let limit = loads.with(2.0 / f64::sqrt(own));
        let at_minus_one = |step: f64| 4.0 - (own + square) * step * step - 2.0 * rate * step;
        assert!(at_minus_one(0.999 * limit) > 0.0 && at_minus_one(1.001 * limit) < 0.0, "{loads:?}, {own}");
    }
    assert_eq!(LoadRates::default().with(0.3), 0.3);
}
