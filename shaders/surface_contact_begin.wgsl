// How contacts begin that points of surfaces and edges are in, in a step; in surface_contact.wgsl and
// surface_contact_edges.wgsl.
@group(0) @binding(0) var<storage, read> surface_nodes: array<f32>;

// Nodes that a contact acts on, with signed weights: positive of the point's, negative of the face's.
struct Parts {
    nodes: array<u32, PARTS>,
    weights: array<f32, PARTS>,
}

struct Begun {
    normal: vec3<f32>,
    gap: f32, // what the kinematic law closes (m)
    outside: f32, // how far it is outside (m)
    allowed: f32, // how deep it may be inside (m)
    within: f32, // nearer than this it ends, or is nothing to keep (m)
    friction: f32,
    slip: vec3<f32>,
}

fn meeting(point: u32, face: u32) -> u32 {
    return surface.meetings + MEETING_WORDS * (point * surface.bodies + face);
}

// Of the words of two bodies that meet.
fn meeting_number(meets: u32, word: u32) -> f32 {
    return bitcast<f32>(surface_faces[meets + word]);
}

fn goes(parts: Parts, of_nodes: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var part = 0u; part < PARTS; part++) {
        if parts.weights[part] != 0.0 {
            let at = NODE_NUMBERS * parts.nodes[part] + of_nodes;
            sum += parts.weights[part] * vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
        }
    }
    return sum;
}

// How far faces and edges of two bodies are looked at when the fastest node goes so far in a step (m).
fn reach_of(meets: u32, largest: f32) -> f32 {
    return 4.0 * largest + meeting_number(meets, MARGIN) + meeting_number(meets, 3u);
}

// How far points that are inside and may be come out in this step (m).
fn settling_of_step(meets: u32) -> f32 {
    if surface.relaxed != 0u {
        return FAR;
    }
    let speed = meeting_number(meets, SETTLING);
    let settling = speed * step.time_step;
    return select(settling, 0.01 * settling, step.time * speed >= 0.5 * meeting_number(meets, EDGE));
}

fn begin_none(contact: u32) {
    surface_contacts[CONTACT_WORDS * contact + ACTIVE] = 0u;
}

// Whether the point would end inside; where a spring keeps it out, whether it is.
fn meets_it(meets: u32, parts: Parts, begun: Begun) -> bool {
    if meeting_number(meets, 4u) > 0.0 {
        return begun.outside - begun.allowed < begun.within;
    }
    return begun.gap + dot(begun.normal, goes(parts, NEXT)) < begun.within;
}

// Notes the contact of a point that meets something.
fn begin(contact: u32, meets: u32, parts: Parts, begun: Begun) {
    let share = meeting_number(meets, 4u);
    var gap = begun.gap;
    var acts = BY_STEP;
    if share > 0.0 {
        let outside = begun.outside - begun.allowed;
        let outwards = dot(begun.normal, goes(parts, LAST));
        gap = step.work_factor * spring_gap(share, meeting_number(meets, 5u), outside, outwards);
        acts = BY_SPRING;
    }
    set_vector(contact, NORMAL, begun.normal);
    set_number(contact, GAP, gap);
    set_number(contact, FRICTION, begun.friction);
    set_vector(contact, SLIP, begun.slip);
    set_number(contact, PRESSING, 0.0);
    set_vector(contact, RUBBING, vec3<f32>(0.0));
    let at = CONTACT_WORDS * contact;
    surface_contacts[at + SLIDING] = 1u; // what nothing holds
    for (var part = 0u; part < PARTS; part++) {
        surface_contacts[at + PART + part] = parts.nodes[part];
        surface_contacts[at + PART + PARTS + part] = bitcast<u32>(parts.weights[part]);
    }
    surface_contacts[at + ACTIVE] = acts;
}
