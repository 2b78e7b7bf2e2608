// Into how many shares the mass of a node is split among its contacts, a thread a node; after surface_contact.wgsl and
// surface_contact_edges.wgsl, before surface_contact_impulse.wgsl. Motion of the next step begins here.
@group(0) @binding(0) var<storage, read_write> surface_shares: array<f32>;

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
    surface_shares[node] = collect_all(node).x;
}
