// Which triangle a point faces; twin of src/contact/facing.rs. Places are counted from the point.
const TURNED_AWAY: f32 = 0.2;
const ALIKE: f32 = 0.05;
const ON_IT: f32 = 1e-3;
const CORNER: f32 = 0.866;
const RIM: f32 = 0.5;
const FLUSH: f32 = -0.99;
const LOOKS: f32 = -0.5;
const FAR: f32 = 3e38;

struct OnTriangle {
    at: vec3<f32>, // from the point (m)
    weights: vec3<f32>,
    part: u32, // 0 inside, 1 to 3 sides, 4 to 6 corners
}

struct Facing {
    triangle: u32,
    weights: vec3<f32>,
    at: vec3<f32>,
    normal: vec3<f32>,
    gap: f32,
    part: u32, // the side or corner that the point is before and the normal is the way from, or 0
    turned: f32, // the cosine between its normal and the point's own
    there: bool,
}

fn place_of(node: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

fn corners_of(triangle: u32, point: vec3<f32>) -> array<vec3<f32>, 3> {
    let at = 8u * triangle;
    return array<vec3<f32>, 3>(
        place_of(surface_faces[at]) - point,
        place_of(surface_faces[at + 1u]) - point,
        place_of(surface_faces[at + 2u]) - point);
}

fn has_corner(triangle: u32, node: u32) -> bool {
    let at = 8u * triangle;
    return surface_faces[at] == node || surface_faces[at + 1u] == node || surface_faces[at + 2u] == node;
}

fn normal_of(corners: array<vec3<f32>, 3>) -> vec3<f32> {
    let across = cross(corners[1] - corners[0], corners[2] - corners[0]);
    let size = length(across);
    return select(vec3<f32>(0.0), across / max(size, 1e-37), size > 1e-30);
}

// The place of a triangle that is nearest to the point, by the seven regions about it.
fn nearest(corners: array<vec3<f32>, 3>) -> OnTriangle {
    let a = corners[0];
    let b = corners[1];
    let c = corners[2];
    let ab = b - a;
    let ac = c - a;
    let d1 = -dot(ab, a);
    let d2 = -dot(ac, a);
    if d1 <= 0.0 && d2 <= 0.0 {
        return OnTriangle(a, vec3<f32>(1.0, 0.0, 0.0), 4u);
    }
    let d3 = -dot(ab, b);
    let d4 = -dot(ac, b);
    if d3 >= 0.0 && d4 <= d3 {
        return OnTriangle(b, vec3<f32>(0.0, 1.0, 0.0), 5u);
    }
    let d5 = -dot(ab, c);
    let d6 = -dot(ac, c);
    if d6 >= 0.0 && d5 <= d6 {
        return OnTriangle(c, vec3<f32>(0.0, 0.0, 1.0), 6u);
    }
    let off_ab = d1 * d4 - d3 * d2;
    if off_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return OnTriangle(a + ab * t, vec3<f32>(1.0 - t, t, 0.0), 1u);
    }
    let off_ca = d5 * d2 - d1 * d6;
    if off_ca <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return OnTriangle(a + ac * t, vec3<f32>(1.0 - t, 0.0, t), 3u);
    }
    let off_bc = d3 * d6 - d5 * d4;
    if off_bc <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return OnTriangle(b + (c - b) * t, vec3<f32>(0.0, 1.0 - t, t), 2u);
    }
    let all = off_ab + off_bc + off_ca;
    let v = off_ca / all;
    let w = off_ab / all;
    return OnTriangle(a + ab * v + ac * w, vec3<f32>(1.0 - v - w, v, w), 0u);
}

fn normal_of_node(node: u32) -> vec3<f32> {
    let at = place_of(node);
    let starts = surface.around + node;
    let all = surface.around + surface.nodes + 1u;
    var sum = vec3<f32>(0.0);
    for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
        let triangle = surface_faces[all + place];
        let corners = corners_of(triangle, at);
        var own = 0u;
        for (var corner = 1u; corner < 3u; corner++) {
            if surface_faces[8u * triangle + corner] == node {
                own = corner;
            }
        }
        let b = corners[(own + 1u) % 3u];
        let c = corners[(own + 2u) % 3u];
        sum += normal_of(corners) * atan2(length(cross(b, c)), dot(b, c));
    }
    let size = length(sum);
    return select(vec3<f32>(0.0), sum / max(size, 1e-37), size > 1e-30);
}

// How many triangles are around the side or corner that a point is before, and each of them, ascending.
fn count_around(facing: Facing) -> u32 {
    if facing.part < 4u {
        return 2u;
    }
    let starts = surface.around + surface_faces[8u * facing.triangle + facing.part - 4u];
    return surface_faces[starts + 1u] - surface_faces[starts];
}

fn around_part(facing: Facing, number: u32) -> u32 {
    if facing.part < 4u {
        // where there is none beside, it is the last
        let other = surface_faces[8u * facing.triangle + 2u + facing.part];
        return select(max(facing.triangle, other), min(facing.triangle, other), number == 0u);
    }
    let starts = surface.around + surface_faces[8u * facing.triangle + facing.part - 4u];
    return surface_faces[surface.around + surface.nodes + 1u + surface_faces[starts] + number];
}

// Whether another triangle is nearer to the point than so far (m).
fn is_closer(other: u32, triangle: u32, point: vec3<f32>, distance: f32) -> bool {
    if other == triangle || other == NONE {
        return false;
    }
    return length(nearest(corners_of(other, point)).at) < (1.0 - 1e-6) * distance - surface.rounding;
}

// Whether a triangle is a wall of a corner that rises before another, with such a normal through a place, there.
fn rises_beside(other: u32, point: vec3<f32>, at: vec3<f32>, normal: vec3<f32>, edge: f32) -> bool {
    if other == NONE {
        return false;
    }
    let corners = corners_of(other, point);
    let highest = max(dot(normal, corners[0] - at), max(dot(normal, corners[1] - at), dot(normal, corners[2] - at)));
    return highest > ALIKE * edge && dot(normal_of(corners), normal) < CORNER;
}

// How far a point is outside of a triangle that it is on if it is nearer than a thousandth of an edge (m).
fn outside(triangle: u32, point: vec3<f32>, corners: array<vec3<f32>, 3>, found: OnTriangle, edge: f32) -> Facing {
    var facing: Facing;
    facing.there = false;
    let normal = normal_of(corners);
    let distance = length(found.at);
    // no number is no distance
    if all(normal == vec3<f32>(0.0)) || !(distance < FAR) {
        return facing;
    }
    facing.triangle = triangle;
    facing.weights = found.weights;
    facing.at = found.at;
    facing.normal = normal;
    facing.gap = -dot(found.at, normal);
    facing.part = 0u;
    facing.there = true;
    if found.part == 0u || distance <= ON_IT * edge {
        return facing;
    }
    facing.part = found.part;
    let count = count_around(facing);
    var around = normal;
    for (var number = 0u; number < count; number++) {
        let other = around_part(facing, number);
        if is_closer(other, triangle, point, distance) {
            facing.there = false;
            return facing;
        }
        if other != NONE && other != triangle {
            around += normal_of(corners_of(other, point));
        }
    }
    if found.part > 3u {
        around = normal_of_node(surface_faces[8u * triangle + found.part - 4u]);
    }
    if dot(-found.at, around) >= 0.0 {
        facing.normal = -found.at / distance;
        facing.gap = distance;
        return facing;
    }
    // of a corner that it has sunk into each wall bears it, as above it, along one line; what is farther from there
    // than insides go is beyond the body
    let is_in_body = distance <= bitcast<f32>(surface_faces[8u * triangle + 7u]);
    for (var number = 0u; number < count && is_in_body; number++) {
        if rises_beside(around_part(facing, number), point, found.at, normal, edge) {
            facing.part = 0u;
            let below = -facing.gap * normal;
            facing.weights = weights_in_plane(array<vec3<f32>, 3>(
                corners[0] - below, corners[1] - below, corners[2] - below));
            return facing;
        }
    }
    facing.normal = found.at / distance;
    facing.gap = -distance;
    facing.part = 0u;
    return facing;
}

// What each corner of a triangle has of a place in its plane that they are counted from.
fn weights_in_plane(off: array<vec3<f32>, 3>) -> vec3<f32> {
    let across = cross(off[1] - off[0], off[2] - off[0]);
    let of_b = dot(cross(off[2], off[0]), across) / dot(across, across);
    let of_c = dot(cross(off[0], off[1]), across) / dot(across, across);
    return vec3<f32>(1.0 - of_b - of_c, of_b, of_c);
}
