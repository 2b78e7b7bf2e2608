// Adds the forces of ties to the loads of a body, a thread a node, in a fixed order.
@group(0) @binding(0) var<storage, read> glue_rows: array<u32>;
@group(0) @binding(0) var<storage, read> glue_found: array<f32>;
@group(0) @binding(0) var<storage, read_write> external_force: array<f32>;

@compute @workgroup_size(64)
fn glue_push(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= glue_of.node_count {
        return;
    }
    let node = glue_of.first_node + i;
    let of_node = ties_of(node);
    var force = vec3<f32>(0.0);
    for (var number = of_node.x; number < of_node.y; number++) {
        let tie = tie_of_node(number);
        let at = FOUND_NUMBERS * tie.index;
        if glue_found[at + ACTIVE] != 0.0 {
            force += tie.weight * vec3<f32>(glue_found[at + FORCE], glue_found[at + FORCE + 1u], glue_found[at + FORCE + 2u]);
        }
    }
    let at = 3u * glue_rows[4u * node];
    for (var k = 0u; k < 3u; k++) {
        external_force[at + k] += force[k];
    }
}
