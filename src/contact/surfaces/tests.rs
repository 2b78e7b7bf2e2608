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

#[test]
fn the_deepest_inside_is_that_of_any_triangle() {
    let of = |depths: &[f64]| Surfaces::new(3, vec![[0, 1, 2]; depths.len()], vec![0; depths.len()], depths.to_vec());
    assert_eq!([&[][..], &[0.5], &[0.1, 0.3, 0.2]].map(|depths| of(depths).deepest()), [0.0, 0.5, 0.3]);
}
