use super::*;

/// Of 200 frames two are long: 99 of 100 are no longer than the others.
#[test]
fn a_hundredth_of_the_frames_may_take_longer() {
    let mut durations = Durations::default();
    (0..198).for_each(|_| durations.count(2e-3));
    (0..2).for_each(|_| durations.count(0.5));
    let found = durations.of_most();
    assert!((2e-3..2.1e-3).contains(&found), "{found}");
    durations.count(0.5);
    let found = durations.of_most();
    assert!((0.5..0.525).contains(&found), "{found}");
    // what is beyond the first and the last
    durations.count(0.0);
    durations.count(1e9);
    durations.count(f64::NAN);
}
