// Compensated sums (Kahan 1965), for integrate: what rounding leaves out of a displacement or of its step goes into the
// next. What displacements have too much of, a vector a node, then what steps have.
@group(0) @binding(0) var<storage, read_write> displacement_compensation: array<f32>;

// The same number, in a way that no compiler can look through: else (u + d) − u becomes d, and nothing is compensated.
fn rounded(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) ^ vec3<u32>(step.zero));
}

// Where what a step has too much of stands.
fn of_step(node: u32) -> u32 {
    return 3u * (pass_rows.count + node);
}

fn compensation_at(at: u32) -> vec3<f32> {
    return vec3<f32>(
        displacement_compensation[at],
        displacement_compensation[at + 1u],
        displacement_compensation[at + 2u],
    );
}

fn compensated_add(at: u32, sum: vec3<f32>, change: vec3<f32>) -> vec3<f32> {
    let exact = rounded(rounded(change) - compensation_at(at));
    let after = rounded(sum + exact);
    let left_out = rounded(after - sum) - exact;
    displacement_compensation[at] = left_out.x;
    displacement_compensation[at + 1u] = left_out.y;
    displacement_compensation[at + 2u] = left_out.z;
    return after;
}

// The longer step.
fn add_to_step(node: u32, before: vec3<f32>, change: vec3<f32>) -> vec3<f32> {
    return compensated_add(of_step(node), before, change);
}

// An inactive node has no step, and nothing of it is left out.
fn forget_step(node: u32) {
    displacement_compensation[of_step(node)] = 0.0;
    displacement_compensation[of_step(node) + 1u] = 0.0;
    displacement_compensation[of_step(node) + 2u] = 0.0;
}

// The displacement after the step; what boundary wrote is the whole of a constrained one.
fn add_step(node: u32, u: vec3<f32>, d: vec3<f32>, constrained: vec3<bool>) -> vec3<f32> {
    let compensation = select(compensation_at(of_step(node)), vec3<f32>(0.0), constrained);
    return compensated_add(3u * node, u, d - compensation);
}
