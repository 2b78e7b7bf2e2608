// Adds the forces of contacts between surfaces to the loads of a body, and counts what they take of its energy, a
// thread a node, in a fixed order. MET is generated.
@group(0) @binding(0) var<storage, read> surface_rows: array<u32>;
@group(0) @binding(0) var<storage, read_write> external_force: array<f32>;
@group(0) @binding(0) var<storage, read_write> contact_force: array<f32>;
@group(0) @binding(0) var<storage, read_write> surface_touch: array<f32>;

// Of the sum over contacts of a node: the force on it (N).
fn collect(contact: u32, weight: f32) -> vec3<f32> {
    let pressing = number(contact, PRESSING);
    if !(pressing > 0.0) {
        return vec3<f32>(0.0);
    }
    return weight * (pressing * vector(contact, NORMAL) + vector(contact, RUBBING));
}

@compute @workgroup_size(64)
fn surface_contact_push(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= surface.count {
        return;
    }
    let node = surface.first + i;
    let force = collect_all(node);
    let of_body = surface_rows[4u * node];
    let at = 3u * of_body;
    contact_force[at] = force.x;
    contact_force[at + 1u] = force.y;
    contact_force[at + 2u] = force.z;
    external_force[at] += force.x;
    external_force[at + 1u] += force.y;
    external_force[at + 2u] += force.z;
    let presses = any(force != vec3<f32>(0.0));
    surface_touch[MET * of_body + 8u] = select(0.0, surface_nodes[NODE_NUMBERS * node + SHARE], presses);
    if surface.relaxed == 0u && presses {
        let mean = 0.5 * (at_node(node, WENT) + at_node(node, NEXT));
        surface_touch[MET * of_body + 7u] -= step.work_factor * dot(force, mean);
    }
}
