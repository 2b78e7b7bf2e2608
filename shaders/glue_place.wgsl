// Where tied nodes of a body are, and how far they last went: before surface_contact_foresee.wgsl and glue.wgsl.
@group(0) @binding(0) var<storage, read> glue_rows: array<u32>; // four a node, of which the first is its row
@group(0) @binding(0) var<storage, read> displacement: array<f32>;
@group(0) @binding(0) var<storage, read> displacement_increment: array<f32>;
@group(0) @binding(0) var<storage, read_write> glue_nodes: array<f32>;

@compute @workgroup_size(64)
fn glue_place(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= glue_of.node_count {
        return;
    }
    let node = glue_of.first_node + i;
    let at = 3u * glue_rows[4u * node];
    let to = NODE_NUMBERS * node;
    for (var k = 0u; k < 3u; k++) {
        glue_nodes[to + k] = displacement[at + k];
        glue_nodes[to + LAST + k] = displacement_increment[at + k];
    }
}
