// Marks the faces that a tool sucks; twin of systems/suction_mouth.rs. suction_presence.wgsl comes before it,
// suction_nodes.wgsl and suction_pressure.wgsl after it; criterion_due is generated.
struct SuctionMouth {
    faces: u32, // of the body
    nodes: u32, // of these faces
    parts: u32, // flat faces that they are loaded as
    first: u32, // where the tool's marks begin: of faces, then of nodes
    numbers: u32, // and its numbers in suction_pressure
    pose: u32, // first slot of where it is
    pressure: u32, // slot of the pressure with a closed mouth (Pa)
    bore: f32, // (m)
    reach: f32, // (m)
    delay: f32, // (s)
    area: f32, // of the mouth (m²)
}
@group(0) @binding(0) var<uniform> mouth: SuctionMouth;
@group(0) @binding(1) var<storage, read_write> suction_marks: array<u32>;
@group(0) @binding(2) var<storage, read> faces: array<u32>; // five a face: corners, the face seen from behind
@group(0) @binding(3) var<storage, read> rest_points: array<f32>; // of nodes, from the reference (m)
@group(0) @binding(4) var<storage, read> displacement: array<f32>;
@group(0) @binding(5) var<storage, read> face_presence: array<u32>;

const NO_FACE: u32 = 0xffffffffu;

fn place_of(node: u32) -> vec3<f32> {
    let at = 3u * node;
    return vec3<f32>(rest_points[at], rest_points[at + 1u], rest_points[at + 2u])
        + vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
}

// What share of the face is in the mouth.
fn sucked_share(face: u32) -> f32 {
    let at = 5u * face;
    let opposite = faces[at + 4u];
    if face_presence[face] == 0u {
        return 0.0;
    }
    if opposite != NO_FACE {
        if face_presence[opposite] == 1u {
            return 0.0;
        }
    }
    let rows = array<vec4<f32>, 3>(
        step.signals[mouth.pose], step.signals[mouth.pose + 1u], step.signals[mouth.pose + 2u]);
    let origin = vec3<f32>(rows[0].w, rows[1].w, rows[2].w);
    let corners = select(4u, 3u, faces[at + 2u] == faces[at + 3u]);
    var inside = 0.0;
    var sizes = 0.0;
    var height = 0.0;
    var places: array<vec2<f32>, 4>; // across the axis; a triangle's last corner twice
    for (var corner = 0u; corner < corners; corner++) {
        let x = place_of(faces[at + corner]) - origin;
        let y = x.x * rows[0].xyz + x.y * rows[1].xyz + x.z * rows[2].xyz;
        places[corner] = y.xy;
        places[3] = y.xy;
        let off = mouth.bore - length(y.xy);
        inside += max(off, 0.0);
        sizes += abs(off);
        height += y.z;
    }
    let across = places[2] - places[0];
    let other = places[3] - places[1];
    // a face that is turned away is on the far side of the tissue, or of a hole in it
    if across.x * other.y <= across.y * other.x {
        return 0.0;
    }
    if abs(height) > mouth.reach * f32(corners) || inside <= 0.0 {
        return 0.0;
    }
    return inside / sizes;
}

@compute @workgroup_size(64)
fn suction_mouth(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let face = row(id, groups);
    if face >= mouth.faces || !criterion_due() {
        return;
    }
    suction_marks[mouth.first + face] = bitcast<u32>(sucked_share(face));
}
