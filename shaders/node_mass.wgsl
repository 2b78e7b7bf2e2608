// Lumped mass (kg) of the elements that are left, one block after the other. damp_node is in node_damping.wgsl and
// move_node in node_inertia.wgsl, or generated where nothing is damped or no mass is scaled.
struct NodeMass {
    count: u32, // nodes
    first: u32, // 1: the block is the body's first
    density: f32, // kg/m³
    rate: f32, // damping rate (1/s)
}
@group(0) @binding(0) var<uniform> part: NodeMass;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> volumes: array<u32>; // places of volumes in rest_shape
@group(0) @binding(3) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(4) var<storage, read_write> mass: array<f32>;
@group(0) @binding(5) var<storage, read> shares: array<f32>; // what share of the element's mass the node has

@compute @workgroup_size(64)
fn node_mass(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= part.count {
        return;
    }
    var volume = 0.0;
    for (var i = starts[node]; i < starts[node + 1u]; i++) {
        volume += shares[i] * rest_shape[volumes[i]];
    }
    let added = part.density * volume;
    mass[node] = select(mass[node], 0.0, part.first == 1u) + added;
    damp_node(node, part.rate * added);
    move_node(node, added);
}
