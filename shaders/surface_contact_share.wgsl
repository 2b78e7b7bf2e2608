// Into how many shares the mass of a node is split among its contacts, and among those that it had, a thread a node;
// twin of src/contact/law.rs, after surface_contact.wgsl and surface_contact_edges.wgsl, before
// surface_contact_impulse.wgsl. Motion of the next step begins here.
@group(0) @binding(0) var<storage, read_write> surface_nodes: array<f32>;

const KEEPS: f32 = 2.0 / 3.0;

fn collect(contact: u32, weight: f32) -> vec3<f32> {
    return vec3<f32>(abs(weight));
}

@compute @workgroup_size(64)
fn surface_contact_share(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= surface.nodes {
        return;
    }
    if node == 0u {
        // nobody asks for these in this step any more
        let turn = 1u - (step.number & 1u);
        atomicStore(&surface_motion[turn], 0u);
        atomicStore(&surface_motion[2u + turn], 0u);
        if !lists_hold() {
            atomicAdd(&surface_motion[4], 1u);
        }
    }
    let now = collect_all(node).x;
    let at = NODE_NUMBERS * node + SHARE;
    // what touches nothing has none
    surface_nodes[at] = now + select(0.0, KEEPS * max(surface_nodes[at] - now, 0.0), now > 0.0);
}
