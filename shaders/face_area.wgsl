// Areas of deformed faces, for loads that follow them. faces: six numbers a face, its nodes, what is behind it, weight;
// face_points: four points a face at rest, from its first (m).

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
