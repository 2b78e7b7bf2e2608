// Sums of loads at the nodes (N), between kernels.
@group(0) @binding(0) var<storage, read_write> external_force: array<f32>;

fn clear_loads(node: u32) {
    external_force[3u * node] = 0.0;
    external_force[3u * node + 1u] = 0.0;
    external_force[3u * node + 2u] = 0.0;
}

fn add_load(node: u32, force: vec3<f32>) {
    external_force[3u * node] += force.x;
    external_force[3u * node + 1u] += force.y;
    external_force[3u * node + 2u] += force.z;
}

fn external_force_of(node: u32) -> vec3<f32> {
    return vec3<f32>(external_force[3u * node], external_force[3u * node + 1u], external_force[3u * node + 2u]);
}
