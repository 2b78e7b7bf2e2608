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
