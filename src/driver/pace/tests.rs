use super::*;

#[test]
fn what_falls_short_is_not_caught_up_and_what_is_early_is_waited_for() {
    let frame = Duration::from_millis(16);
    let mut pace = Pace { speed: 0.5, ..Pace::new() };
    assert!((pace.until(0.0, frame) - 0.008).abs() < 1e-12);
    // a step went beyond: the next frame goes less far
    pace.note(0.01, 0.01, frame, false);
    assert!((pace.until(0.01, frame) - 0.016).abs() < 1e-12);
    // it came to 0.011 s only
    pace.note(0.011, 0.001, frame, true);
    assert!((pace.until(0.011, frame) - 0.019).abs() < 1e-12);
    // the window was away for a minute
    assert!((pace.until(0.019, Duration::from_secs(60)) - 0.069).abs() < 1e-12);
}

#[test]
fn the_factor_is_what_was_simulated_over_the_wall() {
    let mut pace = Pace::new();
    assert_eq!(pace.factor(), None);
    for _ in 0..400 {
        pace.note(0.0, 0.004, Duration::from_millis(16), true);
    }
    assert!(pace.factor().is_some_and(|factor| (factor - 0.25).abs() < 1e-9), "{pace:?}");
    pace.stand(3.0);
    assert_eq!(pace.factor(), None);
    assert!((pace.until(3.0, Duration::ZERO) - 3.0).abs() < 1e-12);
}
