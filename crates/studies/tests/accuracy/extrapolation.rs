//! Richardson's extrapolation, orders, fronts, oscillations: against sequences whose answer is known.

use sinew_studies::accuracy::oscillation::oscillation;
use sinew_studies::accuracy::pareto::{front, observed_order};
use sinew_studies::accuracy::quantities::mean_square;
use sinew_studies::accuracy::richardson::{extrapolate, extrapolate_two};

fn limit(sizes: [f64; 3], of: impl Fn(f64) -> f64) -> sinew_studies::accuracy::richardson::Limit {
    let values = sizes.map(|h| [of(h)]);
    extrapolate(sizes, [&values[0], &values[1], &values[2]], mean_square)
}

#[test]
fn a_power_of_the_cell_size_gives_its_order_and_its_limit_back() {
    for order in [0.8, 1.0, 1.5, 2.0, 3.0] {
        for sizes in [[1.0, 0.5, 0.25], [1.0, 2.0 / 3.0, 0.5], [1.0, 0.5, 1.0 / 3.0]] {
            let found = limit(sizes, |h| 3.0 - 0.7 * h.powf(order));
            assert!((found.order.unwrap() - order).abs() < 1e-9, "{order} {sizes:?}: {found:?}");
            assert!((found.values[0] - 3.0).abs() < 1e-9, "{order} {sizes:?}: {found:?}");
        }
    }
}

#[test]
fn the_truth_lies_within_the_uncertainty_when_two_powers_mix() {
    for (first, second, exponents) in [(0.3, 0.2, (2.0, 4.0)), (-0.3, 0.2, (1.0, 2.0)), (0.5, 0.1, (1.6, 3.0))] {
        let found = limit([1.0, 0.5, 0.25], |h| 1.0 + first * h.powf(exponents.0) + second * h.powf(exponents.1));
        let off = (found.values[0] - 1.0).abs();
        assert!(off <= found.uncertainty, "off by {off}, says {}", found.uncertainty);
        assert!(found.uncertainty < 0.2, "{found:?}");
    }
}

#[test]
fn results_that_follow_no_power_are_not_extrapolated_and_three_times_as_uncertain_as_they_are_apart() {
    // (of differences as large as each other or growing: see below)
    for values in [[1.0, 2.0, 1.5], [1.0, 0.0, 0.1], [1.0, 1.1, 2.0]] {
        let found = extrapolate([1.0, 0.5, 0.25], [&values[..1], &values[1..2], &values[2..]], mean_square);
        assert_eq!((found.order, found.values[0]), (None, values[2]));
        assert_eq!(found.uncertainty, 3.0 * (values[0] - values[1]).abs().max((values[0] - values[2]).abs()));
    }
}

#[test]
fn results_that_run_apart_are_so_uncertain_that_a_locked_mesh_is_not_believed() {
    // Cook's panel of Tet4 (docs/accuracy.md): three meshes agree within 4 % and are 71 to 74 % off
    let values = [0.2594, 0.2668, 0.2920];
    let found = extrapolate([1.0, 0.5, 0.25], [&values[..1], &values[1..2], &values[2..]], mean_square);
    assert_eq!(found.order, None);
    assert!(found.values[0] + found.uncertainty > 1.0, "{found:?}");
}

#[test]
fn results_that_turn_round_are_three_times_as_uncertain_as_they_are_apart_and_no_more() {
    // a probe whose nodes are others on each mesh: -4.6 %, then 8.7 % back
    let found = extrapolate([1.0, 0.5, 0.25], [&[-8.62], &[-9.02], &[-8.24]], |values| values[0].abs());
    assert!((found.uncertainty - 3.0 * 0.78).abs() < 1e-12 && found.order.is_none(), "{found:?}");
}

#[test]
fn two_results_bound_the_error_of_all_orders_from_a_half_on() {
    for order in [0.5, 1.0, 1.5, 2.0, 3.0] {
        let [middle, fine] = [1.0, 0.5].map(|h: f64| [2.0 - 0.3 * h.powf(order)]);
        let found = extrapolate_two([1.0, 0.5], [&middle, &fine], mean_square);
        let off = (found.values[0] - 2.0).abs();
        assert!(found.order.is_none() && off <= found.uncertainty, "{order}: off by {off}, says {found:?}");
    }
}

#[test]
fn an_order_above_the_formal_one_is_no_reason_to_be_sure() {
    // an error that falls with the cell size, and beside it one that is gone after the second mesh
    let found = limit([1.0, 0.5, 0.25], |h| 1.0 + 0.02 * h.powf(1.1) + if h > 0.9 { 0.05 } else { 0.0 });
    assert!(found.order.unwrap() > 3.0, "{found:?}");
    let off = (found.values[0] - 1.0).abs();
    assert!(off <= found.uncertainty, "off by {off}, says {found:?}");
}

#[test]
fn equal_results_are_their_own_limit() {
    let found = limit([1.0, 0.5, 0.25], |_| 7.0);
    assert_eq!(found.values, [7.0]);
    assert!(found.uncertainty < 1e-12);
}

#[test]
fn the_front_holds_what_nothing_beats_and_nothing_else() {
    let nan = f64::NAN;
    let points = [(1.0, 0.1), (2.0, 0.05), (2.0, 0.2), (3.0, 0.05), (nan, 0.0), (1.0, 0.1), (9.0, 0.01)];
    assert_eq!(front(&points), [true, true, false, false, false, false, true]);
    assert!(front(&[]).is_empty());
}

#[test]
fn an_order_is_the_slope_in_logarithms() {
    let points: Vec<(f64, f64)> = [1.0, 0.5, 0.25].map(|h: f64| (h, 3.0 * h.powf(1.7))).to_vec();
    assert!((observed_order(&points).unwrap() - 1.7).abs() < 1e-12);
    assert_eq!(observed_order(&points[..1]), None);
    assert_eq!(observed_order(&[(1.0, 0.0), (0.5, 0.1)]), None);
}

#[test]
fn amplitude_and_period_of_a_sine_come_back() {
    let times: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.01).collect();
    let values: Vec<f64> = times.iter().map(|t| 5.0 + 0.3 * (std::f64::consts::TAU * t / 0.37).sin()).collect();
    let found = oscillation(&times, &values).unwrap();
    assert!((found.period - 0.37).abs() < 1e-4, "{found:?}");
    assert!((found.amplitude - 0.3).abs() < 1e-3, "{found:?}");
}

#[test]
fn what_comes_to_rest_or_stands_still_does_not_swing() {
    let times: Vec<f64> = (0..=100).map(|i| f64::from(i) * 0.01).collect();
    let rest: Vec<f64> = times.iter().map(|t| 1.0 - (-5.0 * t).exp()).collect();
    assert_eq!(oscillation(&times, &rest), None);
    assert_eq!(oscillation(&times, &vec![2.0; times.len()]), None);
    assert_eq!(oscillation(&[], &[]), None);
}
