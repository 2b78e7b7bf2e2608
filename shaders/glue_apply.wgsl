// Gives what has changed of ties' forces to the steps of nodes, a thread a node, in a fixed order.
@group(0) @binding(0) var<storage, read_write> glue_nodes: array<f32>;

@compute @workgroup_size(64)
fn glue_apply(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= glue_of.nodes {
        return;
    }
    let force = sum_of_ties(node, CHANGE);
    let at = NODE_NUMBERS * node;
    for (var k = 0u; k < 3u; k++) {
        glue_nodes[at + NEXT + k] += glue_nodes[at + RESPONSE + k] * force[k];
    }
}
