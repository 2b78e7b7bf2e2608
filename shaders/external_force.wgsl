// Loads, for integrate.
@group(0) @binding(0) var<storage, read> external_force: array<f32>;

fn external_force_of(node: u32) -> vec3<f32> {
    return vec3<f32>(external_force[3u * node], external_force[3u * node + 1u], external_force[3u * node + 2u]);
}
