// The compensated sum, for integrate: what rounding leaves out of a step goes into the next one.
@group(0) @binding(0) var<storage, read_write> displacement_compensation: array<f32>;

// The same number, in a way that no compiler can look through: else (u + d) − u becomes d, and nothing is compensated.
fn rounded(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) ^ vec3<u32>(step.zero));
}

fn add(at: u32, u: vec3<f32>, d: vec3<f32>) -> vec3<f32> {
    let lost = vec3<f32>(
        displacement_compensation[at],
        displacement_compensation[at + 1u],
        displacement_compensation[at + 2u],
    );
    let exact = rounded(rounded(d) - lost);
    let sum = rounded(u + exact);
    let left_out = rounded(sum - u) - exact;
    displacement_compensation[at] = left_out.x;
    displacement_compensation[at + 1u] = left_out.y;
    displacement_compensation[at + 2u] = left_out.z;
    return sum;
}
