#![allow(clippy::panic)]

use super::*;

/// How often it looks until the work has fallen to the share that is asked for.
fn looks(work: impl Fn(f64) -> f64) -> u32 {
    let (mut bracket, mut share) = (Bracket::from(work(0.0), 1.0), 1.0);
    for look in 0..50 {
        if work(share).abs() <= FOUND * work(0.0).abs() {
            return look;
        }
        share = bracket.next(share, work(share));
    }
    panic!("not found: {bracket:?}");
}

#[test]
fn it_finds_where_a_spring_begins_to_touch() {
    for stiffness in [1e1, 1e3, 1e6] {
        for at in [0.01, 0.1, 0.4, 0.9] {
            let found = looks(|share| share - 1.0 + stiffness * (share - at).max(0.0));
            assert!(found <= MOST_LOOKS, "{stiffness} at {at}: {found}");
        }
    }
}

#[test]
fn what_is_no_number_ends_a_way() {
    let found = looks(|share| if share > 0.3 { f64::NAN } else { 2.0 * share - 1.0 });
    assert!(found <= 3, "{found}");
}
