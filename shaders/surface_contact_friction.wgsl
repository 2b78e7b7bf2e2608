// The tangential forces of contacts between surfaces, a thread a contact; twin of src/contact/law.rs. After the normal
// ones, which surface_contact_apply.wgsl has given to nodes.
@compute @workgroup_size(64)
fn surface_contact_friction(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let contact = row(id, groups);
    if contact >= surface.contacts || !is_active(contact) {
        return;
    }
    let friction = number(contact, FRICTION);
    let yields = number(contact, YIELDS_ALONG);
    var change = vec3<f32>(0.0);
    if friction > 0.0 && yields > 0.0 {
        let normal = vector(contact, NORMAL);
        let before = vector(contact, RUBBING);
        let slip = along_surface(vector(contact, SLIP) + relative(contact, NEXT), normal);
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
