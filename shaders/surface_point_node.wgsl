// A node as a point that may meet others, in surface_contact.wgsl; a point of a face is in surface_point_face.wgsl.
const MEETS: u32 = NODES_MEET;
const SHARES: f32 = 0.0;
const OF_FACE: u32 = 1u; // its first part that is of what it faces

fn place_of_point(point: u32) -> vec3<f32> {
    return place_of(point);
}

fn normal_of_point(point: u32) -> vec3<f32> {
    return normal_of_node(point);
}

// The least cosine between a normal and one of its own triangles.
fn least_of_point(point: u32, normal: vec3<f32>) -> f32 {
    let at = place_of(point);
    let starts = surface.around + point;
    let all = surface.around + surface.nodes + 1u;
    var least = 1.0;
    for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
        least = min(least, dot(normal_of(corners_of(surface_faces[all + place], at)), normal));
    }
    return least;
}

// Whether a triangle has a node in common with a point.
fn is_of_point(point: u32, triangle: u32) -> bool {
    return has_corner(triangle, point);
}

// Whether a second face, that is turned otherwise, rises before the first: it is a wall of a corner. Where a node has
// sunk into that, it is nearest at the foot of the wall.
fn rises(first: Facing, second: Facing, point: vec3<f32>, edge: f32) -> bool {
    return dot(first.normal, second.at - first.at) > 0.0
        || rises_beside(second.triangle, point, first.at, first.normal, edge);
}

fn parts_of(point: u32, facing: Facing, at: vec3<f32>) -> Parts {
    var parts: Parts;
    parts.nodes[0] = point;
    parts.weights[0] = 1.0;
    for (var corner = 0u; corner < 3u; corner++) {
        parts.nodes[1u + corner] = surface_faces[8u * facing.triangle + corner];
        parts.weights[1u + corner] = -facing.weights[corner];
    }
    for (var part = 4u; part < PARTS; part++) {
        parts.nodes[part] = NONE;
    }
    return parts;
}

// How far it is outside of the place that bears it (m).
fn gap_of(facing: Facing, parts: Parts, at: vec3<f32>) -> f32 {
    return facing.gap;
}
