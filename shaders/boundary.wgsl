// Where prescribed nodes go, u = A·(X − center) + b; twin of systems/boundary.rs. compensation_of is in
// compensation.wgsl, or generated where sums are not compensated; keep_previous_step in
// previous_prescribed_increment.wgsl, or generated where nothing is counted.
struct Motion {
    axes: u32, // bits 0, 1, 2: x, y, z
    signal: u32, // first of three slots: rows of A, with b's component
}
@group(0) @binding(0) var<uniform> motion: Motion;
@group(0) @binding(1) var<storage, read> arms: array<f32>; // X − center (m)
@group(0) @binding(2) var<storage, read> displacement: array<f32>;
@group(0) @binding(3) var<storage, read_write> displacement_increment: array<f32>;

fn boundary(i: u32, node: u32) {
    let arm = vec4<f32>(arms[3u * i], arms[3u * i + 1u], arms[3u * i + 2u], 1.0);
    for (var axis = 0u; axis < 3u; axis++) {
        if ((motion.axes >> axis) & 1u) == 1u {
            let at = 3u * node + axis;
            let goal = dot(step.signals[motion.signal + axis], arm);
            keep_previous_step(at);
            displacement_increment[at] = (goal - displacement[at]) + compensation_of(node, axis);
        }
    }
}
