// Gives what has changed of ties' forces to the steps of nodes, a thread a node, in a fixed order.
@group(0) @binding(0) var<storage, read> glue_found: array<f32>;
@group(0) @binding(0) var<storage, read_write> glue_nodes: array<f32>;

@compute @workgroup_size(64)
fn glue_apply(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= glue_of.nodes {
        return;
    }
    let of_node = ties_of(node);
    var force = vec3<f32>(0.0);
    for (var number = of_node.x; number < of_node.y; number++) {
        let tie = tie_of_node(number);
        let at = FOUND_NUMBERS * tie.index;
        if glue_found[at + ACTIVE] != 0.0 {
            let change = at + CHANGE;
            force += tie.weight * vec3<f32>(glue_found[change], glue_found[change + 1u], glue_found[change + 2u]);
        }
    }
    let at = NODE_NUMBERS * node;
    for (var k = 0u; k < 3u; k++) {
        glue_nodes[at + NEXT + k] += glue_nodes[at + RESPONSE + k] * force[k];
    }
}
