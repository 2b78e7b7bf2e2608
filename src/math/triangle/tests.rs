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
