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
