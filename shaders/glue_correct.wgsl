// The forces of ties, a thread a tie; twin of src/contact/ties.rs. After glue_share.wgsl; glue_apply.wgsl gives them to
// nodes.
@group(0) @binding(0) var<storage, read> glue_nodes: array<f32>;
@group(0) @binding(0) var<storage, read> glue_shares: array<f32>;
@group(0) @binding(0) var<storage, read_write> glue_found: array<f32>;

@compute @workgroup_size(64)
fn glue_correct(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let tie = row(id, groups);
    if tie >= glue_of.ties {
        return;
    }
    let at = FOUND_NUMBERS * tie;
    if glue_found[at + ACTIVE] == 0.0 {
        return;
    }
    var left = vec3<f32>(glue_found[at + OFF], glue_found[at + OFF + 1u], glue_found[at + OFF + 2u]);
    var yields = 0.0;
    for (var number = tie_word(tie, PART); number < tie_word(tie, PART + 1u); number++) {
        let of_tie = part(number);
        let node = NODE_NUMBERS * of_tie.index;
        let next = node + NEXT;
        left += of_tie.weight * vec3<f32>(glue_nodes[next], glue_nodes[next + 1u], glue_nodes[next + 2u]);
        let free = node + RESPONSE;
        let response = max(glue_nodes[free], max(glue_nodes[free + 1u], glue_nodes[free + 2u]));
        yields += abs(of_tie.weight) * glue_shares[of_tie.index] * response;
    }
    var change = vec3<f32>(0.0);
    if yields > 0.0 {
        change = left * (-1.0 / yields);
    }
    for (var k = 0u; k < 3u; k++) {
        glue_found[at + CHANGE + k] = change[k];
        glue_found[at + FORCE + k] += change[k];
    }
}
