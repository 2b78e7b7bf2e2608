// The tangential forces of contacts between surfaces, a thread a contact; twin of src/contact/law.rs. After the normal
// ones, which surface_contact_apply.wgsl has given to nodes.
@group(0) @binding(0) var<storage, read> surface_nodes: array<f32>;

fn collect(contact: u32, weight: f32) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn next_step(node: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + 3u;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

fn along_surface(v: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return v - normal * dot(v, normal);
}

@compute @workgroup_size(64)
fn surface_contact_friction(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let contact = row(id, groups);
    if contact >= 2u * surface.nodes || !is_active(contact) {
        return;
    }
    let friction = number(contact, FRICTION);
    let yields = number(contact, YIELDS_ALONG);
    var change = vec3<f32>(0.0);
    if friction > 0.0 && yields > 0.0 {
        let triangle = 8u * surface_contacts[CONTACT_WORDS * contact + TRIANGLE];
        let weights = vector(contact, WEIGHTS);
        let relative = next_step(contact / 2u) - weights.x * next_step(surface_faces[triangle])
            - weights.y * next_step(surface_faces[triangle + 1u]) - weights.z * next_step(surface_faces[triangle + 2u]);
        let normal = vector(contact, NORMAL);
        let before = vector(contact, RUBBING);
        let slip = along_surface(vector(contact, SLIP) + relative, normal);
        let wanted = along_surface(before, normal) - slip / yields;
        let bound = friction * number(contact, PRESSING);
        let size = length(wanted);
        let rubbing = select(wanted, wanted * (bound / max(size, 1e-37)), size > bound);
        surface_contacts[CONTACT_WORDS * contact + SLIDING] = select(0u, 1u, size > bound);
        set_vector(contact, RUBBING, rubbing);
        change = rubbing - before;
    }
    set_vector(contact, CHANGE, change);
}
