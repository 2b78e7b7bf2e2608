use super::*;

#[test]
fn coordinates_have_the_digits_that_a_size_asks_for() {
    let at = DVec3::new(0.01234567, -1.2e-6, 0.0);
    assert_eq!(coordinates(at, 2.0), "0.0123, -0.0000, 0.0000");
    assert_eq!(coordinates(at, 0.02), "0.0123, -0.0000, 0.0000");
    assert_eq!(coordinates(at, 2e-5), "0.0123457, -0.0000012, 0.0000000");
    for nothing in [0.0, f64::NAN, f64::INFINITY] {
        assert!(digits_beside(nothing) >= 4, "{nothing}");
    }
}
