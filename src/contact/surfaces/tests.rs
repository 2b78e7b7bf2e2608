use super::*;

#[test]
fn angles_are_those_of_sines_and_cosines() {
    for step in 0..=1000 {
        let exact = PI * f64::from(step) / 1000.0;
        for scale in [1e-9, 1.0, 1e9] {
            let found = angle(scale * exact.sin(), scale * exact.cos());
            assert!((found - exact).abs() < 1.2e-5, "{exact}: {found}");
        }
    }
    assert_eq!(angle(0.0, 0.0), 0.0);
}
