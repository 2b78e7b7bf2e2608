// Marks the faces that a tool sucks: those in its mouth that no other hides, seen along its axis from within the tool;
// twin of systems/suction_mouth.rs, after suction_mouth.wgsl. criterion_due and the constants are generated, what faces
// are is in suction_faces.wgsl.
@group(0) @binding(0) var<storage, read> shares_in_mouth: array<f32>;
@group(0) @binding(1) var<storage, read_write> suction_marks: array<u32>;

// Whether a triangle is before a place, both in the tool's frame.
fn hides(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, at: vec3<f32>) -> bool {
    let p = a.xy - at.xy;
    let q = b.xy - at.xy;
    let r = c.xy - at.xy;
    let parts = vec3<f32>(perp_dot(q, r), perp_dot(r, p), perp_dot(p, q));
    let area = parts.x + parts.y + parts.z;
    let height = dot(parts, vec3<f32>(a.z, b.z, c.z));
    // false of what has no area
    return min(parts.x, min(parts.y, parts.z)) >= 0.0 && area > 0.0 && height / area > at.z + APART * mouth.bore;
}

fn is_hidden(face: u32) -> bool {
    let at = centroid(corners_of(face));
    for (var other = 0u; other < mouth.faces; other++) {
        // warped, a face would be before itself
        if other != face && shares_in_mouth[other] > 0.0 {
            let by = corners_of(other).places;
            if hides(by[0], by[1], by[2], at) || hides(by[0], by[2], by[3], at) {
                return true;
            }
        }
    }
    return false;
}

@compute @workgroup_size(64)
fn suction_hidden(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let face = row(id, groups);
    if face >= mouth.faces || !criterion_due() {
        return;
    }
    var share = 0.0;
    if shares_in_mouth[face] > 0.0 {
        share = select(shares_in_mouth[face], 0.0, is_hidden(face));
    }
    suction_marks[mouth.first + face] = bitcast<u32>(share);
}
