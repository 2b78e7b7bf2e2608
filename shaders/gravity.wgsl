// Mass times acceleration on every node; twin of systems/gravity.rs.
struct GravityLoad {
    count: u32, // nodes
    signal: u32, // slot of the acceleration (m/s²)
}
@group(0) @binding(0) var<uniform> load: GravityLoad;
@group(0) @binding(1) var<storage, read> mass: array<f32>;

@compute @workgroup_size(64)
fn gravity(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node < load.count {
        add_load(node, mass[node] * step.signals[load.signal].xyz);
    }
}
