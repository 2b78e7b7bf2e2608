use super::*;

/// A control with a tolerance of 1e-3 of 1 m in frames of 10 ms.
fn control() -> StepControl {
    StepControl {
        tolerance: 1e-3,
        frame: 0.01,
        smallest: 1e-6,
        scale: 1.0,
        grows: false,
        taken_back: false,
        state: Controlled { next: 0, wanted: 0.01, longest: 0.01, before: None, largest: 0.0 },
    }
}

/// Takes steps whose errors are those of `of` a length, until a time; lengths of those taken, and how many were not.
fn run(control: &mut StepControl, until: f64, corners: &[f64], of: impl Fn(f64, f64) -> f64) -> (Vec<f64>, u64) {
    let mut clock = Clock::with_step(0.01);
    let (mut taken, mut back) = (Vec::new(), 0);
    while clock.time() < until - 1e-9 {
        loop {
            let corner = corners.iter().copied().find(|corner| *corner > control.after(&clock));
            if let Some((length, _)) = control.choose(&clock, corner, until) {
                clock.change_step(length);
            }
            let length = clock.time_step;
            if control.takes(length, of(clock.time(), length), 0.0, 1) {
                break;
            }
            back += 1;
        }
        taken.push(clock.time_step);
        clock.step += 1;
    }
    assert!((clock.time() - until).abs() < 1e-9, "{}", clock.time());
    (taken, back)
}

#[test]
fn a_tolerance_that_does_not_bind_leaves_frames() {
    let (taken, back) = run(&mut control(), 0.2, &[], |_, length| 1e-3 * length);
    assert_eq!((taken, back), (vec![0.01; 20], 0));
}

#[test]
fn steps_settle_where_errors_are_a_little_below_the_tolerance() {
    // e = ½ h² a: h = tol/(½ a T) is the largest
    let (taken, back) = run(&mut control(), 0.2, &[], |_, length| 0.5 * 400.0 * length * length);
    let largest = 1e-3 / (0.5 * 400.0 * 0.01);
    let settled = &taken[taken.len() / 2..];
    assert!(settled.iter().all(|&length| length <= largest && length > 0.5 * largest), "{settled:?} of {largest}");
    assert!(back <= 3, "{back} steps were taken back");
}

#[test]
fn frames_and_corners_are_the_ends_of_steps() {
    let corner = 0.0437;
    let mut control = control();
    let (taken, _) = run(&mut control, 0.1, &[corner], |_, length| 2e2 * length * length);
    let ends: Vec<f64> = taken
        .iter()
        .scan(0.0, |at, length| {
            *at += length;
            Some(*at)
        })
        .collect();
    for wanted in (1..=10).map(|frame| 0.01 * f64::from(frame)).chain([corner]) {
        assert!(ends.iter().any(|end| (end - wanted).abs() < 1e-9), "{wanted} s: {ends:?}");
    }
}

#[test]
fn what_is_no_number_is_taken_back_until_the_shortest_step() {
    let mut control = control();
    assert!(!control.takes(0.01, f64::NAN, 0.0, 1));
    assert!(control.state.wanted < 0.01);
    assert!(control.takes(1e-6, f64::NAN, 0.0, 1) && control.is_beyond());
    assert!(control.cut_back(1e-3) && !control.cut_back(1e-6));
    assert!(control.state.is_sound());
}
