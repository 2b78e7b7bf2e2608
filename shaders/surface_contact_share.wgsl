// What acts on a node, by which its mass is split among its contacts, a thread a node; twin of src/contact/law/acting.rs.
// After surface_contact.wgsl and surface_contact_edges.wgsl, before surface_contact_impulse.wgsl. Motion of the next step
// begins here.
@group(0) @binding(0) var<storage, read_write> surface_shares: array<f32>;

// Of the sum over contacts of a node: xx, yy, zz, then xy, yz, zx.
alias Sum = mat2x3<f32>;

fn collect(contact: u32, weight: f32) -> Sum {
    let normal = vector(contact, NORMAL);
    let weighed = abs(weight) * normal;
    return Sum(weighed * normal, weighed * normal.yzx);
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
    let acting = collect_all(node);
    let at = SHARE_NUMBERS * node;
    surface_shares[at] = acting[0].x;
    surface_shares[at + 1u] = acting[0].y;
    surface_shares[at + 2u] = acting[0].z;
    surface_shares[at + 3u] = acting[1].x;
    surface_shares[at + 4u] = acting[1].y;
    surface_shares[at + 5u] = acting[1].z;
}
