// Lumped mass (kg) of the elements that are left, one block after the other. damp_node is in node_damping.wgsl, or generated
// where nothing is damped.
struct NodeMass {
    count: u32, // nodes
    first: u32, // 1: the block is the body's first
    share: f32, // density over nodes of an element (kg/m³)
    rate: f32, // damping rate (1/s)
}
@group(0) @binding(0) var<uniform> part: NodeMass;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> volumes: array<u32>; // places of volumes in rest_shape
@group(0) @binding(3) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(4) var<storage, read_write> mass: array<f32>;

@compute @workgroup_size(64)
fn node_mass(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= part.count {
        return;
    }
    var volume = 0.0;
    for (var i = starts[node]; i < starts[node + 1u]; i++) {
        volume += rest_shape[volumes[i]];
    }
    let added = part.share * volume;
    mass[node] = select(mass[node], 0.0, part.first == 1u) + added;
    damp_node(node, part.rate * added);
}
