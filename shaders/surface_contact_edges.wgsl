// Which edges of surfaces cross, and with what they would meet in this step, a thread an edge; twin of
// src/contact/edges.rs. After surface_contact.wgsl, before surface_contact_share.wgsl.
@group(0) @binding(0) var<storage, read> surface_rows: array<u32>; // four a node: its row, bits of its place at rest (m)

const PARALLEL: f32 = 1e-6;
const FALLS: f32 = 0.05;
const NEAR_AT_REST: f32 = 1.5;

fn edge_word(edge: u32, word: u32) -> u32 {
    return surface_faces[surface.edges + EDGE_WORDS * edge + word];
}

fn rest_of(node: u32) -> vec3<f32> {
    let at = 4u * node;
    return bitcast<vec3<f32>>(vec3<u32>(surface_rows[at + 1u], surface_rows[at + 2u], surface_rows[at + 3u]));
}

fn share_of(upper: f32, lower: f32) -> f32 {
    return select(0.0, clamp(upper / max(lower, 1e-37), 0.0, 1.0), lower > 0.0);
}

// How far two edges are apart at rest (m).
fn distance_at_rest(one: u32, other: u32) -> f32 {
    let p = rest_of(edge_word(one, 0u));
    let q = rest_of(edge_word(other, 0u));
    let along = rest_of(edge_word(one, 1u)) - p;
    let beside = rest_of(edge_word(other, 1u)) - q;
    let off = p - q;
    let aa = dot(along, along);
    let ab = dot(along, beside);
    let bb = dot(beside, beside);
    let size = aa * bb - ab * ab;
    let first = select(0.5, share_of(ab * dot(beside, off) - bb * dot(along, off), size), size > PARALLEL * aa * bb);
    let t = share_of(ab * first + dot(beside, off), bb);
    let s = share_of(ab * t - dot(along, off), aa);
    return length(off + along * s - beside * t);
}

// Whether two edges may cross at all: where lists do not hold, that is not known from them.
fn may_cross(one: u32, other: u32, meets: u32) -> bool {
    if (surface_faces[meets] & EDGES_MEET) == 0u {
        return false;
    }
    if edge_word(one, 6u) != edge_word(other, 6u) {
        return true;
    }
    for (var end = 0u; end < 2u; end++) {
        if edge_word(one, end) == edge_word(other, 0u) || edge_word(one, end) == edge_word(other, 1u) {
            return false;
        }
    }
    return distance_at_rest(one, other) > NEAR_AT_REST * (meeting_number(meets, 3u) + meeting_number(meets, MARGIN));
}

// Which way the triangles beside an edge look.
fn outwards_of(edge: u32, origin: vec3<f32>) -> vec3<f32> {
    return normal_of(corners_of(edge_word(edge, 2u), origin)) + normal_of(corners_of(edge_word(edge, 3u), origin));
}

// Whether both triangles beside an edge fall off from a place on it.
fn falls_off(edge: u32, origin: vec3<f32>, place: vec3<f32>, way: vec3<f32>) -> bool {
    for (var side = 4u; side < 6u; side++) {
        let to = place_of(edge_word(edge, side)) - origin - place;
        if !(dot(to, way) < -FALLS * length(to)) {
            return false;
        }
    }
    return true;
}

fn depth_of(edge: u32) -> f32 {
    return min(bitcast<f32>(surface_faces[8u * edge_word(edge, 2u) + 7u]),
        bitcast<f32>(surface_faces[8u * edge_word(edge, 3u) + 7u]));
}

struct Crossing {
    normal: vec3<f32>, // from the second to the first
    gap: f32, // how far they are apart (m)
    s: f32, // what the second end of each has of the nearest place on it
    t: f32,
    there: bool,
}

// How two edges cross that are no farther apart than reach (m). Places are counted from the first end of the first.
fn crossing(one: u32, other: u32, reach: f32) -> Crossing {
    var found: Crossing;
    found.there = false;
    let origin = place_of(edge_word(one, 0u));
    let along = place_of(edge_word(one, 1u)) - origin;
    let q = place_of(edge_word(other, 0u)) - origin;
    let beside = place_of(edge_word(other, 1u)) - origin - q;
    let aa = dot(along, along);
    let ab = dot(along, beside);
    let bb = dot(beside, beside);
    let size = aa * bb - ab * ab;
    // no number is no angle
    if !(size > PARALLEL * aa * bb) {
        return found;
    }
    let a_off = -dot(along, q);
    let b_off = -dot(beside, q);
    let s = (ab * b_off - bb * a_off) / size;
    let t = (aa * b_off - ab * a_off) / size;
    if !(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
        return found;
    }
    let across = cross(along, beside);
    let unit = across / max(length(across), 1e-37);
    let normal = select(-unit, unit, dot(unit, outwards_of(other, origin)) >= 0.0);
    if !(dot(normal, outwards_of(one, origin)) < 0.0) {
        return found;
    }
    let at = along * s;
    let at_other = q + beside * t;
    if !falls_off(other, origin, at_other, normal) || !falls_off(one, origin, at, -normal) {
        return found;
    }
    let gap = dot(normal, at - at_other);
    return Crossing(normal, gap, s, t, gap >= -min(depth_of(one), depth_of(other)) && gap <= reach);
}

@compute @workgroup_size(64)
fn surface_contact_edges(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let one = row(id, groups);
    if one >= surface.items - surface.points {
        return;
    }
    let hold = lists_hold();
    let item = surface.points + one;
    let own = contacts_of(item, hold);
    for (var contact = own.x; contact < own.y; contact++) {
        begin_none(contact);
    }
    let all = surface.list + surface.items + 1u;
    let begin_at = select(one + 1u, surface_lists[surface.list + item], hold);
    let end = select(surface.items - surface.points, surface_lists[surface.list + item + 1u], hold);
    let largest = largest_step();
    var contact = own.x;
    for (var place = begin_at; place < end; place++) {
        var other = place;
        if hold {
            other = surface_lists[all + place];
        }
        let meets = meeting(edge_word(one, 6u), edge_word(other, 6u));
        if !hold && !may_cross(one, other, meets) {
            continue;
        }
        let thickness = meeting_number(meets, 3u);
        let found = crossing(one, other, reach_of(meets, largest));
        if !found.there {
            continue;
        }
        var parts: Parts;
        for (var which = 0u; which < 2u; which++) {
            parts.nodes[which] = edge_word(one, which);
            parts.nodes[2u + which] = edge_word(other, which);
        }
        parts.weights[0] = 1.0 - found.s;
        parts.weights[1] = found.s;
        parts.weights[2] = found.t - 1.0;
        parts.weights[3] = -found.t;
        for (var part = 4u; part < PARTS; part++) {
            parts.nodes[part] = NONE;
        }
        // nothing is known of how it got there, nor of how it slipped
        let outside = found.gap - thickness;
        let friction = meeting_number(meets, 2u);
        let settling = settling_of_step(meets);
        let begun = Begun(found.normal, max(outside, -settling), outside, 0.0, 0.0, friction, vec3<f32>(0.0));
        if !meets_it(meets, parts, begun) {
            continue;
        }
        if contact == own.y {
            // the host tells of it
            atomicAdd(&surface_motion[5], 1u);
            return;
        }
        begin(contact, meets, parts, begun);
        contact++;
    }
}
