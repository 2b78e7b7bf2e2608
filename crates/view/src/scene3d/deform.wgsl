// Corners of triangles go to where nodes are on the device, with their normals: what crates/pictures (normals.rs) does
// on the host.

struct How {
    // first number of the displacements in their buffer, corners, multiple of displacements, faces
    first: u32,
    count: u32,
    deformation: f32,
    rows: u32,
}

@group(0) @binding(0) var<uniform> how: How;
// three a row
@group(0) @binding(1) var<storage, read> moved: array<f32>;
@group(0) @binding(2) var<storage, read> rest: array<f32>;
// rows of their points; a triangle repeats the last
@group(0) @binding(3) var<storage, read> faces: array<vec4u>;
// of each row where its list begins, and one more; then the lists of faces around each
@group(0) @binding(4) var<storage, read> around: array<u32>;
// of each corner its face, and which of its points it is; 4: the middle
@group(0) @binding(5) var<storage, read> sources: array<vec2u>;
@group(0) @binding(6) var<storage, read_write> corners: array<f32>;

// Numbers a corner; position and normal are the first.
const CORNER = 11u;
// 40°
const CREASE = 0.766;

fn place(row: u32) -> vec3f {
    let at = 3u * row;
    let u = vec3f(moved[how.first + at], moved[how.first + at + 1u], moved[how.first + at + 2u]);
    return vec3f(rest[at], rest[at + 1u], rest[at + 2u]) + how.deformation * u;
}

fn area(face: u32) -> vec3f {
    let points = faces[face];
    let a = place(points.x);
    let b = place(points.y);
    let c = place(points.z);
    if points.z == points.w { return 0.5 * cross(b - a, c - a); }
    return 0.5 * cross(c - a, place(points.w) - b);
}

fn direction(vector: vec3f) -> vec3f {
    let size = length(vector);
    return select(vec3f(0), vector / size, size > 0.0);
}

fn normal(face: u32, row: u32) -> vec3f {
    let own = direction(area(face));
    var sum = vec3f(0);
    let lists = how.rows + 1u;
    for (var place = around[row]; place < around[row + 1u]; place++) {
        let other = area(around[lists + place]);
        if dot(direction(other), own) >= CREASE { sum += other; }
    }
    return select(own, direction(sum), dot(sum, sum) > 0.0);
}

@compute @workgroup_size(64) fn deform(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let corner = id.x + id.y * groups.x * 64u;
    if corner >= how.count { return; }
    let source = sources[corner];
    let points = faces[source.x];
    var position = vec3f(0);
    var turned = vec3f(0);
    if source.y < 4u {
        position = place(points[source.y]);
        turned = normal(source.x, points[source.y]);
    } else {
        for (var side = 0u; side < 4u; side++) {
            position += 0.25 * place(points[side]);
            turned += 0.25 * normal(source.x, points[side]);
        }
    }
    for (var axis = 0u; axis < 3u; axis++) {
        corners[CORNER * corner + axis] = position[axis];
        corners[CORNER * corner + 3u + axis] = turned[axis];
    }
}
