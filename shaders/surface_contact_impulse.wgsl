// The normal forces of contacts between surfaces, a thread a contact; twin of src/contact/law.rs. After
// surface_contact_share.wgsl; surface_contact_apply.wgsl gives them to nodes.
@group(0) @binding(0) var<storage, read> surface_shares: array<f32>;

// Lets a point that is inside come out no harder than the spring would that the contact has been so far; in the first
// sweep.
fn limit(contact: u32, step_outwards: f32, yields: f32, alone: f32) {
    let stiffness = number(contact, STIFFNESS);
    let gap = number(contact, GAP);
    if stiffness >= UNASKED || !(gap < 0.0) {
        return;
    }
    let force = stiffness * (-gap - step_outwards) / (1.0 + stiffness * number(contact, BESIDE) * alone);
    let out = max(max(yields * force + step_outwards, number(contact, LETS_OUT)), 0.0);
    set_number(contact, GAP, max(gap, -out));
    // no limit to later sweeps
    set_number(contact, STIFFNESS, UNASKED);
}

@compute @workgroup_size(64)
fn surface_contact_impulse(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let contact = row(id, groups);
    if contact >= surface.contacts || !is_active(contact) {
        return;
    }
    let normal = vector(contact, NORMAL);
    var yields = 0.0;
    var along = 0.0;
    var alone = 0.0;
    for (var part = 0u; part < PARTS; part++) {
        let weight = part_weight(contact, part);
        if weight == 0.0 {
            continue;
        }
        let node = part_node(contact, part);
        let share = abs(weight) * surface_shares[node];
        let response = at_node(node, RESPONSE);
        yields += share * dot(normal, response * normal);
        alone += weight * weight * dot(normal, response * normal);
        along += share * max(response.x, max(response.y, response.z));
    }
    let before = number(contact, PRESSING);
    let springs = surface_contacts[CONTACT_WORDS * contact + ACTIVE] == BY_SPRING;
    var pressing = 0.0;
    if !springs {
        limit(contact, dot(normal, relative(contact, NEXT)), yields, alone);
    }
    if yields > 0.0 {
        let gap = number(contact, GAP) + select(dot(normal, relative(contact, NEXT)), 0.0, springs);
        pressing = max(select(before, 0.0, springs) - gap / yields, 0.0);
    }
    set_number(contact, YIELDS, yields);
    set_number(contact, YIELDS_ALONG, along);
    set_number(contact, PRESSING, pressing);
    set_vector(contact, CHANGE, (pressing - before) * normal);
}
