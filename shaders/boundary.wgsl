// Where prescribed nodes go, u = A·(X − center) + b; twin of systems/boundary.rs. compensation_of is in
// compensation.wgsl, or generated where sums are not compensated; keep_previous_step in
// previous_prescribed_increment.wgsl, or generated where nothing is counted.
// axes: bits 0, 1, 2 for x, y, z; signal: first of three slots, rows of A, with b's component; arms: X − center (m).
fn boundary(i: u32, node: u32) {
    let arm = vec4<f32>(arms[3u * i], arms[3u * i + 1u], arms[3u * i + 2u], 1.0);
    for (var axis = 0u; axis < 3u; axis++) {
        if ((parameters.axes >> axis) & 1u) == 1u {
            let at = 3u * node + axis;
            let goal = dot(step.signals[parameters.signal + axis], arm);
            keep_previous_step(at);
            displacement_increment[at] = (goal - displacement[at]) + compensation_of(node, axis);
        }
    }
}
