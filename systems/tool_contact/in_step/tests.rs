use super::*;

/// Rounded places of all that a bound holds are within the rounded one, near the surface and far from the
/// reference; and that is not much larger.
#[test]
fn rounding_leaves_nobody_out() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut vector = |size: f64| size * (2.0 * DVec3::new(random.f64(), random.f64(), random.f64()) - 1.0);
    let (mut held, mut left_out) = (0, 0);
    for turn in 0..20_000 {
        let extent = [0.01, 1.0, 300.0][turn % 3];
        let (center, rest) = (vector(extent), vector(extent / 2.0));
        let (direction, away) = (vector(1.0).normalize(), vector(1.0).x);
        // who is on the surface, or off by as much as rounding does
        let place = center + direction * (0.3 + 1e-6 * away * extent);
        let rounded = rest.as_vec3() + (place - rest).as_vec3();
        let normal = vector(1.0).normalize();
        let below = Bound::Below(normal, normal.dot(center + direction * 0.3));
        for bound in [Bound::Ball(center, 0.09), below] {
            if bound.holds(place) {
                held += 1;
                assert!(bound.around(extent).holds(rounded), "{place} of {extent}");
            }
            let far = rounded
                + (1e-4 * (0.3 + 4.0 * extent)) as f32
                    * match bound {
                        Bound::Ball(..) => direction.as_vec3(),
                        Bound::Below(normal, _) => normal.as_vec3(),
                    };
            left_out += i32::from(!bound.around(extent).holds(far));
        }
    }
    assert!(held > 10_000 && left_out == 40_000, "{held}, {left_out}");
}
