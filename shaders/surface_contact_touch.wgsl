// Notes what contacts between surfaces came to, a thread a point: slip, gap, length slid and what is lost.
@group(0) @binding(0) var<storage, read> surface_nodes: array<f32>;
@group(0) @binding(0) var<storage, read> surface_rows: array<u32>;
@group(0) @binding(0) var<storage, read_write> surface_touch: array<f32>;

fn collect(contact: u32, weight: f32) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn at_node(node: u32, number: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + number;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

// A point's step against its face: of so many numbers of nodes on.
fn relative(contact: u32, of_nodes: u32) -> vec3<f32> {
    let triangle = 8u * surface_contacts[CONTACT_WORDS * contact + TRIANGLE];
    let weights = vector(contact, WEIGHTS);
    return at_node(contact / 2u, of_nodes) - weights.x * at_node(surface_faces[triangle], of_nodes)
        - weights.y * at_node(surface_faces[triangle + 1u], of_nodes)
        - weights.z * at_node(surface_faces[triangle + 2u], of_nodes);
}

@compute @workgroup_size(64)
fn surface_contact_touch(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= surface.count {
        return;
    }
    let node = surface.first + i;
    let at = TOUCH_NUMBERS * surface_rows[4u * node];
    for (var slot = 0u; slot < 2u; slot++) {
        let contact = 2u * node + slot;
        if !is_active(contact) || !(number(contact, PRESSING) > 0.0) {
            continue;
        }
        let pressing = number(contact, PRESSING);
        let slides = surface_contacts[CONTACT_WORDS * contact + SLIDING] == 1u;
        let normal = vector(contact, NORMAL);
        let after = relative(contact, 3u);
        let tangential = after - normal * dot(after, normal);
        if slot == 0u {
            let total = vector(contact, SLIP) + after;
            var slip = total - normal * dot(total, normal);
            let bound = number(contact, FRICTION) * pressing * number(contact, YIELDS_ALONG);
            let size = length(slip);
            slip = select(slip, slip * (bound / max(size, 1e-37)), size > bound);
            surface_touch[at] = slip.x;
            surface_touch[at + 1u] = slip.y;
            surface_touch[at + 2u] = slip.z;
            surface_touch[at + 4u] = select(STICKS, SLIDES, slides);
            surface_touch[at + 5u] = number(contact, OUTSIDE) + dot(normal, after);
        }
        if surface.relaxed == 0u {
            let force = pressing * normal + vector(contact, RUBBING);
            if slides {
                surface_touch[at + 6u] += length(tangential);
            }
            surface_touch[at + 7u] -= step.work_factor * dot(force, 0.5 * (relative(contact, 6u) + after));
        }
    }
}
