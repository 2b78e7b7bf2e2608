// Into how many shares the mass of a node is split among its ties, a thread a node.
@group(0) @binding(0) var<storage, read> glue_found: array<f32>;
@group(0) @binding(0) var<storage, read_write> glue_shares: array<f32>;

@compute @workgroup_size(64)
fn glue_share(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= glue_of.nodes {
        return;
    }
    let of_node = ties_of(node);
    var shares = 0.0;
    for (var number = of_node.x; number < of_node.y; number++) {
        let tie = tie_of_node(number);
        shares += abs(tie.weight) * glue_found[FOUND_NUMBERS * tie.index + ACTIVE];
    }
    glue_shares[node] = shares;
}
