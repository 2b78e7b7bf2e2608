// Adds the forces of ties to the loads of a body, a thread a node, in a fixed order. note_farther is in
// contact_farther.wgsl or generated.
@group(0) @binding(0) var<storage, read> glue_nodes: array<f32>;
@group(0) @binding(0) var<storage, read> glue_rows: array<u32>;
@group(0) @binding(0) var<storage, read_write> external_force: array<f32>;

@compute @workgroup_size(64)
fn glue_push(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= glue_of.node_count {
        return;
    }
    let node = glue_of.first_node + i;
    let force = sum_of_ties(node, FORCE);
    let at = 3u * glue_rows[4u * node];
    for (var k = 0u; k < 3u; k++) {
        external_force[at + k] += force[k];
    }
    if glue_of.relaxed == 0u {
        let response = NODE_NUMBERS * node + RESPONSE;
        let yields = vec3<f32>(glue_nodes[response], glue_nodes[response + 1u], glue_nodes[response + 2u]);
        note_farther(glue_rows[4u * node], yields * force);
    }
}
