// x^(−1/3) for x > 0: a guess from the bits and Newton steps, as in src/math/real.rs; a real power would be slow and
// not the same on every device.
fn inverse_cbrt(x: f32) -> f32 {
    let third = x * (-1.0 / 3.0);
    var y = bitcast<f32>(0x54a2fa8cu - bitcast<u32>(x) / 3u);
    y = y * (y * y * y * third + 4.0 / 3.0);
    y = y * (y * y * y * third + 4.0 / 3.0);
    y = y * (y * y * y * third + 4.0 / 3.0);
    return y;
}
