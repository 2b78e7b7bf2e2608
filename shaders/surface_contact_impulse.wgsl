// The normal forces of contacts between surfaces, a thread a contact; twin of src/contact/law.rs. After
// surface_contact_share.wgsl; surface_contact_apply.wgsl gives them to nodes.

@compute @workgroup_size(64)
fn surface_contact_impulse(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let contact = row(id, groups);
    if contact >= surface.contacts || !is_active(contact) {
        return;
    }
    let normal = vector(contact, NORMAL);
    var yields = 0.0;
    var along = 0.0;
    for (var part = 0u; part < PARTS; part++) {
        let weight = part_weight(contact, part);
        if weight == 0.0 {
            continue;
        }
        let node = part_node(contact, part);
        let share = abs(weight) * surface_nodes[NODE_NUMBERS * node + SHARE];
        let response = at_node(node, RESPONSE);
        yields += share * dot(normal, response * normal);
        along += share * max(response.x, max(response.y, response.z));
    }
    let before = number(contact, PRESSING);
    let springs = surface_contacts[CONTACT_WORDS * contact + ACTIVE] == BY_SPRING;
    var pressing = 0.0;
    if yields > 0.0 {
        let gap = number(contact, GAP) + select(dot(normal, relative(contact, NEXT)), 0.0, springs);
        pressing = max(select(before, 0.0, springs) - gap / yields, 0.0);
    }
    set_number(contact, YIELDS, yields);
    set_number(contact, YIELDS_ALONG, along);
    set_number(contact, PRESSING, pressing);
    set_vector(contact, CHANGE, (pressing - before) * normal);
}
