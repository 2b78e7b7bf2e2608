// What kernels share that go through the faces of a body for a mouth: the faces, and where their corners are in the
// tool's frame. The mouth is in suction_tool.wgsl.
@group(0) @binding(2) var<storage, read> faces: array<u32>; // five a face: corners, the face seen from behind
@group(0) @binding(3) var<storage, read> rest_points: array<f32>; // of nodes, from the reference (m)
@group(0) @binding(4) var<storage, read> displacement: array<f32>;

fn place_of(node: u32) -> vec3<f32> {
    let at = 3u * node;
    return vec3<f32>(rest_points[at], rest_points[at + 1u], rest_points[at + 2u])
        + vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
}

// A face's corners in the tool's frame (m), a triangle's last twice.
struct Corners {
    places: array<vec3<f32>, 4>,
    count: u32,
}

fn corners_of(face: u32) -> Corners {
    let at = 5u * face;
    let rows = array<vec4<f32>, 3>(
        step.signals[mouth.pose], step.signals[mouth.pose + 1u], step.signals[mouth.pose + 2u]);
    let origin = vec3<f32>(rows[0].w, rows[1].w, rows[2].w);
    var of_face: Corners;
    of_face.count = select(4u, 3u, faces[at + 2u] == faces[at + 3u]);
    for (var corner = 0u; corner < 4u; corner++) {
        let x = place_of(faces[at + corner]) - origin;
        of_face.places[corner] = x.x * rows[0].xyz + x.y * rows[1].xyz + x.z * rows[2].xyz;
    }
    return of_face;
}

// The middle of the corners (m).
fn centroid(of_face: Corners) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var corner = 0u; corner < of_face.count; corner++) {
        sum += of_face.places[corner];
    }
    return sum / f32(of_face.count);
}

fn perp_dot(p: vec2<f32>, q: vec2<f32>) -> f32 {
    return p.x * q.y - p.y * q.x;
}
