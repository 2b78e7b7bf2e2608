// Sums element forces at the nodes in a fixed order; twin of systems/gather.rs. clear_loads is in loads.wgsl, or
// generated where there are none. STRIDE is generated.
struct Gather {
    count: u32, // nodes
}
@group(0) @binding(0) var<uniform> nodes: Gather;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> corners: array<u32>;
@group(0) @binding(3) var<storage, read> element_force: array<f32>;
@group(0) @binding(4) var<storage, read_write> internal_force: array<f32>;

@compute @workgroup_size(64)
fn gather(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= nodes.count {
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var i = starts[node]; i < starts[node + 1u]; i++) {
        let at = corners[i];
        sum += vec3<f32>(element_force[at], element_force[at + STRIDE], element_force[at + 2u * STRIDE]);
    }
    internal_force[3u * node] = sum.x;
    internal_force[3u * node + 1u] = sum.y;
    internal_force[3u * node + 2u] = sum.z;
    clear_loads(node);
}
