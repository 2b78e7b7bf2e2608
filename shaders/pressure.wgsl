// A pressure that follows the surface; twin of systems/pressure.rs. bears is in alive.wgsl, or generated where no element
// ever goes.
struct PressureLoad {
    signal: u32, // slot of the pressure (Pa)
}
@group(0) @binding(0) var<uniform> load: PressureLoad;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> corners: array<u32>; // face times four plus corner
@group(0) @binding(3) var<storage, read> faces: array<u32>; // six a face: nodes, row of the element behind, weight
@group(0) @binding(4) var<storage, read> face_points: array<f32>; // four points a face at rest (m)
@group(0) @binding(5) var<storage, read> displacement: array<f32>;

fn face_point(face: u32, corner: u32) -> vec3<f32> {
    let x = 12u * face + 3u * corner;
    let u = 3u * faces[6u * face + corner];
    return vec3<f32>(face_points[x], face_points[x + 1u], face_points[x + 2u])
        + vec3<f32>(displacement[u], displacement[u + 1u], displacement[u + 2u]);
}

// ∫ N_a n dA: the area vector that falls to corner a. A triangle repeats its last node.
fn face_area_at(face: u32, a: u32) -> vec3<f32> {
    let here = face_point(face, a);
    let next = face_point(face, (a + 1u) % 4u);
    let opposite = face_point(face, (a + 2u) % 4u);
    let last = face_point(face, (a + 3u) % 4u);
    if faces[6u * face + 2u] == faces[6u * face + 3u] {
        let first = face_point(face, 0u);
        return cross(face_point(face, 1u) - first, face_point(face, 2u) - first) * (1.0 / 6.0);
    }
    // the product of the diagonals is the same seen from every corner
    let diagonals = cross(opposite - here, last - next);
    let own = cross(next - here, last - here);
    let across = cross(last - opposite, next - opposite);
    return diagonals * 0.125 + (own - across) * (1.0 / 24.0);
}

fn pressure(i: u32, node: u32) {
    var area = vec3<f32>(0.0);
    for (var at = starts[i]; at < starts[i + 1u]; at++) {
        let face = corners[at] / 4u;
        if bears(faces[6u * face + 4u]) {
            area += bitcast<f32>(faces[6u * face + 5u]) * face_area_at(face, corners[at] % 4u);
        }
    }
    add_load(node, -step.signals[load.signal].x * area);
}
