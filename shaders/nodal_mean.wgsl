// The second half of nodal_volume: sums around each node in a fixed order. place and LANES are as in block.wgsl.
struct Nodes {
    count: u32,
}
@group(0) @binding(0) var<uniform> nodes: Nodes;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> elements: array<u32>;
@group(0) @binding(3) var<storage, read> element_volume: array<f32>;
@group(0) @binding(4) var<storage, read_write> nodal_volume_change: array<f32>;

@compute @workgroup_size(64)
fn nodal_means(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= nodes.count {
        return;
    }
    var volume = 0.0;
    var change = 0.0;
    for (var i = starts[node]; i < starts[node + 1u]; i++) {
        let at = elements[i] / LANES * 2u * LANES + elements[i] % LANES;
        volume += element_volume[at];
        change += element_volume[at + LANES];
    }
    // a node all of whose elements are gone or of another block has no volume
    nodal_volume_change[node] = select(0.0, change / volume, volume > 0.0);
}
