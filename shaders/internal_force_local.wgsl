// Forces of deformed elements at the nodes (N), in a kernel that sums them and uses them: they go to memory in those
// steps only after which somebody may look.
@group(0) @binding(0) var<storage, read_write> internal_force: array<f32>;
var<private> inner_force: vec3<f32>;

fn set_internal_force(node: u32, force: vec3<f32>) {
    inner_force = force;
    if step.observed != 0u {
        internal_force[3u * node] = force.x;
        internal_force[3u * node + 1u] = force.y;
        internal_force[3u * node + 2u] = force.z;
    }
}

fn internal_force_of(node: u32) -> vec3<f32> {
    return inner_force;
}
