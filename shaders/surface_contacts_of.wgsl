// Goes through the contacts that act on a node, in a fixed order: those of the point that it is, then those with
// triangles that it is a corner of, by points ascending. collect is of who asks.
@group(0) @binding(0) var<storage, read_write> surface_contacts: array<u32>;

fn number(contact: u32, word: u32) -> f32 {
    return bitcast<f32>(surface_contacts[CONTACT_WORDS * contact + word]);
}

fn vector(contact: u32, word: u32) -> vec3<f32> {
    let at = CONTACT_WORDS * contact + word;
    return bitcast<vec3<f32>>(vec3<u32>(surface_contacts[at], surface_contacts[at + 1u], surface_contacts[at + 2u]));
}

fn set_number(contact: u32, word: u32, value: f32) {
    surface_contacts[CONTACT_WORDS * contact + word] = bitcast<u32>(value);
}

fn set_vector(contact: u32, word: u32, value: vec3<f32>) {
    let at = CONTACT_WORDS * contact + word;
    let bits = bitcast<vec3<u32>>(value);
    surface_contacts[at] = bits.x;
    surface_contacts[at + 1u] = bits.y;
    surface_contacts[at + 2u] = bits.z;
}

fn is_active(contact: u32) -> bool {
    return surface_contacts[CONTACT_WORDS * contact + ACTIVE] != 0u;
}

// The weight of a node as a corner of a contact's triangle.
fn weight_in(contact: u32, node: u32) -> f32 {
    let triangle = surface_contacts[CONTACT_WORDS * contact + TRIANGLE];
    for (var corner = 0u; corner < 3u; corner++) {
        if surface_faces[8u * triangle + corner] == node {
            return number(contact, WEIGHTS + corner);
        }
    }
    return 0.0;
}

// The sum over contacts of a node.
fn collect_all(node: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var slot = 0u; slot < 2u; slot++) {
        let contact = 2u * node + slot;
        if is_active(contact) {
            sum += collect(contact, 1.0);
        }
    }
    let hold = lists_hold();
    let starts = surface.inverse + node;
    let begin = select(0u, surface_lists[starts], hold);
    let end = select(surface.nodes, surface_lists[starts + 1u], hold);
    let points = surface.inverse + surface.nodes + 1u;
    for (var place = begin; place < end; place++) {
        var point = place;
        if hold {
            point = surface_lists[points + place];
        }
        for (var slot = 0u; slot < 2u; slot++) {
            let contact = 2u * point + slot;
            if is_active(contact) {
                let weight = weight_in(contact, node);
                if weight != 0.0 {
                    sum += collect(contact, -weight);
                }
            }
        }
    }
    return sum;
}
