// What share of each face of a body is in the mouth of a tool, seen along its axis; twin of systems/suction_mouth.rs.
// suction_presence.wgsl comes before it; suction_hidden.wgsl, suction_nodes.wgsl and suction_pressure.wgsl after it;
// criterion_due and the constants are generated, what faces are is in suction_faces.wgsl.
@group(0) @binding(0) var<storage, read> face_presence: array<u32>;
@group(0) @binding(1) var<storage, read_write> shares_in_mouth: array<f32>;

const NO_FACE: u32 = 0xffffffffu;

fn sector(p: vec2<f32>, q: vec2<f32>) -> f32 {
    return 0.5 * mouth.bore * mouth.bore * angle(perp_dot(p, q), dot(p, q));
}

// The angle whose sine and cosine are in the ratio of these, from -π to π; 0 where both are 0. To 2e-8 of it, which
// atan2 does not promise: Abramowitz and Stegun 4.4.50.
fn angle(sine: f32, cosine: f32) -> f32 {
    let low = min(abs(sine), abs(cosine));
    let high = max(abs(sine), abs(cosine));
    if high == 0.0 {
        return 0.0;
    }
    let x = low / high;
    let s = x * x;
    let more = 0.1065626393 + s * (-0.0752896400 + s * (0.0429096138 + s * (-0.0161657367 + s * 0.0028662257)));
    var turned = x * (1.0 + s * (-0.3333314528 + s * (0.1999355085 + s * (-0.1420889944 + s * more))));
    turned = select(turned, 1.57079632679 - turned, abs(sine) > abs(cosine));
    turned = select(turned, 3.14159265359 - turned, cosine < 0.0);
    return select(turned, -turned, sine < 0.0);
}

// The share of a face that is in the disc of the mouth, seen along its axis: share_in_disc in crates/tools.
fn share_in_disc(corners: array<vec2<f32>, 4>) -> f32 {
    var places = corners;
    let square = mouth.bore * mouth.bore;
    var area = 0.0;
    var inside = 0.0;
    var meets = false;
    var is_within = true;
    for (var side = 0u; side < 4u; side++) {
        let p = places[side];
        let q = places[(side + 1u) % 4u];
        let d = q - p;
        let a = dot(d, d);
        area += 0.5 * perp_dot(p, q);
        is_within &= dot(p, p) <= square;
        if a == 0.0 {
            continue;
        }
        // |p + t d|² = r²
        let b = dot(p, d);
        let root = sqrt(max(b * b - a * (dot(p, p) - square), 0.0));
        let enters = clamp((-b - root) / a, 0.0, 1.0);
        let leaves = clamp((-b + root) / a, 0.0, 1.0);
        if enters >= leaves {
            inside += sector(p, q);
            continue;
        }
        meets = true;
        let u = p + d * enters;
        let v = p + d * leaves;
        inside += 0.5 * perp_dot(u, v);
        if enters > 0.0 {
            inside += sector(p, u);
        }
        if leaves < 1.0 {
            inside += sector(v, q);
        }
    }
    if !(area > 0.0) {
        return 0.0;
    }
    if is_within {
        return 1.0;
    }
    // no side crosses the edge of the disc: all of that is within, or nothing, but for rounding
    if !meets {
        inside = select(0.0, mouth.area, inside > 0.5 * mouth.area);
    }
    return clamp(inside / area, 0.0, 1.0);
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
    let of_face = corners_of(face);
    if !(abs(centroid(of_face).z) <= mouth.reach) {
        return 0.0;
    }
    let twice = cross(of_face.places[2] - of_face.places[0], of_face.places[3] - of_face.places[1]);
    // of what has no area, and what is turned away on the far side of the tissue or of a hole in it, nothing
    if !(twice.z > 0.0) {
        return 0.0;
    }
    let turned = min(twice.z / (STEEP * length(twice)), 1.0);
    var places: array<vec2<f32>, 4>; // across the axis
    for (var corner = 0u; corner < 4u; corner++) {
        places[corner] = of_face.places[corner].xy;
    }
    return share_in_disc(places) * turned;
}

@compute @workgroup_size(64)
fn suction_mouth(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let face = row(id, groups);
    if face >= mouth.faces || !criterion_due() {
        return;
    }
    shares_in_mouth[face] = sucked_share(face);
}
