use super::*;

/// Against sums of a hundred thousand values.
#[test]
fn means_are_those_of_many_values() {
    let curves = [
        Curve::Step { start: 0.21, end: Some(0.24) },
        Curve::Step { start: 0.3, end: None },
        Curve::Ramp { start: 0.1, end: 0.45 },
        Curve::Smooth { start: 0.05, end: 0.31 },
        Curve::Table(vec![(0.1, 1.0), (0.2, -3.0), (0.21, 5.0), (0.4, 0.0)]),
    ];
    for curve in curves {
        for window in [(0.0, 0.5), (0.2, 0.25), (0.26, 0.29), (0.0, 0.01), (0.1, 0.4), (0.6, 0.7)] {
            let count = 100_000;
            let time = |i: usize| window.0 + (window.1 - window.0) * (i as f64 + 0.5) / f64::from(count);
            let sum: f64 = (0..count as usize).map(|i| curve.value(time(i))).sum();
            let (mean, expected) = (curve.mean(window), sum / f64::from(count));
            // a value beside a jump may be on the wrong side of it
            assert!((mean - expected).abs() <= 2e-5, "{curve:?} over {window:?}: {mean}, expected {expected}");
        }
    }
}

#[test]
fn constant_curve_is_one_exactly() {
    assert_eq!(Curve::default().mean((0.0, 1e-3)), 1.0);
    assert_eq!(Curve::default().mean((0.1, 0.1 + 1e-3)), 1.0);
}

#[test]
fn a_curve_quickens_where_it_begins_and_where_it_is_twice_as_fast() {
    let table = Curve::Table(vec![(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 0.0), (4.0, 3.0), (5.0, 5.0)]);
    let all: Vec<f64> = std::iter::successors(table.quickens_after(-1.0), |&at| table.quickens_after(at)).collect();
    assert_eq!(all, [1.0, 3.0]);
    assert_eq!(Curve::Smooth { start: 0.5, end: 1.0 }.quickens_after(0.0), Some(0.5));
    assert_eq!(Curve::Smooth { start: 0.5, end: 1.0 }.quickens_after(0.5), None);
    assert_eq!(Curve::Step { start: 0.0, end: Some(2.0) }.quickens_after(0.0), Some(2.0));
}

#[test]
fn the_largest_value_is_that_until_a_time() {
    let table = Curve::Table(vec![(0.0, 0.5), (0.1, 2.0), (0.2, 0.0), (50.0, 100.0)]);
    for (until, expected) in [(0.05, 1.25), (0.1, 2.0), (0.3, 2.0), (25.1, 50.0), (60.0, 100.0)] {
        let found = table.largest(until);
        assert!((found - expected).abs() < 1e-12, "until {until}: {found}, expected {expected}");
    }
    let late = Curve::Step { start: 5.0, end: None };
    assert_eq!([1.0, 5.0, 5.1].map(|until| late.largest(until)), [0.0, 0.0, 1.0]);
    assert_eq!(Curve::Step { start: 0.0, end: Some(0.1) }.largest(1.0), 1.0);
    assert_eq!(Curve::Ramp { start: 1.0, end: 3.0 }.largest(2.0), 0.5);
    assert_eq!(Curve::Smooth { start: 1.0, end: 3.0 }.largest(1.0), 0.0);
    assert_eq!(Curve::Input { name: "x".into(), initial: 2.0, rate: None }.largest(0.1), 2.0);
}

#[test]
fn finest_is_the_shortest_piece() {
    assert_eq!(Curve::default().finest(), None);
    assert_eq!(Curve::Ramp { start: 1.0, end: 1.5 }.finest(), Some(0.5));
    assert_eq!(Curve::Table(vec![(0.0, 0.0), (2.0, 1.0), (2.25, 0.0)]).finest(), Some(0.25));
}
