#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::*;

/// Runs over steps, the last of which is the end, and gives all rows; values are 3 t and the step.
fn table(track: &mut Track, steps: u64, time_step: f64) -> (Vec<Row>, Vec<u64>) {
    let (mut rows, mut samples, mut step) = (Vec::new(), Vec::new(), 0);
    loop {
        let time = step as f64 * time_step;
        let row = (time, vec![3.0 * time, step as f64]);
        samples.push(step);
        rows.extend(track.rows(step, step == steps, &row));
        if track.precedes(step) {
            track.keep(step, row);
        }
        if step == steps {
            return (rows, samples);
        }
        step = track.next_sample(step).min(steps);
    }
}

#[test]
fn rows_are_at_the_times_that_are_asked_for() {
    // 2.3 steps to an interval, and an end that is none
    let (rows, samples) = table(&mut Track::new(Cadence::new(0.23, 0.1)), 10, 0.1);
    let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
    assert_eq!(times, [0.0, 0.23, 0.46, 0.69, 0.92, 1.0]);
    assert_eq!(rows.len() as u64, Cadence::new(0.23, 0.1).rows(10));
    for (time, values) in &rows {
        assert!((values[0] - 3.0 * time).abs() < 1e-12 && (values[1] - 10.0 * time).abs() < 1e-12, "{time} {values:?}");
    }
    // both ends of the steps in between, and no others
    assert_eq!(samples, [0, 2, 3, 4, 5, 6, 7, 9, 10]);
}

#[test]
fn whole_numbers_of_steps_are_observed_once() {
    let (rows, samples) = table(&mut Track::new(Cadence::new(0.3, 0.1)), 9, 0.1);
    assert_eq!(rows.iter().map(|row| row.0).collect::<Vec<_>>(), [0.0, 0.3, 0.6, 0.9]);
    assert_eq!(samples, [0, 3, 6, 9]);
    assert_eq!(Cadence::new(0.3, 0.1).rows(9), 4);
}

#[test]
fn what_is_asked_for_more_often_than_there_are_steps_has_a_row_a_step() {
    let (rows, _) = table(&mut Track::new(Cadence::new(0.01, 0.1)), 3, 0.1);
    assert_eq!(rows.iter().map(|row| row.1[1]).collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(Cadence::new(0.01, 0.1).rows(3), 4);
}

#[test]
fn a_row_without_a_beginning_says_the_time_of_its_end() {
    let track = Track::new(Cadence::new(0.25, 0.1));
    assert_eq!(track.rows(3, false, &(0.3, vec![7.0])), [(0.3, vec![7.0])]);
}
