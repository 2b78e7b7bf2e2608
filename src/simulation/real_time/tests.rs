use super::*;

#[test]
fn who_is_early_waits_and_who_is_late_goes_on_from_there() {
    let mut metronome = Metronome::default();
    let start = Instant::now();
    let at = |ms: f64| start + Duration::from_secs_f64(1e-3 * ms);
    let mut wait = |life: f64, simulated: f64| {
        let wait = metronome.wait(at(life), 1e-3 * simulated).as_secs_f64();
        ((1e6 * wait).round(), metronome.kept.late)
    };
    assert_eq!(wait(5.0, 0.0), (0.0, 0));
    assert_eq!(wait(5.4, 1.0), (600.0, 0));
    // .8 ms behind, which it may catch up
    assert_eq!(wait(7.8, 2.0), (0.0, 0));
    assert_eq!(wait(7.9, 3.0), (100.0, 0));
    // 3 ms behind: nothing is caught up
    assert_eq!(wait(12.0, 4.0), (0.0, 1));
    assert_eq!(wait(12.5, 5.0), (500.0, 1));
    // back at an earlier time
    assert_eq!(wait(20.0, 0.0), (0.0, 1));
    assert_eq!(wait(20.0, 1.0), (1000.0, 1));
    assert_eq!(metronome.kept.ticks, 8);
}
