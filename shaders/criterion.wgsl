// What removal criteria compare with their limits. LIMITS is generated.
@group(0) @binding(0) var<uniform> limits: array<vec4<f32>, LIMITS>;
@group(0) @binding(1) var<storage, read> criteria: array<u32>; // bit i: criterion i watches the element

// Eliminates the entry between two axes of a symmetric matrix: (app, aqq, apq) become eigenvalues of that 2×2 block.
// Returns (t, c, s) of the rotation, t its tangent.
fn rotation(app: f32, aqq: f32, apq: f32) -> vec3<f32> {
    if abs(apq) <= 1e-12 * (abs(app) + abs(aqq)) || apq == 0.0 {
        return vec3<f32>(0.0, 1.0, 0.0);
    }
    let theta = (aqq - app) / (2.0 * apq);
    let t = select(-1.0, 1.0, theta >= 0.0) / (abs(theta) + sqrt(theta * theta + 1.0));
    let c = 1.0 / sqrt(t * t + 1.0);
    return vec3<f32>(t, c, t * c);
}

// The largest principal stretch, by Jacobi rotations: the formula with an arc cosine loses half the digits.
fn largest_stretch(strain: Sym3) -> f32 {
    var d = strain.diagonal;
    var o = strain.others; // xy, yz, xz
    for (var sweep = 0u; sweep < 5u; sweep++) {
        let a = rotation(d.x, d.y, o.x);
        d = vec3<f32>(d.x - a.x * o.x, d.y + a.x * o.x, d.z);
        o = vec3<f32>(0.0, a.z * o.z + a.y * o.y, a.y * o.z - a.z * o.y);
        let b = rotation(d.y, d.z, o.y);
        d = vec3<f32>(d.x, d.y - b.x * o.y, d.z + b.x * o.y);
        o = vec3<f32>(b.y * o.x - b.z * o.z, 0.0, b.z * o.x + b.y * o.z);
        let c = rotation(d.x, d.z, o.z);
        d = vec3<f32>(d.x - c.x * o.z, d.y, d.z + c.x * o.z);
        o = vec3<f32>(c.y * o.x - c.z * o.y, c.z * o.x + c.y * o.y, 0.0);
    }
    return sqrt(max(0.0, 1.0 + 2.0 * max(d.x, max(d.y, d.z))));
}
