// The normal forces of contacts between surfaces, a thread a contact; twin of src/contact/law.rs. After
// surface_contact.wgsl; surface_contact_apply.wgsl gives them to nodes.
@group(0) @binding(0) var<storage, read> surface_nodes: array<f32>;

// Of the sum over contacts of a node: into how many shares its mass is split.
fn collect(contact: u32, weight: f32) -> vec3<f32> {
    return vec3<f32>(abs(weight));
}

fn at_node(node: u32, number: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + number;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

@compute @workgroup_size(64)
fn surface_contact_impulse(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let contact = row(id, groups);
    if contact >= 2u * surface.nodes || !is_active(contact) {
        return;
    }
    let triangle = 8u * surface_contacts[CONTACT_WORDS * contact + TRIANGLE];
    let normal = vector(contact, NORMAL);
    var relative = vec3<f32>(0.0);
    var yields = 0.0;
    var along = 0.0;
    for (var k = 0u; k < 4u; k++) {
        var node = contact / 2u;
        var weight = 1.0;
        if k > 0u {
            node = surface_faces[triangle + k - 1u];
            weight = -number(contact, WEIGHTS + k - 1u);
        }
        if weight == 0.0 {
            continue;
        }
        let share = abs(weight) * collect_all(node).x;
        let response = at_node(node, 9u);
        yields += share * dot(normal, response * normal);
        along += share * max(response.x, max(response.y, response.z));
        relative += weight * at_node(node, 3u);
    }
    let before = number(contact, PRESSING);
    let springs = surface_contacts[CONTACT_WORDS * contact + ACTIVE] == BY_SPRING;
    var pressing = 0.0;
    if yields > 0.0 {
        let gap = number(contact, GAP) + select(dot(normal, relative), 0.0, springs);
        pressing = max(select(before, 0.0, springs) - gap / yields, 0.0);
    }
    set_number(contact, YIELDS, yields);
    set_number(contact, YIELDS_ALONG, along);
    set_number(contact, PRESSING, pressing);
    set_vector(contact, CHANGE, (pressing - before) * normal);
}
