// A point of a face that may meet others, in surface_contact.wgsl; twin of src/contact/face_points.rs. A node is in
// surface_point_node.wgsl.
const MEETS: u32 = FACES_MEET;
const SHARES: f32 = 1e-3; // nearer than this to touching points share the masses of their nodes, in smaller edges
const STEPS: u32 = 4u; // of Newton's from the middle of a quadrilateral
const OF_FACE: u32 = 4u; // its first part that is of what it faces

fn face_point(point: u32) -> u32 {
    return surface.face_points + FACE_POINT_WORDS * (point - surface.nodes);
}

fn place_of_point(point: u32) -> vec3<f32> {
    let at = face_point(point);
    let first = place_of(surface_faces[at]);
    var off = vec3<f32>(0.0);
    for (var corner = 1u; corner < 4u; corner++) {
        off += bitcast<f32>(surface_faces[at + 4u + corner]) * (place_of(surface_faces[at + corner]) - first);
    }
    return first + off;
}

fn normal_of_point(point: u32) -> vec3<f32> {
    let triangle = surface_faces[face_point(point) + 8u];
    return normal_of(corners_of(triangle, place_of(surface_faces[8u * triangle])));
}

// The cosine between a normal and that of its own triangle.
fn least_of_point(point: u32, normal: vec3<f32>) -> f32 {
    return dot(normal_of_point(point), normal);
}

// Whether a triangle has a node in common with a point.
fn is_of_point(point: u32, triangle: u32) -> bool {
    let at = face_point(point);
    for (var corner = 0u; corner < 4u; corner++) {
        if has_corner(triangle, surface_faces[at + corner]) {
            return true;
        }
    }
    return false;
}

// Whether a second face, that is turned otherwise, rises before the first: it is a wall of a corner. A point of a face
// is never on an edge, and a wall that falls off beside it would push it along the face.
fn rises(first: Facing, second: Facing, point: vec3<f32>, edge: f32) -> bool {
    return rises_beside(second.triangle, point, first.at, first.normal, edge);
}

// What the corners of a quadrilateral have of a place on it, by bilinear weights.
fn bilinear(at: vec3<f32>, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> vec4<f32> {
    var x = 0.5;
    var y = 0.5;
    for (var i = 0u; i < STEPS; i++) {
        let along_x = mix(b - a, c - d, y);
        let along_y = mix(d - a, c - b, x);
        let off = at - mix(mix(a, b, x), mix(d, c, x), y);
        let xx = dot(along_x, along_x);
        let xy = dot(along_x, along_y);
        let yy = dot(along_y, along_y);
        let of_x = dot(along_x, off);
        let of_y = dot(along_y, off);
        let size = xx * yy - xy * xy;
        // of one without area any weights will do
        if size > 1e-37 {
            x = clamp(x + (of_x * yy - of_y * xy) / size, 0.0, 1.0);
            y = clamp(y + (of_y * xx - of_x * xy) / size, 0.0, 1.0);
        }
    }
    return vec4<f32>((1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y);
}

// A quadrilateral bears a point with all its corners, but for one beyond its rim.
fn parts_of(point: u32, facing: Facing, at: vec3<f32>) -> Parts {
    var parts: Parts;
    let own = face_point(point);
    for (var corner = 0u; corner < 4u; corner++) {
        parts.nodes[corner] = surface_faces[own + corner];
        parts.weights[corner] = bitcast<f32>(surface_faces[own + 4u + corner]);
    }
    let facet = surface.facets + 4u * facing.triangle;
    var borne = vec4<f32>(facing.weights, 0.0);
    var first = 8u * facing.triangle;
    // not beyond a rim; of a place on a side rounding may leave a little less than nothing
    if surface_faces[facet + 2u] != surface_faces[facet + 3u] && all(facing.weights > vec3<f32>(-1e-6)) {
        first = facet;
        borne = bilinear(facing.at, place_of(surface_faces[facet]) - at, place_of(surface_faces[facet + 1u]) - at,
            place_of(surface_faces[facet + 2u]) - at, place_of(surface_faces[facet + 3u]) - at);
    }
    for (var corner = 0u; corner < 4u; corner++) {
        // behind the corners of a triangle there is no node, and nothing is borne there
        parts.nodes[4u + corner] = select(NONE, surface_faces[first + corner], borne[corner] != 0.0);
        parts.weights[4u + corner] = -borne[corner];
    }
    return parts;
}

// How far it is outside of the place that bears it (m): of a warped quadrilateral that is not quite its triangles.
fn gap_of(facing: Facing, parts: Parts, at: vec3<f32>) -> f32 {
    var off = vec3<f32>(0.0);
    for (var part = 4u; part < PARTS; part++) {
        if parts.weights[part] != 0.0 {
            off += parts.weights[part] * (place_of(parts.nodes[part]) - at);
        }
    }
    return dot(facing.normal, off);
}
