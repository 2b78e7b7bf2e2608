// Sums of loads at the nodes (N), in a kernel that clears, adds and uses them: they go to memory in those steps only
// after which somebody may look.
@group(0) @binding(0) var<storage, read_write> external_force: array<f32>;
var<private> outer_force: vec3<f32>;

fn clear_loads(node: u32) {
    outer_force = vec3<f32>(0.0);
}

fn add_load(node: u32, force: vec3<f32>) {
    outer_force += force;
}

fn external_force_of(node: u32) -> vec3<f32> {
    if step.observed != 0u {
        external_force[3u * node] = outer_force.x;
        external_force[3u * node + 1u] = outer_force.y;
        external_force[3u * node + 2u] = outer_force.z;
    }
    return outer_force;
}
