// Gives what has changed of contacts' forces to the steps of nodes, a thread a node, in a fixed order.
@group(0) @binding(0) var<storage, read_write> surface_nodes: array<f32>;

// Of the sum over contacts of a node: the force on it (N).
fn collect(contact: u32, weight: f32) -> vec3<f32> {
    return weight * vector(contact, CHANGE);
}

@compute @workgroup_size(64)
fn surface_contact_apply(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= surface.nodes {
        return;
    }
    let force = collect_all(node);
    let at = NODE_NUMBERS * node;
    surface_nodes[at + NEXT] += surface_nodes[at + RESPONSE] * force.x;
    surface_nodes[at + NEXT + 1u] += surface_nodes[at + RESPONSE + 1u] * force.y;
    surface_nodes[at + NEXT + 2u] += surface_nodes[at + RESPONSE + 2u] * force.z;
}
