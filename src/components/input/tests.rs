use super::*;

fn at(step: u64) -> Clock {
    Clock { step, ..Clock::with_step(0.25) }
}

fn set(input: &mut Input, value: f64, step: u64) -> Option<Change> {
    input.set(value);
    input.take_up(&at(step))
}

#[test]
fn goes_where_it_is_set_no_faster_than_its_rate() {
    let mut input = Input::new("tool", 1.0, Some(2.0));
    assert_eq!((input.course().value(9.0), input.take_up(&at(3))), (1.0, None));
    assert_eq!(set(&mut input, 2.0, 4), Some(Change::Quickens));
    // from 1 at 1 s to 2 at 1.5 s
    assert_eq!([0.9, 1.0, 1.25, 1.5, 7.0].map(|time| input.course().value(time)), [1.0, 1.0, 1.5, 2.0, 2.0]);
    // turned round on the way; loads that look back see where it came from
    assert_eq!(set(&mut input, 0.0, 5), Some(Change::Moves));
    assert_eq!([1.125, 1.25, 1.5, 2.0, 7.0].map(|time| input.course().value(time)), [1.25, 1.5, 1.0, 0.0, 0.0]);
    assert_eq!(input.course().mean((1.125, 1.375)), 0.25 * (1.25 + 1.5 + 1.5 + 1.25));
}

#[test]
fn a_second_time_before_the_same_step_it_goes_from_where_it_was_before_the_first() {
    for rate in [None, Some(2.0)] {
        let [mut once, mut twice] = [Input::new("tool", 0.0, rate), Input::new("tool", 0.0, rate)];
        for input in [&mut once, &mut twice] {
            set(input, 0.5, 2);
        }
        set(&mut twice, 4.0, 4);
        for input in [&mut once, &mut twice] {
            assert_eq!(set(input, 0.25, 4), Some(Change::Moves));
        }
        assert_eq!(twice.course(), once.course());
        // of half a window of 0.5 and half of what comes
        let mean = twice.course().mean((0.875, 1.125));
        assert_eq!(mean, if rate.is_none() { 0.375 } else { 0.4375 });
    }
}

#[test]
fn a_rate_too_slow_for_any_clock_leaves_numbers() {
    let mut input = Input::new("tool", 0.0, Some(1e-320));
    set(&mut input, f64::from(f32::MAX), 4);
    assert!(input.course().value(9.0) < 1e-200 && input.course().mean((1.0, 2.0)) < 1e-200);
    set(&mut input, -f64::from(f32::MAX), 5);
    assert!(input.state.is_sound() && input.course().value(1e9).abs() < 1e-200);
    assert_eq!(input.largest(), f64::from(f32::MAX));
}

#[test]
fn jumps_without_a_rate_and_acts_as_a_mean() {
    let mut input = Input::new("tool", 0.0, None);
    assert_eq!(set(&mut input, 4.0, 4), Some(Change::Quickens));
    assert_eq!((input.course().value(0.99), input.course().value(1.0)), (0.0, 4.0));
    assert_eq!(input.course().mean((0.875, 1.125)), 2.0);
    assert_eq!(set(&mut input, 4.0, 6), None);
    assert_eq!(set(&mut input, -4.0, 6), Some(Change::Moves));
    assert_eq!(set(&mut input, 20.0, 8), Some(Change::Quickens));
    assert!(input.has_jumped() && input.state.is_sound());
    // what is past is forgotten
    for step in 9..1000 {
        set(&mut input, step as f64, step);
    }
    assert!(matches!(input.course(), Curve::Table(points) if points.len() < 10));
}
