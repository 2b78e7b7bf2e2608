use super::*;

/// Corners and a place, moved against each other as far as is allowed, have the nearest place on the same part; and
/// that is found of many.
#[test]
fn the_part_that_is_kept_is_the_one_after_motion() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut place = |size: f64| size * (DVec3::new(random.f64(), random.f64(), random.f64()) - 0.5);
    let (mut kept, mut all) = (0, 0);
    for _ in 0..2000 {
        let (corners, y) = ([0; 3].map(|_| place(1.0)), place(2.0));
        let found = OnTriangle::nearest(y, corners);
        for moved in [0.003, 0.03] {
            all += 1;
            if !found.keeps_part(y, corners, moved) {
                continue;
            }
            kept += 1;
            // each within half of it: any two within it
            let within = moved / 3.0_f64.sqrt();
            for _ in 0..40 {
                let corners = corners.map(|corner| corner + place(within));
                assert_eq!(OnTriangle::nearest(y + place(within), corners).part, found.part);
            }
        }
    }
    assert!(3 * kept > all, "{kept} of {all}");
}

/// In each region about a triangle, at its borders and where it has no area.
#[test]
fn side_by_side_is_the_same_nearest_place() {
    let mut random = fastrand::Rng::with_seed(8);
    let mut parts = [0; 7];
    for round in 0..20_000 {
        // in some rounds on a grid, where places meet borders
        let mut number = || if round % 4 == 0 { f64::from(random.u8(0..3)) } else { random.f64() };
        let mut place = || [number(), number(), number()];
        let (y, corners) = (place(), [place(), place(), place()]);
        let one_by_one = OnTriangle::nearest(y.into(), corners.map(DVec3::from));
        let Nearest { at, weights, part, distance, normal, gap } = Nearest::of(y, corners);
        let found = OnTriangle { at: at.into(), weights, part: part as usize };
        if !one_by_one.at.is_finite() {
            assert!(!found.at.is_finite(), "{found:?}");
            continue;
        }
        assert_eq!(found, one_by_one, "{y:?}, {corners:?}");
        assert_eq!(distance, DVec3::from(y).distance(one_by_one.at));
        let [a, b, c] = corners.map(DVec3::from);
        let across = (b - a).cross(c - a).normalize_or_zero();
        assert_eq!(across == DVec3::ZERO, !DVec3::from(normal).is_finite());
        if across != DVec3::ZERO {
            assert_eq!((DVec3::from(normal), gap), (across, (DVec3::from(y) - one_by_one.at).dot(across)));
        }
        parts[found.part] += 1;
    }
    assert!(parts.iter().all(|&count| count > 100), "{parts:?}");
}

/// As near to a side as it may be, and with motion straight towards the triangle.
#[test]
fn the_part_is_kept_at_the_limit_of_what_is_allowed() {
    let mut random = fastrand::Rng::with_seed(9);
    let mut vector = || (DVec3::new(random.f64(), random.f64(), random.f64()) - 0.5).normalize();
    let (moved, mut count) = (0.02, 0);
    for _ in 0..400 {
        let corners = [0; 3].map(|_| vector());
        let [a, b, c] = corners;
        let (along, up) = ((b - a).normalize(), (b - a).cross(c - a).normalize());
        let out = along.cross(up);
        let at = |far: f64| a.midpoint(b) + far * (out + 0.3 * up);
        let keeps = |far: f64| {
            let found = OnTriangle::nearest(at(far), corners);
            found.part == 1 && found.keeps_part(at(far), corners, moved)
        };
        if !keeps(0.5) {
            continue;
        }
        count += 1;
        let mut far = [0.0, 0.5];
        for _ in 0..30 {
            let middle = 0.5 * (far[0] + far[1]);
            far[usize::from(keeps(middle))] = middle;
        }
        let lands = |of_y: DVec3, of_corners: [DVec3; 3]| {
            let moved_corners = [0, 1, 2].map(|i| corners[i] + 0.5 * moved * of_corners[i]);
            assert_eq!(OnTriangle::nearest(at(far[1]) + 0.5 * moved * of_y, moved_corners).part, 1);
        };
        lands(-out, [out, out, vector()]);
        lands(-up, [up, up, -out]);
        for _ in 0..100 {
            lands(vector(), [vector(), vector(), vector()]);
        }
    }
    assert!(count > 100, "{count}");
}
