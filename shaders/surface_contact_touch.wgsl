// Notes what contacts between surfaces came to, a thread a point: slip and length slid. touch_of is generated;
// note_edges is in surface_touch_edges.wgsl, or generated.
@group(0) @binding(0) var<storage, read_write> surface_touch: array<f32>;

// Of two walls slip is kept of the first that a point touches, for along both it has slipped alike.
fn note(contact: u32, at: u32, of_point: bool) {
    let pressing = number(contact, PRESSING);
    if !is_active(contact) || !(pressing > 0.0) {
        return;
    }
    let slides = surface_contacts[CONTACT_WORDS * contact + SLIDING] == 1u;
    let normal = vector(contact, NORMAL);
    let after = relative(contact, NEXT);
    let did = surface_touch[at + 4u];
    let in_corner = select(0.0, IN_CORNER, did >= IN_CORNER);
    if of_point && did - in_corner < STICKS {
        var slip = along_surface(vector(contact, SLIP) + after, normal);
        let bound = number(contact, FRICTION) * pressing * number(contact, YIELDS_ALONG);
        let size = length(slip);
        slip = select(slip, slip * (bound / max(size, 1e-37)), size > bound);
        surface_touch[at] = slip.x;
        surface_touch[at + 1u] = slip.y;
        surface_touch[at + 2u] = slip.z;
        surface_touch[at + 4u] = in_corner + select(STICKS, SLIDES, slides);
    }
    if surface.relaxed == 0u && slides {
        surface_touch[at + 6u] += length(along_surface(after, normal));
    }
}

@compute @workgroup_size(64)
fn surface_contact_touch(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= surface.count {
        return;
    }
    let point = surface.first + i;
    let at = touch_of(point);
    note(2u * point, at, true);
    note(2u * point + 1u, at, true);
    note_edges(point, at);
}
