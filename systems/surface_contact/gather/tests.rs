use super::{InStep, Outside, allowed};
use crate::components::{Did, PointState};

const STEP: InStep = InStep { largest: 1e-4, settling: 0.0 };

/// What is kept of a point that may be so deep inside and was so far outside (m).
fn touch(did: Did, in_corner: bool, [allowed, outside]: [f64; 2]) -> [f64; 8] {
    [0.0, 0.0, 0.0, allowed, PointState { did, in_corner }.number(), outside, 0.0, 0.0]
}

fn outside(now: f64, went: f64) -> Outside {
    Outside { now, since: went, went }
}

#[test]
fn states_are_numbers_and_back() {
    for did in [Did::Free, Did::Faces, Did::Sticks, Did::Slides] {
        for in_corner in [false, true] {
            let state = PointState { did, in_corner };
            assert_eq!(PointState::of(state.number()), state);
        }
    }
}

/// As deep as a point is found that was not seen before it may stay, in both walls.
#[test]
fn what_was_not_seen_is_not_thrown_out() {
    let free = touch(Did::Free, false, [0.0; 2]);
    assert_eq!(allowed(&free, &[outside(-2e-5, 0.0)], &STEP), -2e-5);
    assert_eq!(allowed(&free, &[outside(-2e-5, 0.0), outside(-5e-5, 0.0)], &STEP), -5e-5);
}

/// What motion has brought in is not let in: not in one wall, not in both of a corner, however these change places.
#[test]
fn what_has_gone_in_comes_out() {
    for did in [Did::Sticks, Did::Slides] {
        let one = touch(did, false, [0.0, -1e-6]);
        assert_eq!(allowed(&one, &[outside(-2e-6, -1e-6)], &STEP), 0.0);
        // the other wall is met in this step
        for both in [[outside(-2e-6, -1e-6), outside(-3e-6, -8e-6)], [outside(-3e-6, -8e-6), outside(-2e-6, -1e-6)]] {
            assert_eq!(allowed(&one, &both, &STEP), 0.0);
        }
        let two = touch(did, true, [0.0, -4e-6]);
        for both in [[-2e-6, -9e-6], [-9e-6, -2e-6]] {
            assert_eq!(allowed(&two, &both.map(|now| outside(now, 0.0)), &STEP), 0.0);
        }
        assert_eq!(allowed(&two, &[outside(-9e-6, 0.0)], &STEP), 0.0);
    }
}

/// A wall in which a point is found as deep as no motion has brought it is another matter: it may stay so.
#[test]
fn a_wall_that_comes_round_does_not_throw_out() {
    let one = touch(Did::Sticks, false, [0.0, -1e-6]);
    for both in [[outside(-1e-6, 0.0), outside(-1e-3, -1e-6)], [outside(-1e-3, -1e-6), outside(-1e-6, 0.0)]] {
        assert!((allowed(&one, &both, &STEP) + 0.998e-3).abs() < 1e-12);
    }
    // what was sunk in the one and comes before the line where both meet is not let in into the other
    let sunk = touch(Did::Sticks, false, [0.0, -1e-3]);
    assert_eq!(allowed(&sunk, &[outside(-1e-3, 0.0), outside(-9e-4, 0.0)], &STEP), 0.0);
    // as deep as it may have gone is not let in
    let two = touch(Did::Slides, true, [0.0, -1e-6]);
    let found = allowed(&two, &[outside(-1e-6, 0.0), outside(-1e-3, 0.0)], &STEP);
    assert!((found + 1e-3 - (1e-6 + 2e-4)).abs() < 1e-12, "{found}");
}
