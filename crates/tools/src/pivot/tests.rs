use super::*;

#[test]
fn closest_approach_is_that_of_segments_and_of_what_moves_add() {
    let at = |x, y, z| DVec3::new(x, y, z);
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    near(closest_approach(&[at(1.0, 0.0, 0.0)], &[], at(0.0, 0.0, 0.0)), 1.0);
    near(closest_approach(&[at(-1.0, 1.0, 0.0), at(1.0, 1.0, 0.0)], &[], at(0.5, 0.0, 0.0)), 1.0);
    near(closest_approach(&[at(-1.0, 1.0, 0.0), at(1.0, 1.0, 0.0)], &[], at(4.0, 5.0, 0.0)), 5.0);
    // away from the point, and not through it, though the move is longer than the way there
    let away = [(at(0.0, 0.0, -5.0), [0.0, 1.0])];
    near(closest_approach(&[at(0.0, 0.0, -1.0)], &away, at(0.0, 0.0, 0.0)), 1.0);
    near(closest_approach(&[at(0.0, 0.0, -1.0)], &[(at(0.0, 0.0, -5.0), [-1.0, 1.0])], at(0.0, 0.0, 0.0)), 0.0);
    let two = [(at(1.0, 0.0, 0.0), [0.0, 2.0]), (at(0.0, 1.0, 0.0), [0.0, 1.0])];
    near(closest_approach(&[at(0.0, 0.0, 0.0)], &two, at(3.0, 3.0, 2.0)), 3.0);
}
