// Exponential and logarithm by arithmetic and a few moved bits; twin of src/math/elementary.rs. What WGSL has may lose
// all digits of a small argument, and differs from device to device.

// 2^k and e^r − 1 with x = k ln 2 + r
fn exponential_parts(unlimited: f32) -> vec2<f32> {
    let x = clamp(unlimited, -87.0, 88.0);
    let k = round(x * 1.44269504);
    let r = (x - k * 6.9313812256e-1) - k * 9.0580006145e-6;
    var q = 1.0 / 5040.0;
    q = q * r + 1.0 / 720.0;
    q = q * r + 1.0 / 120.0;
    q = q * r + 1.0 / 24.0;
    q = q * r + 1.0 / 6.0;
    q = q * r + 1.0 / 2.0;
    return vec2<f32>(bitcast<f32>(u32(i32(k) + 127) << 23u), r * r * q + r);
}

fn exponential(x: f32) -> f32 {
    let parts = exponential_parts(x);
    return parts.x * parts.y + parts.x;
}

// e^x − 1
fn exponential_less_one(x: f32) -> f32 {
    let parts = exponential_parts(x);
    return parts.x * parts.y + (parts.x - 1.0);
}

// ln(1 + x); with k = 0, f is x itself, so that nothing of a small x is lost
fn logarithm_of_one_plus(x: f32) -> f32 {
    let shifted = bitcast<u32>(1.0 + x) + (0x3f800000u - 0x3f3504f3u);
    let k = f32(i32(shifted >> 23u) - 127);
    let mantissa = bitcast<f32>((shifted & 0x007fffffu) + 0x3f3504f3u);
    let f = select(mantissa - 1.0, x, k == 0.0);
    let s = f / (2.0 + f);
    let square = s * s;
    var q = 2.0 / 9.0;
    q = q * square + 2.0 / 7.0;
    q = q * square + 2.0 / 5.0;
    q = q * square + 2.0 / 3.0;
    return k * 6.9313812256e-1 + (f + (k * 9.0580006145e-6 + s * (square * q - f)));
}
