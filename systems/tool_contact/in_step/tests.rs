use super::*;

/// Of places in random boxes: a bound that holds one meets the box, and most that hold none do not.
#[test]
fn no_bound_holds_a_place_in_a_box_that_it_does_not_meet() {
    let mut random = fastrand::Rng::with_seed(64);
    let mut counts = [0; 3];
    for round in 0..20_000 {
        let mut vector = |size: f64| DVec3::from_array([0; 3].map(|_| size * (2.0 * random.f64() - 1.0)));
        let middle = vector(1.0);
        let places = [0; 16].map(|_| middle + vector(0.3));
        let all = || places.into_iter();
        let within = [all().fold(places[0], DVec3::min), all().fold(places[0], DVec3::max)];
        let (center, normal) = (vector(2.0), vector(1.0).normalize());
        // as far as one of the places, where rounding decides, and not quite
        let bound = match round % 4 {
            0 => Bound::Ball(center, center.distance_squared(places[3])),
            1 => Bound::Ball(center, 0.6 * center.distance_squared(places[3])),
            2 => Bound::Below(normal, normal.dot(places[3])),
            _ => Bound::Below(normal, normal.dot(places[3]) - 0.6),
        };
        let holds = all().any(|place| bound.holds(place));
        counts[usize::from(holds) + usize::from(bound.meets(within))] += 1;
        assert!(bound.meets(within) || !holds, "{round}");
    }
    assert!(counts[0] > 3000 && counts[2] >= 10_000 && counts[1] < counts[0], "{counts:?}");
}
