use super::*;

#[test]
fn inverse_cube_root_is_right_to_a_few_ulp() {
    let (mut worst32, mut worst64) = (0.0_f64, 0.0_f64);
    for i in 1..400_000 {
        let x = i as f64 * 1e-4;
        let x32 = x as f32;
        worst32 = worst32.max((x32.inverse_cbrt() as f64 * (x32 as f64).cbrt() - 1.0).abs());
        worst64 = worst64.max((x.inverse_cbrt() * x.cbrt() - 1.0).abs());
    }
    assert!(worst32 < 2.0 * f32::EPSILON as f64, "f32: {worst32:e}");
    assert!(worst64 < 4.0 * f64::EPSILON, "f64: {worst64:e}");
}
